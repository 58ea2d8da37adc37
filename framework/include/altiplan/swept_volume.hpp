// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "altiplan/body.hpp"
#include "altiplan/shape.hpp"

namespace altiplan {

/// Maximum excess of a swept volume, and of what is known about obstacles, in checks of a body:
/// within it of an obstacle a body counts as blocked.
inline constexpr double kBodyTolerance = 1e-3;  // metres

/// Position and attitude of a body: p in the world is at + rotation p in body axes.
struct Placement {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vec3 at{0, 0, 0};
};

/// A convex set: what a part of a body sweeps between placements, the convex hull of the part at
/// each of them, grown by `grown` metres. Layers say whether they share a point with it.
///
/// Decided by FCL's test of two convex sets (LIBCCD, by support functions) in coordinates about the
/// volume, with obstacles cut to its surroundings; see docs/decisions/0002-fcl.md.
class ALTIPLAN_API SweptVolume {
 public:
  /// `outer`: no point of the part is farther from the reference point.
  SweptVolume(const BodyPart& part, double outer, std::span<const Placement> placements,
              double grown);

  const Box& box() const { return box_; }
  /// The volume lies within reach() metres of the leg from()–to().
  const Vec3& from() const { return from_; }
  const Vec3& to() const { return to_; }
  double reach() const { return reach_; }
  /// A point of it, and the lowest and the highest one.
  Vec3 centre() const { return origin_ + centre_; }
  Vec3 lowest() const { return origin_ + support({0, 0, -1}); }
  Vec3 highest() const { return origin_ + support({0, 0, 1}); }

  /// True if it shares a point with the convex hull of the corners; never false where they overlap
  /// by more than rounding, never true where they are kBodyTolerance / 10 apart.
  bool meets(std::span<const Vec3> corners) const;
  bool meets(const Box& box) const;
  bool meets(const Shape& shape) const;

  /// The farthest point in a direction, from an origin of its own.
  Vec3 support(const Vec3& direction) const;
  const Vec3& support_origin() const { return origin_; }
  const Vec3& support_centre() const { return centre_; }

 private:
  Vec3 from_;
  Vec3 to_;
  double reach_;
  Vec3 origin_;
  Vec3 centre_;
  std::vector<Vec3> points_;  ///< from the origin
  double rounding_;
  double grown_;
  Box box_;
};

/// True unless the volume is known to be free of a layer with that clearance, which is 1-Lipschitz
/// and never more than the distance: by halving boxes around the volume, down to `tolerance`
/// metres or a 64th of its longest edge.
ALTIPLAN_API bool meets_by_clearance(const SweptVolume& volume,
                                     const std::function<double(const Vec3&)>& clearance,
                                     double tolerance);
}  // namespace altiplan
