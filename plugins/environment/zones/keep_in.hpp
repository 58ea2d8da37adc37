// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/swept_volume.hpp"

namespace altiplan::zones {

/// The volume outside keep-in zones, one or more. A sphere is allowed if it lies wholly inside one
/// of them; so the depth of a point is its maximum depth in a zone, and the layer is that far away.
class KeepIn {
 public:
  explicit KeepIn(std::vector<Shape> zones) : zones_(std::move(zones)) {}

  double clearance(const Vec3& p) const { return -zones_.clearance(p); }
  /// Exact: true if some point of the leg is less than r - 1e-6 m deep in every zone.
  bool blocked(const Vec3& a, const Vec3& b, double r) const;
  /// True unless all of the volume is known to lie in zones.
  bool meets(const SweptVolume& volume) const {
    return meets_by_clearance(
        volume, [this](const Vec3& p) { return clearance(p); }, kBodyTolerance);
  }
  Nearby nearest(const Vec3& p) const;
  /// Frees no cell that is not allowed; exact for convex zones.
  void rasterize(VoxelGrid& grid) const;

 private:
  kit::ObstacleSet zones_;
};
}  // namespace altiplan::zones
