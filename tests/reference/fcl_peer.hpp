// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "altiplan/shape.hpp"

namespace altiplan::bench {

/// Shapes in FCL's DynamicAABBTreeCollisionManager, asked by libccd's solver. Cylinders and prisms
/// must have finite heights and prisms must be convex, without holes, their corners
/// counterclockwise.
class FclPeer {
 public:
  explicit FclPeer(const std::vector<Shape>& shapes);
  ~FclPeer();
  FclPeer(FclPeer&&) noexcept;

  /// Whether a sphere of radius r that flies a–b, a capsule, collides.
  bool blocked(const Vec3& a, const Vec3& b, double r) const;
  /// Distance from a ball of 1 mm at p to the nearest shape, plus that; not above 0 inside.
  double clearance(const Vec3& p) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace altiplan::bench
