// SPDX-License-Identifier: Apache-2.0
#include "altiplan/shape.hpp"

#include <algorithm>

namespace altiplan {
namespace {

using Point2 = std::array<double, 2>;

// Overlaps of a box by less than this are touches, metres: well above the rounding of coordinates
// of 100 km, well below anything that flies.
constexpr double kTouch = 1e-9;

// All shapes but the sphere are products of a plane region and an interval of heights: distances
// combine by Pythagoras outside, depths by their minimum inside.
double product_distance(double horizontal, double vertical) {
  if (horizontal <= 0 && vertical <= 0) {
    return std::max(horizontal, vertical);
  }
  return std::hypot(std::max(horizontal, 0.0), std::max(vertical, 0.0));
}

double interval_distance(double floor, double ceiling, double z) {
  return std::max(floor - z, z - ceiling);
}

double interval_gap(double low, double high, double other_low, double other_high) {
  return std::max({0.0, low - other_high, other_low - high});
}

template <class Visit>
void for_each_edge(const Prism& prism, const Visit& visit) {
  const auto ring = [&](const std::vector<Point2>& points) {
    for (std::size_t n = 0; n < points.size(); ++n) {
      visit(points[n], points[n + 1 < points.size() ? n + 1 : 0]);
    }
  };
  ring(prism.outline);
  for (const std::vector<Point2>& hole : prism.holes) {
    ring(hole);
  }
}

// Whether (x, y) lies in the polygon: a ray to the east crosses its edges an odd number of times.
bool covers(const Prism& prism, double x, double y) {
  bool inside = false;
  for_each_edge(prism, [&](const Point2& e, const Point2& f) {
    if ((e[1] > y) != (f[1] > y)) {
      const double side = (f[0] - e[0]) * (y - e[1]) - (x - e[0]) * (f[1] - e[1]);
      inside ^= (side > 0) == (f[1] > e[1]);
    }
  });
  return inside;
}

Point2 nearest_on_edge(const Point2& e, const Point2& f, double x, double y) {
  const double dx = f[0] - e[0];
  const double dy = f[1] - e[1];
  const double length2 = dx * dx + dy * dy;
  const double share =
      length2 > 0 ? std::clamp(((x - e[0]) * dx + (y - e[1]) * dy) / length2, 0.0, 1.0) : 0.0;
  return share < 1 ? Point2{e[0] + share * dx, e[1] + share * dy} : f;
}

Point2 nearest_on_outline(const Prism& prism, double x, double y) {
  Point2 nearest{kInfinity, kInfinity};
  double least2 = kInfinity;
  for_each_edge(prism, [&](const Point2& e, const Point2& f) {
    const Point2 q = nearest_on_edge(e, f, x, y);
    const double distance2 = (x - q[0]) * (x - q[0]) + (y - q[1]) * (y - q[1]);
    if (distance2 < least2) {
      least2 = distance2;
      nearest = q;
    }
  });
  return nearest;
}

double plane_distance(const Prism& prism, double x, double y) {
  const Point2 q = nearest_on_outline(prism, x, y);
  const double distance = std::hypot(x - q[0], y - q[1]);
  return covers(prism, x, y) ? -distance : distance;
}

double plane_distance(const Cylinder& c, double x, double y) {
  return std::hypot(x - c.x, y - c.y) - c.radius;
}

Vec3 clamped(const Box& box, const Vec3& p) { return p.cwiseMax(box.min).cwiseMin(box.max); }

// Least distance from the leg to a convex set, given the set's point nearest to a point: the
// distance is a convex function along the leg, so its slope is halved down to the minimum. What is
// left to gain is at most slope x interval.
template <class Nearest>
double convex_leg_distance(const Vec3& a, const Vec3& b, const Nearest& nearest) {
  const Vec3 along = b - a;
  const double enough = 1e-13 * (1 + along.norm());
  double slope = 0;
  const auto distance_at = [&](const Vec3& p) {
    const Vec3 away = p - nearest(p);
    const double distance = away.norm();
    slope = distance > 0 ? away.dot(along) / distance : 0;
    return distance;
  };
  const double at_a = distance_at(a);
  if (slope >= 0) {
    return at_a;
  }
  const double at_b = distance_at(b);
  if (slope <= 0) {
    return at_b;
  }
  double least = std::min(at_a, at_b);
  double low = 0;
  double high = 1;
  while (least > 0 && high - low > 1e-16) {
    const double t = (low + high) / 2;
    least = std::min(least, distance_at(a + t * along));
    if (std::abs(slope) * (high - low) <= enough) {
      break;
    }
    (slope > 0 ? high : low) = t;
  }
  return least;
}

double box_leg_distance(const Box& box, const Vec3& a, const Vec3& b) {
  return convex_leg_distance(a, b, [&](const Vec3& p) { return clamped(box, p); });
}

// Share of the leg a–b at which its plan crosses the edge, or NaN; parallel lines do not cross.
double crossing(const Vec3& a, const Vec3& b, const Point2& e, const Point2& f) {
  const double dx = b.x() - a.x();
  const double dy = b.y() - a.y();
  const double ex = f[0] - e[0];
  const double ey = f[1] - e[1];
  const double cross = dx * ey - dy * ex;
  const double t = ((e[0] - a.x()) * ey - (e[1] - a.y()) * ex) / cross;
  const double s = ((e[0] - a.x()) * dy - (e[1] - a.y()) * dx) / cross;
  const bool meets = cross != 0 && t >= 0 && t <= 1 && s >= 0 && s <= 1;
  return meets ? t : std::numeric_limits<double>::quiet_NaN();
}

// The nearest point of a prism lies inside it, on a side (a vertical rectangle over an edge), or on
// its floor or ceiling away from the edges; there it is below an end of the leg, or the leg goes
// through.
double prism_leg_distance(const Prism& prism, const Vec3& a, const Vec3& b) {
  double least = kInfinity;
  for (const Vec3* p : {&a, &b}) {
    if (covers(prism, p->x(), p->y())) {
      least = std::min(least, std::max(0.0, interval_distance(prism.floor, prism.ceiling, p->z())));
    }
  }
  for (const double level : {prism.floor, prism.ceiling}) {
    if ((a.z() < level) != (b.z() < level) && std::isfinite(level)) {
      const Vec3 p = a + (level - a.z()) / (b.z() - a.z()) * (b - a);
      if (covers(prism, p.x(), p.y())) {
        return 0;
      }
    }
  }
  const Box leg = leg_box(a, b);
  for_each_edge(prism, [&](const Point2& e, const Point2& f) {
    const double gap_x =
        interval_gap(std::min(e[0], f[0]), std::max(e[0], f[0]), leg.min.x(), leg.max.x());
    const double gap_y =
        interval_gap(std::min(e[1], f[1]), std::max(e[1], f[1]), leg.min.y(), leg.max.y());
    if (std::max(gap_x, gap_y) >= least) {
      return;
    }
    const double t = crossing(a, b, e, f);
    const double z = a.z() + t * (b.z() - a.z());
    if (z >= prism.floor && z <= prism.ceiling) {
      least = 0;
      return;
    }
    least =
        std::min(least, convex_leg_distance(a, b, [&](const Vec3& p) {
                   const Point2 q = nearest_on_edge(e, f, p.x(), p.y());
                   return Vec3(q[0], q[1], std::max(prism.floor, std::min(prism.ceiling, p.z())));
                 }));
  });
  return least;
}

// Shares of the leg where it meets a circle or sphere: |from + t along| = radius.
void add_roots(const Vec3& from, const Vec3& along, double radius, std::vector<double>& shares) {
  const double length2 = along.squaredNorm();
  const double middle = length2 > 0 ? -from.dot(along) / length2 : 0;
  const double half2 = radius * radius - (from + middle * along).squaredNorm();
  if (length2 > 0 && half2 > 0) {
    const double half = std::sqrt(half2 / length2);
    shares.insert(shares.end(), {middle - half, middle + half});
  }
}

// Shares of the leg between which it stays on one side of the shape's surface.
struct Breaks {
  const Vec3& a;
  const Vec3& b;
  std::vector<double> shares{0, 1};

