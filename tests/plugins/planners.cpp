// SPDX-License-Identifier: Apache-2.0
// A planner that does as it is told, well or badly.
#include <chrono>
#include <limits>
#include <stdexcept>
#include <thread>

#include "altiplan/error.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct Params {
  std::string does = "straight";
  Vec3 past_m{0, 0, 0};
  void describe(Fields& f) {
    f("does", does)
        .one_of({"straight", "past", "never_stops", "throws", "throws_int", "nan", "huge",
                 "wrong_end", "no_points", "endless_turn", "allocates", "waits", "uses_budget",
                 "refuses_does", "no_route", "knows_a_bound"})
        .doc("what it does");
    f("past_m", past_m).unit("m").doc("of past: the one waypoint between");
  }
};

void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }

class Told final : public Planner {
 public:
  explicit Told(const Params& params) : params_(params) {}

 private:
  PlanResult route(const Request& request, std::vector<Vec3> between) const {
    PlanResult result;
    result.status = PlanStatus::solved;
    result.route = std::move(between);
    result.route.edit().insert(result.route.begin(), request.start.position);
    result.route.push_back(request.goal.position);
    result.counters = {{"expanded", 3}};
    if (request.trace != nullptr) {
      request.trace->add({TraceEvent::Kind::expanded, 1, -1, request.start.position, 2.5});
      request.trace->add({TraceEvent::Kind::rewired, 2, 1, request.goal.position,
                          std::numeric_limits<double>::infinity()});
      request.trace->add({TraceEvent::Kind::iteration, 1, -1, request.goal.position, 800, 900, 3});
    }
    return result;
  }

  static PlanResult use_budget(const Request& request) {
    PlanResult result;
    BudgetWatch watch(request.budget);
    std::int64_t expanded = 0;
    while (!watch.spent(std::uint64_t(expanded))) {
      ++expanded;
      if (expanded % 64 == 0) {
        pause();
      }
    }
    result.status = watch.cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out;
    result.message = "the search was cut short";
    result.budget_hit = !watch.cancelled();
    result.counters = {{"expanded", expanded}};
    return result;
  }

  PlanResult do_plan(const Request& request) const override {
    const std::string& does = params_.does;
    if (does == "past") {
      return route(request, {params_.past_m});
    }
    if (does == "knows_a_bound") {
      PlanResult result = route(request, {});
      result.counters.push_back({"bound_mm", 799'000});
      return result;
    }
    if (does == "nan") {
      return route(request, {Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0)});
    }
    if (does == "huge") {
      return route(request, {Vec3(1e300, -1e300, 1e300)});
    }
    if (does == "wrong_end") {
      PlanResult result = route(request, {});
      result.route.edit().back().x() += 7;
      return result;
    }
    if (does == "no_points") {
      PlanResult result = route(request, {});
      result.route.edit().clear();
      return result;
    }
    if (does == "endless_turn") {
      PlanResult result = route(request, {});
      result.route = {};
      result.route.push_back(
          Leg{request.start.position, request.goal.position, kInfinity, 100, 0, Vec3::Zero()});
      return result;
    }
    if (does == "never_stops") {
      while (true) {
        pause();
      }
    }
    if (does == "allocates" || does == "waits") {
      std::vector<std::vector<char>> hoard;
      while (!request.budget.stop.stop_requested()) {
        if (does == "allocates") {
          hoard.emplace_back(1 << 20, 'x');
        }
        pause();
      }
      PlanResult result;
      result.status = PlanStatus::cancelled;
      return result;
    }
    if (does == "throws") {
      throw std::runtime_error("the attic is on fire");
    }
    if (does == "throws_int") {
      throw 42;
    }
    if (does == "refuses_does") {
      throw ParameterError("does", "this does not fit the problem");
    }
    if (does == "uses_budget") {
      return use_budget(request);
    }
    if (does == "no_route") {
      PlanResult result;
      result.status = PlanStatus::no_route;
      result.message = "walls all around";
      return result;
    }
    return route(request, {});
  }
  Traits do_traits() const override { return {}; }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "told", Told, Params, "does as it is told")
