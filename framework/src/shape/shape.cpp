// SPDX-License-Identifier: Apache-2.0
#include "altiplan/shape.hpp"

#include "shape_parts.hpp"

namespace altiplan {
namespace {

using namespace shape_parts;

// All shapes but the sphere are products of a plane region and a height interval: distances combine
// by Pythagoras outside, depths by their minimum inside.
double product_distance(double horizontal, double vertical) {
  // With one of them 0 the hypotenuse is the other.
  return horizontal <= 0 || vertical <= 0 ? std::max(horizontal, vertical)
                                          : std::hypot(horizontal, vertical);
}

double plane_distance(const Plan& plan, double x, double y) {
  const double distance = std::hypot(x - plan.nearest[0], y - plan.nearest[1]);
  return plan.is_inside ? -distance : distance;
}

Plan plan_at(const Prism& prism, const EdgeTree* tree, double x, double y) {
  return with_edges(prism, tree, [&](const auto& edges) { return edges.plan_at(x, y); });
}

double plane_distance(const Prism& prism, const EdgeTree* tree, double x, double y) {
  return plane_distance(plan_at(prism, tree, x, y), x, y);
}

double plane_distance(const Cylinder& c, const EdgeTree*, double x, double y) {
  return std::hypot(x - c.x, y - c.y) - c.radius;
}

// Point of the surface of region x [floor, ceiling] nearest to p, given that of the region's
// outline and p's signed distance from it.
Vec3 nearest_of_product(const Vec3& p, double horizontal, const Point2& side, double floor,
                        double ceiling) {
  const double vertical = interval_distance(floor, ceiling, p.z());
  if (horizontal <= 0 && vertical <= 0) {
    if (horizontal >= vertical) {
      return {side[0], side[1], p.z()};
    }
    return {p.x(), p.y(), floor - p.z() == vertical ? floor : ceiling};
  }
  return {horizontal > 0 ? side[0] : p.x(), horizontal > 0 ? side[1] : p.y(),
          std::max(floor, std::min(ceiling, p.z()))};
}

}  // namespace

Box bounds(const Shape& shape) {
  return std::visit(
      Overloaded{[](const Sphere& s) {
                   return Box{s.centre, s.centre}.grown(s.radius);
                 },
                 [](const Cylinder& c) {
                   return Box{{c.x - c.radius, c.y - c.radius, c.floor},
                              {c.x + c.radius, c.y + c.radius, c.ceiling}};
                 },
                 [](const BoxShape& s) { return s.box; },
                 [](const Prism& prism) {
                   Box box = Box::empty();
                   for (const Point2& p : prism.outline) {
                     box = box.with({p[0], p[1], prism.floor}).with({p[0], p[1], prism.ceiling});
                   }
                   return box;
                 }},
      shape);
}

Shape moved(const Shape& shape, const Vec3& offset) {
  Shape result = shape;
  const auto move_ring = [&](std::vector<Point2>& ring) {
    for (Point2& p : ring) {
      p = {p[0] + offset.x(), p[1] + offset.y()};
    }
  };
  std::visit(Overloaded{[&](Sphere& s) { s.centre += offset; },
                        [&](Cylinder& c) {
                          c.x += offset.x();
                          c.y += offset.y();
                          c.floor += offset.z();
                          c.ceiling += offset.z();
                        },
                        [&](BoxShape& s) {
                          s.box.min += offset;
                          s.box.max += offset;
                        },
                        [&](Prism& prism) {
                          move_ring(prism.outline);
                          std::for_each(prism.holes.begin(), prism.holes.end(), move_ring);
                          prism.floor += offset.z();
                          prism.ceiling += offset.z();
                        }},
             result);
  return result;
}

double shape_parts::signed_distance(const Indexed& solid, const Vec3& p) {
  const auto product = [&](const auto& s) {
    return product_distance(plane_distance(s, solid.tree, p.x(), p.y()),
                            interval_distance(s.floor, s.ceiling, p.z()));
  };
  return std::visit(Overloaded{[&](const Sphere& s) { return (p - s.centre).norm() - s.radius; },
                               [&](const BoxShape& s) {
                                 const Vec3 out = (s.box.min - p).cwiseMax(p - s.box.max);
                                 return out.maxCoeff() <= 0 ? out.maxCoeff()
                                                            : out.cwiseMax(0.0).norm();
                               },
                               product},
                    solid.shape);
}

double signed_distance(const Shape& shape, const Vec3& p) {
  return shape_parts::signed_distance({shape, nullptr}, p);
}

Vec3 nearest_surface_point(const Shape& shape, const Vec3& p) {
  return shape_parts::nearest_surface_point({shape, nullptr}, p);
}

Vec3 shape_parts::nearest_surface_point(const Indexed& solid, const Vec3& p) {
  return std::visit(
      Overloaded{[&](const Sphere& s) {
                   const Vec3 out = p - s.centre;
                   const double far = out.norm();
                   return Vec3(s.centre + (far > 0 ? Vec3(out / far) : Vec3(0, 0, 1)) * s.radius);
                 },
                 [&](const Cylinder& c) {
                   const double dx = p.x() - c.x;
                   const double dy = p.y() - c.y;
                   const double far = std::hypot(dx, dy);
                   const Point2 side{c.x + (far > 0 ? dx / far : 1) * c.radius,
                                     c.y + (far > 0 ? dy / far : 0) * c.radius};
                   return nearest_of_product(p, far - c.radius, side, c.floor, c.ceiling);
                 },
                 [&](const BoxShape& s) {
                   const Vec3 out = (s.box.min - p).cwiseMax(p - s.box.max);
                   int axis = 0;
                   if (out.maxCoeff(&axis) > 0) {
                     return clamped(s.box, p);
                   }
                   Vec3 q = p;
                   if (std::isfinite(out[axis])) {
                     q[axis] =
                         s.box.min[axis] - p[axis] == out[axis] ? s.box.min[axis] : s.box.max[axis];
                   }
                   return q;
                 },
                 [&](const Prism& prism) {
                   const Plan plan = plan_at(prism, solid.tree, p.x(), p.y());
                   return nearest_of_product(p, plane_distance(plan, p.x(), p.y()), plan.nearest,
                                             prism.floor, prism.ceiling);
                 }},
      solid.shape);
}
}  // namespace altiplan
