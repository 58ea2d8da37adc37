// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "altiplan/moving_obstacle.hpp"

namespace altiplan {
namespace {
/// The flight's ends relative to the obstacle, which stays as it is at since_s.
std::pair<Vec3, Vec3> relative(const MovingObstacle& obstacle, const Vec3& a, double t0,
                               const Vec3& b, double t1) {
  return {a - obstacle.velocity * (t0 - obstacle.since_s),
          b - obstacle.velocity * (t1 - obstacle.since_s)};
}
}  // namespace

bool hits(const MovingObstacle& obstacle, const Vec3& a, double t0, const Vec3& b, double t1,
          double r) {
  const auto [from, to] = relative(obstacle, a, t0, b, t1);
  const double limit = r - kLengthTolerance;
  const double distance = leg_distance(obstacle.shape, from, to);
  // A point (r below the tolerance) hits if it is inside, as touching is free; leg_depth may be
  // half of the leg's maximum depth.
  return distance < limit || (limit <= 0 && distance <= kLengthTolerance &&
                              -leg_depth(obstacle.shape, from, to) < r - kLengthTolerance / 2);
}

double separation(const MovingObstacle& obstacle, const Vec3& a, double t0, const Vec3& b,
                  double t1) {
  const auto [from, to] = relative(obstacle, a, t0, b, t1);
  return leg_distance(obstacle.shape, from, to);
}
}  // namespace altiplan
