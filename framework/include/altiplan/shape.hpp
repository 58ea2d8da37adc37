// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// Solid shapes, closed sets, placed by `centre` or their own coordinates (metres).
struct Sphere {
  Vec3 centre{0, 0, 0};
  double radius = 0;
};

/// Vertical cylinder between two heights (which may be infinite).
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

/// Vertical prism over a simple polygon (either sense, not closed by a repeated point) with
/// optional holes, between two heights.
struct Prism {
  std::vector<std::array<double, 2>> outline;
  std::vector<std::vector<std::array<double, 2>>> holes;
  double floor = -kInfinity;
  double ceiling = kInfinity;
};

using Shape = std::variant<Sphere, Cylinder, BoxShape, Prism>;

ALTIPLAN_API Box bounds(const Shape& shape);
/// The shape moved by `offset`.
ALTIPLAN_API Shape moved(const Shape& shape, const Vec3& offset);
/// Signed distance from p to the shape's surface, negative inside (minus the depth); closed form.
ALTIPLAN_API double signed_distance(const Shape& shape, const Vec3& p);
/// Least distance between the leg a–b and the solid shape, 0 where they meet; closed form.
ALTIPLAN_API double leg_distance(const Shape& shape, const Vec3& a, const Vec3& b);
/// Whether leg_distance(shape, a, b) < limit, mostly known much sooner.
ALTIPLAN_API bool comes_within(const Shape& shape, const Vec3& a, const Vec3& b, double limit);
/// How deep the leg a–b gets into the shape, 0 where it does not: between half the greatest depth
/// and all of it (exactly 0 for a leg that only touches).
ALTIPLAN_API double leg_depth(const Shape& shape, const Vec3& a, const Vec3& b);
/// Point of the shape's surface nearest to p.
ALTIPLAN_API Vec3 nearest_surface_point(const Shape& shape, const Vec3& p);
/// Whether the shape, grown by `by` metres, overlaps the open box.
ALTIPLAN_API bool overlaps(const Shape& shape, const Box& box, double by);
}  // namespace altiplan
