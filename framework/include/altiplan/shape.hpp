// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// Solid shapes, closed sets, positioned by `centre` or their own coordinates (metres).
struct Sphere {
  Vec3 centre{0, 0, 0};
  double radius = 0;
};

/// Vertical cylinder between two altitudes (which may be infinite).
struct Cylinder {
  double x = 0;
  double y = 0;
  double radius = 0;
  double floor = -kInfinity;
  double ceiling = kInfinity;
};

struct BoxShape {
  Box box;
};

/// Vertical prism over a simple polygon (either orientation, not closed by a repeated point) with
/// optional holes, between two altitudes. Two points are a wall without thickness.
struct Prism {
  std::vector<std::array<double, 2>> outline{};
  std::vector<std::vector<std::array<double, 2>>> holes{};
  double floor = -kInfinity;
  double ceiling = kInfinity;
};

using Shape = std::variant<Sphere, Cylinder, BoxShape, Prism>;

ALTIPLAN_API Box bounds(const Shape& shape);
/// The shape translated by `offset`.
ALTIPLAN_API Shape moved(const Shape& shape, const Vec3& offset);
/// Signed distance from p to the shape's surface, negative inside (minus the depth); closed form.
ALTIPLAN_API double signed_distance(const Shape& shape, const Vec3& p);
/// Minimum distance between the leg a–b and the solid shape, 0 where they meet; closed form.
ALTIPLAN_API double leg_distance(const Shape& shape, const Vec3& a, const Vec3& b);
/// True if leg_distance(shape, a, b) < limit, usually decided much sooner.
ALTIPLAN_API bool comes_within(const Shape& shape, const Vec3& a, const Vec3& b, double limit);
/// Penetration depth of the leg a–b into the shape, 0 where it does not enter: between half of the
/// maximum depth and all of it (exactly 0 for a leg that only touches).
ALTIPLAN_API double leg_depth(const Shape& shape, const Vec3& a, const Vec3& b);
/// Point of the shape's surface nearest to p.
ALTIPLAN_API Vec3 nearest_surface_point(const Shape& shape, const Vec3& p);
/// True if the shape, grown by `by` metres, overlaps the open box.
ALTIPLAN_API bool overlaps(const Shape& shape, const Box& box, double by);
}  // namespace altiplan
