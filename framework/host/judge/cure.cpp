// SPDX-License-Identifier: Apache-2.0
#include "host/judge/cure.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan::host {
namespace {

constexpr int kMost = 10'000;  ///< steps
constexpr double kStep = 0.1;  ///< metres

class Trial {
 public:
  Trial(const Polyline& points, std::size_t leg, std::size_t waypoint, const Request& request)
      : points_(points),
        height_(points[waypoint].z()),
        waypoint_(waypoint),
        first_(std::min(leg, waypoint == 0 ? 0 : waypoint - 1)),
        last_(std::min(std::max(leg, waypoint), points.size() - 2)),
        request_(request) {}

  bool is_valid(int steps) {
    points_[waypoint_].z() = height_ + steps * kStep;
    std::optional<Approach> before = request_.before_start(points_.front());
    for (std::size_t i = 0; i <= last_; ++i) {
      if (i >= first_ && !leg_ok(before, points_[i], points_[i + 1], request_)) {
        return false;
      }
      if (points_[i] != points_[i + 1]) {
        before = onward(before, points_[i]);
      }
    }
    return true;
  }

  /// The least number of steps up (sign 1) or down (-1), found by doubling and halving; 0: none.
  int least(int sign) {
    int enough = 1;
    while (!is_valid(sign * enough)) {
      enough *= 2;
      if (enough > kMost) {
        return 0;
      }
    }
    int few = enough / 2;
    while (enough - few > 1) {
      const int middle = (few + enough) / 2;
      (is_valid(sign * middle) ? enough : few) = middle;
    }
    return sign * enough;
  }

 private:
  Polyline points_;
  double height_;
  std::size_t waypoint_;
  std::size_t first_;  ///< legs
  std::size_t last_;
  const Request& request_;
};
}  // namespace

std::optional<Cure> cure(const Route& route, const Violation& violation, const Request& request) {
  if (!route.is_straight() || violation.at >= route.leg_count()) {
    return std::nullopt;
  }
  std::optional<Cure> best;
  for (const std::size_t waypoint : {violation.at, violation.at + 1}) {
    Trial trial(route.waypoints(), violation.at, waypoint, request);
    for (const int sign : {1, -1}) {
      const int steps = trial.least(sign);
      if (steps != 0 && (!best || std::abs(steps * kStep) < std::abs(best->by_m))) {
        best = Cure{waypoint, steps * kStep};
      }
    }
  }
  return best;
}
}  // namespace altiplan::host
