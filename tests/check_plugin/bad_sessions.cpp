// SPDX-License-Identifier: Apache-2.0
// Planners whose sessions violate one clause of the contract each.
#include "sound_planner.hpp"

namespace {
using namespace altiplan;
using namespace altiplan::bad;

enum class Flaw { none, stale, two_faced, blind, throws, spends, counts };

/// Plans afresh at each update, with a flaw.
template <Flaw kFlaw>
class Flawed final : public Session {
 public:
  Flawed(const Sound& sound, const Request& request)
      : sound_(sound), request_(request), result_(sound.plan(request)) {
    note();
  }

 private:
  const PlanResult& do_result() const override { return shown_; }
  const PlanResult& do_update(const State& state, const Goal& goal,
                              std::shared_ptr<const World> world, std::span<const Change>,
                              const Budget& budget) override {
    const Vec3 from = request_.start.position;
    request_.start = state;
    request_.goal = goal;
    if (kFlaw != Flaw::blind) {
      request_.world = std::move(world);
    }
    if (kFlaw != Flaw::spends) {
      request_.budget = budget;
    }
    if (kFlaw == Flaw::stale && from != state.position) {
      return result_;
    }
    for (const Vec3& end : {state.position, goal.position}) {
      const bool covered = request_.world->clearance(end) < 0;
      if (kFlaw == Flaw::throws && covered) {
        throw std::runtime_error("lost the thread");
      }
      if (covered) {
        result_ = {};
        result_.status = PlanStatus::invalid_problem;
        result_.message = "an end lies in an obstacle";
        result_.counters = {{"expanded", 0}};
        note();
        return result_;
      }
    }
    result_ = sound_.plan(request_);
    note();
    if (kFlaw == Flaw::two_faced) {
      result_.message += ", or so";
    }
    return result_;
  }

  void note() {
    static std::atomic<std::int64_t> updates = 0;
    if (kFlaw == Flaw::counts) {
      result_.counters.push_back({"updates", ++updates});
    }
    shown_ = result_;
  }

  const Sound& sound_;
  Request request_;
  PlanResult result_;
  PlanResult shown_;
};

template <Flaw kFlaw>
class Replanner final : public Planner {
 public:
  explicit Replanner(const NoParams&) {}

 private:
  PlanResult do_plan(const Request& request) const override { return sound_.plan(request); }
  std::unique_ptr<Session> do_begin(const Request& request) const override {
    return std::make_unique<Flawed<kFlaw>>(sound_, request);
  }
  Traits do_traits() const override { return {}; }
  Sound sound_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "sound_session", Replanner<Flaw::none>, NoParams,
                "nothing is wrong with it")
ALTIPLAN_PLUGIN(Planner, "stale", Replanner<Flaw::stale>, NoParams,
                "its session's route begins where the vehicle was")
ALTIPLAN_PLUGIN(Planner, "two_faced", Replanner<Flaw::two_faced>, NoParams,
                "its session's update returns what its result is not")
ALTIPLAN_PLUGIN(Planner, "blind", Replanner<Flaw::blind>, NoParams,
                "its session looks at the world as it was at first")
ALTIPLAN_PLUGIN(Planner, "loses_the_thread", Replanner<Flaw::throws>, NoParams,
                "its session throws where an end is covered")
ALTIPLAN_PLUGIN(Planner, "spends", Replanner<Flaw::spends>, NoParams,
                "its session keeps to the budget of its first plan")
ALTIPLAN_PLUGIN(Planner, "counts_updates", Replanner<Flaw::counts>, NoParams,
                "its sessions count the updates of all")
