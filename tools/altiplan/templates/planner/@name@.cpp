// SPDX-License-Identifier: Apache-2.0
#include <altiplan/check.hpp>
#include <altiplan/planner.hpp>
#include <altiplan/plugin.hpp>

namespace {
using namespace altiplan;

struct Params {
  double step_m = 100;
  int tries = 50;

  void describe(Fields& f) {  // the only place that lists them
    f("step_m", step_m).unit("m").greater_than(0).doc("increase of the lateral offset per try");
    f("tries", tries).range(0, 10000).doc("maximum number of bends tried on each side");
  }
};

class Dogleg final : public Planner {
 public:
  explicit Dogleg(const Params& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    const Vec3 start = request.start.position;
    const Vec3 goal = request.goal.position;
    const Vec3 left = Vec3(start.y() - goal.y(), goal.x() - start.x(), 0).normalized();
    PlanResult result;
    BudgetWatch watch(request.budget);
    int tried = 0;
    for (; tried <= 2 * params_.tries && !watch.spent(std::uint64_t(tried)); ++tried) {
      const double out = params_.step_m * ((tried + 1) / 2) * (tried % 2 == 0 ? 1 : -1);
      const Route route = {start, (start + goal) / 2 + out * left, goal};
      if (check(route, request).ok()) {  // the judge's own code
        result.status = PlanStatus::solved;
        result.route = route;
        break;
      }
    }
    result.counters = {{"expanded", tried}};
    if (result.route.empty()) {
      const bool spent = tried <= 2 * params_.tries;
      result.status = !spent              ? PlanStatus::no_route
                      : watch.cancelled() ? PlanStatus::cancelled
                                          : PlanStatus::timed_out;
      result.budget_hit = result.status == PlanStatus::timed_out;
      result.message = "no route with a single bend found in " + std::to_string(tried) + " tries";
    }
    return result;
  }
  Traits do_traits() const override { return {}; }  // no guarantees

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "@name@", Dogleg, Params,
                "Straight to the goal, or around obstacles with one bend")
