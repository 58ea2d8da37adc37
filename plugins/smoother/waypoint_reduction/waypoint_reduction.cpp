// SPDX-License-Identifier: Apache-2.0
//
// Waypoint reduction: Li Chuntao, Yi Xiaoqin, Hu Mu, "Real-time path planning of UAV based on
// velocity vector field", Journal of Nanjing University of Aeronautics & Astronautics 44(3), 2012,
// 340-346 (paper 001), section 4.
//
// Guarantees: every new leg satisfies the request's constraints on legs and turns by at most
//   max_turn_deg, the first one from the heading at the start. Not the fewest points (see smoother
//   prune), and no point moves.
// Complexity: O(n) leg checks for each kept point, so O(n^2) for n waypoints.
// Deviations: legs are checked against every constraint of the request, not only threats. If no end
//   is admissible, a case that the paper does not cover, the next point is kept.
// Symbols: p_begin, p_end the two pointers into the route.
#include "altiplan/check.hpp"
#include "altiplan/kit/smoothing/corners.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/smoother.hpp"

namespace {
using namespace altiplan;

struct Params {
  double max_turn_deg = 90;

  void describe(Fields& f) {
    f("max_turn_deg", max_turn_deg)
        .unit("deg")
        .range(0, 180)
        .doc("maximum turn of a new leg from the leg before it, or from the start's heading");
  }
};

/// The two pointers over one route.
class Reduction {
 public:
  Reduction(const Polyline& route, const Request& request, double max_turn)
      : route_(route), request_(request), watch_(request.budget), max_turn_(max_turn) {}

  /// The kept points; truncated if the budget was used up.
  Polyline reduced() {
    Polyline kept{route_.front()};
    std::optional<Approach> before = request_.before_start();  // at a via point: the leg to it
    std::size_t begin = 0;
    while (begin + 1 < route_.size() && !budget_hit_) {
      const std::size_t end = farthest_end(before, begin);
      before = onward(before, route_[begin]);
      begin = end;
      kept.push_back(route_[end]);
    }
    return kept;
  }

  std::int64_t legs_checked() const { return std::int64_t(legs_checked_); }
  std::int64_t without_end() const { return without_end_; }
  bool budget_hit() const { return budget_hit_; }

 private:
  std::size_t farthest_end(const std::optional<Approach>& before, std::size_t begin) {
    for (std::size_t end = route_.size() - 1; end > begin && !budget_hit_; --end) {
      if (is_admissible(before, route_[begin], route_[end])) {
        return end;
      }
    }
    ++without_end_;
    return begin + 1;
  }

  bool is_admissible(const std::optional<Approach>& before, const Vec3& a, const Vec3& b) {
    budget_hit_ = watch_.spent(legs_checked_);
    if (budget_hit_) {
      return false;
    }
    ++legs_checked_;
    return (!before ||
            turn_angle_in_space(a - before->from, b - a) <= max_turn_ + kAngleTolerance) &&
           leg_ok(before, a, b, request_);
  }

  const Polyline& route_;
  const Request& request_;
  BudgetWatch watch_;
  double max_turn_;
  std::uint64_t legs_checked_ = 0;
  std::int64_t without_end_ = 0;
  bool budget_hit_ = false;
};

class WaypointReduction final : public Smoother {
 public:
  explicit WaypointReduction(const Params& params) : max_turn_(radians(params.max_turn_deg)) {}

 private:
  PlanResult do_smooth(const Polyline& route, const Request& request) const override {
    const Polyline clean = without_repeats(route);
    Reduction reduction(clean, request, max_turn_);
    Polyline reduced = reduction.reduced();
    PlanResult result;
    result.status = PlanStatus::solved;
    result.budget_hit = reduction.budget_hit();
    result.counters = {{"legs_checked", reduction.legs_checked()},
                       {"points_without_end", reduction.without_end()}};
    if (result.budget_hit) {
      result.route = route;
      result.message = "the budget was used up: the route is unchanged";
    } else if (!kit::Excess(check(reduced, request).violations)
                    .within(kit::Excess(check(route, request).violations))) {
      // A point kept for lack of an end may turn more sharply than the constraints allow.
      result.route = route;
      result.message =
          "the reduced route would violate a constraint, or violate it more: the route is "
          "unchanged";
    } else {
      result.route = std::move(reduced);
      result.message = std::to_string(result.route.size()) + " of " + std::to_string(route.size()) +
                       " waypoints kept" + of_points_without_end(reduction.without_end());
    }
    return result;
  }

  static std::string of_points_without_end(std::int64_t count) {
    return count == 0 ? ""
                      : "; from " + std::to_string(count) + (count == 1 ? " point" : " points") +
                            " no leg to a later one is admissible, so the next one is kept";
  }

  double max_turn_;
};
}  // namespace

ALTIPLAN_PLUGIN(Smoother, "waypoint_reduction", WaypointReduction, Params,
                "two pointers: from each point to the farthest one that a valid leg reaches")
