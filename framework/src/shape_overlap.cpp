// SPDX-License-Identifier: Apache-2.0
// Whether a shape overlaps a box, as voxel grids ask.
#include "altiplan/shape.hpp"
#include "shape_parts.hpp"

namespace altiplan {
namespace {

using namespace shape_parts;

// Overlaps of a box by less than this are touches, metres: well above the rounding of coordinates
// of 100 km, well below anything that flies.
constexpr double kTouch = 1e-9;

// Least distance between the plan of a prism and a rectangle.
double plan_gap(const Prism& prism, const Box& box) {
  const Vec3 centre = (box.min + box.max) / 2;
  if (covers(prism, centre.x(), centre.y())) {
    return 0;
  }
  const Shape column =
      BoxShape{{{box.min.x(), box.min.y(), -kInfinity}, {box.max.x(), box.max.y(), kInfinity}}};
  double least = kInfinity;
  for_each_edge(prism, [&](const Point2& e, const Point2& f) {
    const Vec3 from(e[0], e[1], 0);
    const Vec3 to(f[0], f[1], 0);
    const Box edge = leg_box(from, to);
    if (std::max(interval_gap(edge.min.x(), edge.max.x(), box.min.x(), box.max.x()),
                 interval_gap(edge.min.y(), edge.max.y(), box.min.y(), box.max.y())) < least) {
      least = std::min(least, leg_distance(column, from, to));
    }
  });
  return least;
}

struct BoxGap {
  const Box& box;

  double vertical(double floor, double ceiling) const {
    return interval_gap(floor, ceiling, box.min.z(), box.max.z());
  }
  double operator()(const Sphere& s) const {
    return (s.centre - clamped(box, s.centre)).norm() - s.radius;
  }
  double operator()(const Cylinder& c) const {
    const Vec3 axis(c.x, c.y, box.min.z());
    const double horizontal = (axis - clamped(box, axis)).norm() - c.radius;
    return std::hypot(std::max(horizontal, 0.0), vertical(c.floor, c.ceiling));
  }
  double operator()(const BoxShape& s) const {
    return (s.box.min - box.max).cwiseMax(box.min - s.box.max).cwiseMax(0.0).norm();
  }
  double operator()(const Prism& prism) const {
    return std::hypot(plan_gap(prism, box), vertical(prism.floor, prism.ceiling));
  }
};

}  // namespace

bool overlaps(const Shape& shape, const Box& box, double by) {
  // The open box is taken as the closed one, smaller by what still counts as touching.
  const Vec3 shrink = Vec3::Constant(kTouch).cwiseMin((box.max - box.min) / 4);
  const Box inner{box.min + shrink, box.max - shrink};
  return std::visit(BoxGap{inner}, shape) <= by;
}
}  // namespace altiplan
