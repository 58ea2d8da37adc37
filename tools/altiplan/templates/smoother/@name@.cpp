// SPDX-License-Identifier: Apache-2.0
#include <altiplan/check.hpp>
#include <altiplan/plugin.hpp>
#include <altiplan/smoother.hpp>

namespace {
using namespace altiplan;

struct Params {
  int passes = 2;

  void describe(Fields& f) {  // the only place that lists them
    f("passes", passes).range(1, 100).doc("number of passes along the route");
  }
};

class DropWaypoints final : public Smoother {
 public:
  explicit DropWaypoints(const Params& params) : params_(params) {}

 private:
  // A waypoint is dropped only if the judge's own code accepts the shorter route, so a route that
  // violates a constraint is returned improved or unchanged.
  PlanResult do_smooth(const Polyline& route, const Request& request) const override {
    PlanResult result;
    result.status = PlanStatus::solved;
    result.route = route;
    BudgetWatch watch(request.budget);
    std::int64_t tried = 0;
    for (int pass = 0; pass < params_.passes && !result.budget_hit; ++pass) {
      for (std::size_t at = 1; at + 1 < result.route.size();) {
        if (watch.spent(std::uint64_t(tried))) {
          result.budget_hit = true;
          break;
        }
        ++tried;
        Polyline shorter = result.route.waypoints();
        shorter.erase(shorter.begin() + std::ptrdiff_t(at));
        if (check(shorter, request).ok()) {
          result.route = std::move(shorter);
        } else {
          ++at;
        }
      }
    }
    result.message = std::to_string(result.route.size()) + " of " + std::to_string(route.size()) +
                     " waypoints kept";
    result.counters = {{"expanded", tried}};
    return result;
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Smoother, "@name@", DropWaypoints, Params, "Removes waypoints that are not needed")
