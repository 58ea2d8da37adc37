// SPDX-License-Identifier: Apache-2.0
// A replanner written against the public headers alone: straight to the goal where nothing forbids
// it, and a session that keeps its route for as long as that stands.
#include <algorithm>

#include "altiplan/check.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

bool sound(const Polyline& route, const Request& request) { return check(route, request).ok(); }

class Kept final : public Session {
 public:
  explicit Kept(const Request& request) : request_(request) { plan(); }

 private:
  /// Tries the straight leg, and those by way of a point beside its middle.
  void plan() {
    const Vec3 a = request_.start.position;
    const Vec3 b = request_.goal.position;
    BudgetWatch watch(request_.budget);
    std::int64_t expanded = 0;
    Polyline route;
    for (const double aside : {0.0, 0.2, -0.2, 0.5, -0.5, 1.0, -1.0}) {
      if (watch.spent(std::uint64_t(expanded))) {
        finish(watch.cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out, {}, expanded);
        result_.budget_hit = !watch.cancelled();
        return;
      }
      ++expanded;
      const Vec3 across(a.y() - b.y(), b.x() - a.x(), 0);
      const Vec3 past = (a + b) / 2 + aside * across;
      route = aside == 0 ? Polyline{a, b} : Polyline{a, past, b};
      if (sound(route, request_)) {
        finish(PlanStatus::solved, std::move(route), expanded);
        return;
      }
    }
    finish(PlanStatus::no_route, {}, expanded);
  }

  void finish(PlanStatus status, Polyline route, std::int64_t expanded) {
    result_ = {};
    result_.status = status;
    result_.message =
        status == PlanStatus::solved ? "one corner at most" : "no way with one corner";
    result_.route = std::move(route);
    result_.counters = {{"expanded", expanded}, {"calls", ++calls_}, {"changes", changes_}};
  }

  /// What is left of the route, from the state on; empty where that is not near it.
  Polyline rest(const Vec3& from) const {
    const Route& route = result_.route;
    for (std::size_t i = 0; i + 1 < route.size(); ++i) {
      if (point_leg_distance(from, route[i], route[i + 1]) <= request_.vehicle.radius_m) {
        Polyline left{from};
        left.insert(left.end(), route.begin() + std::ptrdiff_t(i) + 1, route.end());
        return without_repeats(left);
      }
    }
    return {};
  }

  const PlanResult& do_result() const override { return result_; }
  const PlanResult& do_update(const State& state, const Goal& goal,
                              std::shared_ptr<const World> world, std::span<const Change> changes,
                              const Budget& budget) override {
    changes_ += std::int64_t(changes.size());
    request_.start = state;
    request_.goal = goal;
    request_.world = std::move(world);
    request_.budget = budget;
    Polyline kept = rest(state.position);
    if (!kept.empty() && point_problem(goal.position, request_).empty() && sound(kept, request_)) {
      finish(PlanStatus::solved, std::move(kept), 0);
    } else {
      plan();
    }
    return result_;
  }

  Request request_;
  PlanResult result_;
  std::int64_t calls_ = 0;
  std::int64_t changes_ = 0;
};

class Keeping final : public Planner {
 public:
  explicit Keeping(const NoParams&) {}

 private:
  PlanResult do_plan(const Request& request) const override { return Kept(request).result(); }
  std::unique_ptr<Session> do_begin(const Request& request) const override {
    return std::make_unique<Kept>(request);
  }
  Traits do_traits() const override {
    Traits traits;
    traits.incremental = true;
    return traits;
  }
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "keeping", Keeping, NoParams,
                "one corner at most, and a session that keeps its route while that stands")
