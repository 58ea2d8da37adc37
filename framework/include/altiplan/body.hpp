// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// A convex part of a body: the points within `rounding` metres of the convex hull of the corners.
/// Body axes: x forward, y left, z up, metres from the vehicle's reference point.
struct BodyPart {
  std::vector<Vec3> corners{};
  double rounding = 0;
  double inner_m = 0;  ///< a sphere of that radius about the reference point lies in the part
  double outer_m = 0;  ///< and one of that radius contains it
};

/// Sizes along x, y and z; centred at the offset.
ALTIPLAN_API BodyPart box_part(const Vec3& size_m, const Vec3& offset_m);
/// Upright; the prism of 32 sides around it, up to 0.5 % wider.
ALTIPLAN_API BodyPart cylinder_part(double radius_m, double height_m, const Vec3& offset_m);
/// Along x; `length_m` includes both caps. Throws Error if it is shorter than wide.
ALTIPLAN_API BodyPart capsule_part(double radius_m, double length_m, const Vec3& offset_m);
/// The convex hull of points. Throws Error if it has no volume (a width below 1 mm) or more than
/// kMaxCorners corners.
ALTIPLAN_API BodyPart hull_part(const std::vector<Vec3>& points);
inline constexpr std::size_t kMaxCorners = 2000;

/// What a vehicle consists of, and how it is held along a route. The route is that of its reference
/// point, which must stay free too.
struct ALTIPLAN_API Body {
  std::vector<BodyPart> parts;
  /// Fixed heading, counter-clockwise from east, radians; none: the nose points along the route (of
  /// an aeroplane, into its motion through the air).
  std::optional<double> yaw{};
  bool pitches = false;  ///< true: by the climb angle; false: it stays level

  /// Radius of a sphere about the reference point that one part contains, and of the smallest that
  /// contains all parts.
  double inner_m() const;
  double outer_m() const;
};
}  // namespace altiplan