  void add_level(int axis, double level) {
    if (std::isfinite(level) && b[axis] != a[axis]) {
      shares.push_back((level - a[axis]) / (b[axis] - a[axis]));
    }
  }
  void operator()(const Sphere& s) { add_roots(a - s.centre, b - a, s.radius, shares); }
  void operator()(const Cylinder& c) {
    const Vec3 from(a.x() - c.x, a.y() - c.y, 0);
    add_roots(from, Vec3(b.x() - a.x(), b.y() - a.y(), 0), c.radius, shares);
    add_level(2, c.floor);
    add_level(2, c.ceiling);
  }
  void operator()(const BoxShape& s) {
    for (int axis = 0; axis < 3; ++axis) {
      add_level(axis, s.box.min[axis]);
      add_level(axis, s.box.max[axis]);
    }
  }
  void operator()(const Prism& prism) {
    add_level(2, prism.floor);
    add_level(2, prism.ceiling);
    const double dx = b.x() - a.x();
    const double dy = b.y() - a.y();
    const double length2 = dx * dx + dy * dy;
    for_each_edge(prism, [&](const Point2& e, const Point2& f) {
      const double t = crossing(a, b, e, f);
      if (!std::isnan(t)) {
        shares.push_back(t);
      }
      if (length2 > 0) {
        shares.push_back(((e[0] - a.x()) * dx + (e[1] - a.y()) * dy) / length2);
      }
    });
  }
};

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

// Least distance between the plan of a prism and a rectangle.
double plan_gap(const Prism& prism, const Box& box) {
  const Vec3 centre = (box.min + box.max) / 2;
  if (covers(prism, centre.x(), centre.y())) {
    return 0;
  }
  const Box column{{box.min.x(), box.min.y(), -kInfinity}, {box.max.x(), box.max.y(), kInfinity}};
  double least = kInfinity;
  for_each_edge(prism, [&](const Point2& e, const Point2& f) {
    const Vec3 from(e[0], e[1], 0);
    const Vec3 to(f[0], f[1], 0);
    const Box edge = leg_box(from, to);
    if (std::max(interval_gap(edge.min.x(), edge.max.x(), box.min.x(), box.max.x()),
                 interval_gap(edge.min.y(), edge.max.y(), box.min.y(), box.max.y())) < least) {
      least = std::min(least, box_leg_distance(column, from, to));
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

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;
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

double signed_distance(const Shape& shape, const Vec3& p) {
  const auto product = [&](const auto& s) {
    return product_distance(plane_distance(s, p.x(), p.y()),
                            interval_distance(s.floor, s.ceiling, p.z()));
  };
  return std::visit(Overloaded{[&](const Sphere& s) { return (p - s.centre).norm() - s.radius; },
                               [&](const BoxShape& s) {
                                 const Vec3 out = (s.box.min - p).cwiseMax(p - s.box.max);
                                 return out.maxCoeff() <= 0 ? out.maxCoeff()
                                                            : out.cwiseMax(0.0).norm();
                               },
                               product},
                    shape);
}

double leg_distance(const Shape& shape, const Vec3& a, const Vec3& b) {
  return std::visit(
      Overloaded{[&](const Sphere& s) {
                   return std::max(0.0, point_leg_distance(s.centre, a, b) - s.radius);
                 },
                 [&](const Cylinder& c) {
                   return convex_leg_distance(a, b, [&](const Vec3& p) {
                     const double dx = p.x() - c.x;
                     const double dy = p.y() - c.y;
                     const double far = std::sqrt(dx * dx + dy * dy);
                     const double z = std::max(c.floor, std::min(c.ceiling, p.z()));
                     return far <= c.radius
                                ? Vec3(p.x(), p.y(), z)
                                : Vec3(c.x + dx / far * c.radius, c.y + dy / far * c.radius, z);
                   });
                 },
                 [&](const BoxShape& s) { return box_leg_distance(s.box, a, b); },
                 [&](const Prism& prism) { return prism_leg_distance(prism, a, b); }},
      shape);
}

double leg_depth(const Shape& shape, const Vec3& a, const Vec3& b) {
  Breaks breaks{a, b};
  std::visit(breaks, shape);
  std::vector<double>& shares = breaks.shares;
  for (double& share : shares) {
    share = std::clamp(share, 0.0, 1.0);
  }
  std::sort(shares.begin(), shares.end());
  double least = 0;
  for (std::size_t n = 0; n + 1 < shares.size(); ++n) {
    if (shares[n] < shares[n + 1]) {
      const double middle = (shares[n] + shares[n + 1]) / 2;
      least = std::min(least, signed_distance(shape, a + middle * (b - a)));
    }
  }
  return -least;
}

Vec3 nearest_surface_point(const Shape& shape, const Vec3& p) {
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
                   const Point2 side = nearest_on_outline(prism, p.x(), p.y());
                   return nearest_of_product(p, plane_distance(prism, p.x(), p.y()), side,
                                             prism.floor, prism.ceiling);
                 }},
      shape);
}

bool overlaps(const Shape& shape, const Box& box, double by) {
  // The open box is taken as the closed one, smaller by what still counts as touching.
  const Vec3 shrink = Vec3::Constant(kTouch).cwiseMin((box.max - box.min) / 4);
  const Box inner{box.min + shrink, box.max - shrink};
  return std::visit(BoxGap{inner}, shape) <= by;
}
}  // namespace altiplan
