// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "altiplan/request.hpp"

namespace altiplan::kit {

/// Number of axes along which a sampling planner's points may differ.
inline int free_axes(const Box& box) {
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    axes += box.max[axis] > box.min[axis] ? 1 : 0;
  }
  return axes;
}

/// The box that a planner samples: the volume, in level flight at the level.
inline Box sampled_box(const Request& request) {
  Box box = request.volume;
  if (request.level_m) {
    box.min.z() = box.max.z() = *request.level_m;
  }
  return box;
}

/// Maximum length of a tree's legs, within the limits on their length; by default a tenth of the
/// volume's diagonal, or twice the minimum leg if that is more.
inline double range_of(const std::optional<double>& range, const Request& request) {
  const double open = (request.volume.max - request.volume.min).norm() / 10;
  const double wanted = range.value_or(std::max(open, 2 * request.limits.min_leg));
  return std::min(std::max(wanted, request.limits.min_leg), request.limits.max_leg);
}

/// Length, area or volume of the box over its non-degenerate axes.
inline double measure_of(const Box& box) {
  double measure = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double edge = box.max[axis] - box.min[axis];
    measure *= edge > 0 ? edge : 1;
  }
  return measure;
}

/// The points through which a route between two foci may be shorter than a length: the spheroid (in
/// level flight the ellipse) of J. D. Gammell, S. S. Srinivasa, T. D. Barfoot: Informed RRT*.
class ALTIPLAN_API InformedSet {
 public:
  /// On a level `box` has no height, and both foci lie on it.
  InformedSet(const Vec3& start, const Vec3& goal, const Box& box);

  /// At least the distance of the foci; infinite at first.
  void set_length(double length);
  bool contains(const Vec3& p) const { return (p - start_).norm() + (p - goal_).norm() <= length_; }
  /// Of the set or of the box, whichever is smaller.
  double measure() const { return std::min(own_measure_, box_measure_); }
  /// A uniform sample of the intersection with the box; of the box alone where the two hardly
  /// overlap.
  Vec3 draw(RandomStream& random) const;

 private:
  Vec3 start_;
  Vec3 goal_;
  Box box_;
  double box_measure_;
  bool flat_;
  double length_ = kInfinity;
  double own_measure_ = kInfinity;
  Vec3 middle_;
  Vec3 long_;  ///< half axes: along the foci, and two across
  Vec3 across_;
  Vec3 beside_;
};

/// The direction `wanted` from `at`, rotated as little as possible to satisfy the limits on climb,
/// and on turns for a vehicle that arrives by `before`.
ALTIPLAN_API Vec3 bent(const std::optional<Approach>& before, const Vec3& at, const Vec3& wanted,
                       double range, const Limits& limits);

/// The end of a leg from `at` toward `target`, at most `range` long: rotated as little as possible
/// to satisfy the limits on climb, and on turns after arriving by `before`, and no shorter than the
/// minimum leg. `target` itself if it satisfies all of these. Only leg_ok checks the limits
/// together.
inline Vec3 steer(const std::optional<Approach>& before, const Vec3& at, const Vec3& target,
                  double range, const Limits& limits) {
  const Vec3 wanted = target - at;
  const double run = wanted.norm();
  constexpr double kLonger = 1 + 1e-9;  // keeps the leg off the limit
  const double length =
      std::min(std::max(std::min(run, range), limits.min_leg * kLonger), limits.max_leg);
  Vec3 way = wanted;
  double way_length = run;
  if ((before && limits.turns()) || limits.max_slope() < kPi / 2) {
    way = bent(before, at, wanted, range, limits);
    way_length = way.norm();
  }
  if (way == wanted && length == run) {
    return target;
  }
  return way_length == 0 ? at : Vec3(at + way * (length / way_length));
}
}  // namespace altiplan::kit
