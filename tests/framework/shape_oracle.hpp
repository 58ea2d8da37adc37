// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "altiplan/shape.hpp"

// Distances by another road than the library's: a prism is a union of triangular prisms, known from
// how it was made, and the least distance of a leg to a convex piece is found by golden-section
// search on a convex function.
namespace altiplan::oracle {

struct Draw {
  std::mt19937_64 engine;
  explicit Draw(std::uint64_t seed) : engine(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * double(engine() >> 11) * 0x1p-53;
  }
  int below(int count) { return int(engine() % std::uint64_t(count)); }
  /// In a box; one coordinate a statement, since compilers order arguments as they like.
  Vec3 within(const Vec3& low, const Vec3& high) {
    const double z = (*this)(low.z(), high.z());
    const double y = (*this)(low.y(), high.y());
    const double x = (*this)(low.x(), high.x());
    return {x, y, z};
  }
  Vec3 point(double half) {
    return {(*this)(-half, half), (*this)(-half, half), (*this)(-half, half)};
  }
};

using Point2 = std::array<double, 2>;
using Triangle = std::array<Point2, 3>;

/// A shape and, for a prism, triangles whose union is its plan.
struct Solid {
  Shape shape;
  std::vector<Triangle> triangles;
};

inline double cross(const Point2& o, const Point2& p, const Point2& q) {
  return (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
}

inline double to_edge(const Point2& e, const Point2& f, double x, double y) {
  const double length = std::hypot(f[0] - e[0], f[1] - e[1]);
  if (length == 0) {
    return std::hypot(x - e[0], y - e[1]);
  }
  const double ux = (f[0] - e[0]) / length;
  const double uy = (f[1] - e[1]) / length;
  const double along = ux * (x - e[0]) + uy * (y - e[1]);
  if (along < 0) {
    return std::hypot(x - e[0], y - e[1]);
  }
  return along > length ? std::hypot(x - f[0], y - f[1])
                        : std::abs(ux * (y - e[1]) - uy * (x - e[0]));
}

inline double outside_triangle(const Triangle& t, double x, double y) {
  const Point2 p{x, y};
  const double s0 = cross(t[0], t[1], p);
  const double s1 = cross(t[1], t[2], p);
  const double s2 = cross(t[2], t[0], p);
  if ((s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0)) {
    return 0;
  }
  return std::min(
      {to_edge(t[0], t[1], x, y), to_edge(t[1], t[2], x, y), to_edge(t[2], t[0], x, y)});
}

inline double beyond(double low, double high, double value) {
  return value < low ? low - value : value > high ? value - high : 0;
}

/// Distance outside of one convex piece (piece n of a prism).
inline double outside(const Solid& solid, std::size_t piece, const Vec3& p) {
  if (const auto* s = std::get_if<Sphere>(&solid.shape)) {
    return std::max(0.0, std::sqrt((p - s->centre).squaredNorm()) - s->radius);
  }
  if (const auto* c = std::get_if<Cylinder>(&solid.shape)) {
    const double h =
        std::max(0.0, std::sqrt((p.x() - c->x) * (p.x() - c->x) + (p.y() - c->y) * (p.y() - c->y)) -
                          c->radius);
    const double v = beyond(c->floor, c->ceiling, p.z());
    return std::sqrt(h * h + v * v);
  }
  if (const auto* b = std::get_if<BoxShape>(&solid.shape)) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = beyond(b->box.min[axis], b->box.max[axis], p[axis]);
      sum += d * d;
    }
    return std::sqrt(sum);
  }
  const Prism& prism = std::get<Prism>(solid.shape);
  const double h = outside_triangle(solid.triangles[piece], p.x(), p.y());
  const double v = beyond(prism.floor, prism.ceiling, p.z());
  return std::sqrt(h * h + v * v);
}

inline std::size_t pieces(const Solid& solid) {
  return std::max<std::size_t>(1, solid.triangles.size());
}

/// Least distance of the leg to the solid, by golden-section search.
inline double leg_distance(const Solid& solid, const Vec3& a, const Vec3& b) {
  constexpr double kGolden = 0.6180339887498949;
  double least = kInfinity;
  for (std::size_t piece = 0; piece < pieces(solid) && least > 0; ++piece) {
    const auto at = [&](double t) { return outside(solid, piece, a + t * (b - a)); };
    double low = 0;
    double high = 1;
    double t0 = 1 - kGolden;
    double t1 = kGolden;
    double f0 = at(t0);
    double f1 = at(t1);
    least = std::min({least, at(0), at(1)});
    const double length = (b - a).norm();
    while (high - low > 1e-17 && std::min(f0, f1) > 0) {
      // A distance changes by at most the way gone: no better than `least` here.
      if (std::min(f0, f1) - (high - low) * length > least) {
        break;
      }
      if (f0 < f1) {
        high = t1;
        t1 = t0;
        f1 = f0;
        t0 = high - kGolden * (high - low);
        f0 = at(t0);
      } else {
        low = t0;
        t0 = t1;
        f0 = f1;
        t1 = low + kGolden * (high - low);
        f1 = at(t1);
      }
      if (t0 >= t1) {
        break;
      }
    }
    least = std::min({least, f0, f1});
  }
  return least;
}

