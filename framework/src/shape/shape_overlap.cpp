// SPDX-License-Identifier: Apache-2.0
// Overlap of a shape and a box, for voxel grids.
#include "altiplan/shape.hpp"
#include "shape_parts.hpp"

namespace altiplan {
namespace {

using namespace shape_parts;

// Overlaps of a box by less than this count as touching, metres: well above the rounding of
// coordinates of 100 km, well below the size of any aircraft.
constexpr double kTouch = 1e-9;

// Minimum distance between the plan of a prism and a rectangle.
template <class Edges>
double plan_gap(const Edges& edges, const Box& box) {
  const Vec3 centre = (box.min + box.max) / 2;
  if (edges.covers(centre.x(), centre.y())) {
    return 0;
  }
  const Shape column =
      BoxShape{{{box.min.x(), box.min.y(), -kInfinity}, {box.max.x(), box.max.y(), kInfinity}}};
  double min_distance = kInfinity;
  const auto gap = [&](const Point2& low, const Point2& high) {
    return std::max(interval_gap(low[0], high[0], box.min.x(), box.max.x()),
                    interval_gap(low[1], high[1], box.min.y(), box.max.y()));
  };
  edges.visit([&](const EdgeTree::Rectangle& node) { return gap(node.min, node.max); },
              [&] { return min_distance; },
              [&](const Point2& e, const Point2& f) {
                const Point2 low{std::min(e[0], f[0]), std::min(e[1], f[1])};
                const Point2 high{std::max(e[0], f[0]), std::max(e[1], f[1])};
                if (gap(low, high) < min_distance) {
                  const Vec3 from(e[0], e[1], 0);
                  const Vec3 to(f[0], f[1], 0);
                  min_distance = std::min(min_distance, altiplan::leg_distance(column, from, to));
                }
              });
  return min_distance;
}

struct BoxGap {
  const Box& box;
  const EdgeTree* tree;

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
    const double horizontal =
        with_edges(prism, tree, [&](const auto& edges) { return plan_gap(edges, box); });
    return std::hypot(horizontal, vertical(prism.floor, prism.ceiling));
  }
};

}  // namespace

bool shape_parts::overlaps(const Indexed& solid, const Box& box, double by) {
  // The open box is treated as the closed one, shrunk by the margin that still counts as touching.
  const Vec3 shrink = Vec3::Constant(kTouch).cwiseMin((box.max - box.min) / 4);
  const Box inner{box.min + shrink, box.max - shrink};
  return std::visit(BoxGap{inner, solid.tree}, solid.shape) <= by;
}

bool overlaps(const Shape& shape, const Box& box, double by) {
  return shape_parts::overlaps({shape, nullptr}, box, by);
}
}  // namespace altiplan
