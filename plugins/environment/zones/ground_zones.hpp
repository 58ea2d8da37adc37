// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/world.hpp"

namespace altiplan::zones {

/// A prism whose floor or ceiling may follow the ground. One of each pair is infinite; at a limit
/// above the ground the prism's own one is.
struct GroundPrism {
  Prism prism;
  double above_floor = -kInfinity;
  double above_ceiling = kInfinity;
  double slope = 0;  ///< of the ground over its bounding rectangle, at most

  bool follows_ground() const { return std::isfinite(above_floor) || std::isfinite(above_ceiling); }
};

/// Zones with limits above the ground, which is known all over their bounding rectangles.
///
/// A point's distance to a zone is bounded from below by the greatest of three functions that are
/// 1-Lipschitz: its horizontal distance to the outline, and its heights above the ceiling and below
/// the floor, divided by √(1 + s²) where that limit follows the ground, of slope s at most.
///
/// A leg meets a zone if somewhere over the outline its height is within the limits. Over a part
/// that lies wholly over the outline the height above ground is continuous: some value between its
/// minimum and maximum, which the ground knows exactly, lies within the limits if any does. For a
/// radius r the outline is grown by r, limits above the sea by r, and those above ground by
/// r √(1 + s²).
class GroundZones {
 public:
  GroundZones() : GroundZones(World(), {}) {}
  GroundZones(World ground, std::vector<GroundPrism> prisms);

  bool empty() const { return zones_.empty(); }
  std::size_t size() const { return zones_.size(); }
  Box bounds() const { return bounds_; }
  double clearance(const Vec3& p) const;
  bool blocked(const Vec3& a, const Vec3& b, double r) const;
  bool meets(const SweptVolume& volume) const;
  /// Ids count from `first_id`.
  void near(const Vec3& p, double reach, int first_id, const NearSink& sink) const;
  void rasterize(VoxelGrid& grid) const;
  /// How much farther than r a zone may be that blocks: none at radius 0.
  double over_approximation(double r) const;
  /// A zone between the lowest and the highest of its limits, for a picture.
  Shape drawn(std::size_t zone) const;

 private:
  struct Zone {
    GroundPrism limits;
    Shape outline;  ///< at all heights
    Box area;       ///< horizontal
    Box bounds;
    double slope;
    double steepness;  ///< √(1 + slope²)
  };

  static Zone zone_of(const World& ground, GroundPrism&& prism);
  double distance(const Zone& zone, const Vec3& p) const;
  bool meets_leg(const Zone& zone, const Vec3& a, const Vec3& b, double r) const;
  bool meets_part(const Zone& zone, const Vec3& a, const Vec3& b, double keep) const;
  bool meets_over_ground(const Zone& zone, const Vec3& a, const Vec3& b, double keep) const;

  World ground_;
  std::vector<Zone> zones_;
  kit::ObstacleSet outlines_;
  Box bounds_ = Box::empty();
};
}  // namespace altiplan::zones