/// Signed distance of a point: pieces outside, the surface's parts one by one inside.
inline double signed_distance(const Solid& solid, const Vec3& p) {
  double out = kInfinity;
  for (std::size_t piece = 0; piece < pieces(solid); ++piece) {
    out = std::min(out, outside(solid, piece, p));
  }
  if (out > 0) {
    return out;
  }
  if (const auto* s = std::get_if<Sphere>(&solid.shape)) {
    return std::sqrt((p - s->centre).squaredNorm()) - s->radius;
  }
  if (const auto* c = std::get_if<Cylinder>(&solid.shape)) {
    const double side =
        c->radius - std::sqrt((p.x() - c->x) * (p.x() - c->x) + (p.y() - c->y) * (p.y() - c->y));
    return -std::min({side, p.z() - c->floor, c->ceiling - p.z()});
  }
  if (const auto* b = std::get_if<BoxShape>(&solid.shape)) {
    double depth = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
      depth = std::min({depth, p[axis] - b->box.min[axis], b->box.max[axis] - p[axis]});
    }
    return -depth;
  }
  const Prism& prism = std::get<Prism>(solid.shape);
  double depth = std::min(p.z() - prism.floor, prism.ceiling - p.z());
  std::vector<std::vector<Point2>> rings = prism.holes;
  rings.push_back(prism.outline);
  for (const std::vector<Point2>& ring : rings) {
    for (std::size_t n = 0; n < ring.size(); ++n) {
      depth = std::min(depth, to_edge(ring[n], ring[(n + 1) % ring.size()], p.x(), p.y()));
    }
  }
  return -depth;
}

/// A star-shaped polygon around (x, y), concave at most of its corners, perhaps with a hole of the
/// same kind around its middle; the triangles follow from how it is made.
inline Solid star(Draw& draw, double x, double y, double size, int corners, bool hole, double floor,
                  double ceiling) {
  Solid solid;
  Prism prism;
  prism.floor = floor;
  prism.ceiling = ceiling;
  std::vector<Point2> inner;
  const double turn = draw(0, 2 * kPi);
  for (int n = 0; n < corners; ++n) {
    const double angle = turn + 2 * kPi * (n + draw(-0.2, 0.2)) / corners;
    const double far = size * draw(0.4, 1);
    const double near = hole ? size * draw(0.05, 0.35) : 0;
    prism.outline.push_back({x + far * std::cos(angle), y + far * std::sin(angle)});
    inner.push_back({x + near * std::cos(angle), y + near * std::sin(angle)});
  }
  for (int n = 0; n < corners; ++n) {
    const int next = (n + 1) % corners;
    solid.triangles.push_back({prism.outline[n], prism.outline[next], inner[n]});
    if (hole) {
      // The inner edge's quadrilateral, split so that both halves keep inside it.
      const bool outward = cross(inner[n], prism.outline[next], inner[next]) *
                               cross(inner[n], prism.outline[next], prism.outline[n]) <
                           0;
      if (outward) {
        solid.triangles.push_back({inner[n], prism.outline[next], inner[next]});
      } else {
        solid.triangles.back() = {prism.outline[n], prism.outline[next], inner[next]};
        solid.triangles.push_back({inner[n], prism.outline[n], inner[next]});
      }
    }
  }
  if (draw.below(2) == 0) {
    std::reverse(prism.outline.begin(), prism.outline.end());
  }
  if (hole) {
    prism.holes.push_back(inner);
  }
  solid.shape = prism;
  return solid;
}

/// A solid of any kind about `at`, of at most `size`; a third have infinite extents.
inline Solid random_solid(Draw& draw, const Vec3& at, double size) {
  const double tall = size * draw(0.05, 1);
  const int endless = draw.below(6);
  const double floor = endless == 0 ? -kInfinity : at.z() - tall;
  const double ceiling = endless <= 1 ? kInfinity : at.z() + tall;
  switch (draw.below(5)) {
    case 0:
      return {Sphere{at, size * draw(0.1, 1)}, {}};
    case 1:
      return {Cylinder{at.x(), at.y(), size * draw(0.05, 1), floor, ceiling}, {}};
    case 2: {
      const Vec3 half(size * draw(0.05, 1), size * draw(0.05, 1), 0);
      Box box{at - half, at + half};
      box.min.z() = floor;
      box.max.z() = ceiling;
      return {BoxShape{box}, {}};
    }
    case 3:
      return star(draw, at.x(), at.y(), size, 3 + draw.below(6), false, floor, ceiling);
    default:
      return star(draw, at.x(), at.y(), size, 5 + draw.below(6), true, floor, ceiling);
  }
}
}  // namespace altiplan::oracle
