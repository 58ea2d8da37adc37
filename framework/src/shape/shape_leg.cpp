// SPDX-License-Identifier: Apache-2.0
// Distance between a leg and a shape, and penetration depth of the leg.
#include "altiplan/shape.hpp"
#include "shape_parts.hpp"

namespace altiplan {
namespace {

using namespace shape_parts;

// Sample of the distance along the leg: at parameter t, with its slope there.
struct Look {
  double t;
  double distance;
  double slope;
};

// Target of a minimum-distance search: the distance itself, …
struct Exactly {
  static double max_distance() { return kInfinity; }
  static bool is_below(double) { return false; }
  static bool is_beyond(double) { return false; }
  static bool is_beyond(const Look&, const Look&, double) { return false; }
};

// … or whether it is below a limit. The answer agrees with the distance: below as soon as any
// sample is, beyond only by more than the possible rounding error.
struct Below {
  double limit;
  double rounding;  // of coordinates, metres

  double max_distance() const { return limit + rounding; }  // largest distance that is not beyond
  bool is_below(double distance) const { return distance < limit; }
  bool is_beyond(double distance) const { return distance - rounding > limit; }
  // A convex function lies above its tangents, so nowhere below the crossing of these two.
  bool is_beyond(const Look& low, const Look& high, double length) const {
    const double width = high.t - low.t;
    const double share = (high.distance - high.slope * width - low.distance) /
                         (low.slope - high.slope);  // from low to the crossing
    // Rounding turns the direction away from the solid, the more the nearer it is.
    const double turned = rounding * length / std::min(low.distance, high.distance);
    return is_beyond(low.distance + low.slope * share - turned);
  }
};

// Minimum distance from the leg to a convex set, given the set's point nearest to a point: the
// distance is a convex function along the leg, so its slope is bisected down to the minimum. The
// remaining error is at most slope x interval.
template <class Goal, class Nearest>
double convex_leg_distance(const Vec3& a, const Vec3& b, const Goal& goal, const Nearest& nearest) {
  const Vec3 along = b - a;
  const double length = along.norm();
  const double enough = 1e-13 * (1 + length);
  const auto look = [&](double t, const Vec3& p) {
    const Vec3 away = p - nearest(p);
    const double distance = away.norm();
    return Look{t, distance, distance > 0 ? away.dot(along) / distance : 0};
  };
  Look low = look(0, a);
  if (low.slope >= 0 || goal.is_below(low.distance)) {
    return low.distance;
  }
  Look high = look(1, b);
  if (high.slope <= 0) {
    return high.distance;
  }
  double min_distance = std::min(low.distance, high.distance);
  while (min_distance > 0 && high.t - low.t > 1e-16 && !goal.is_below(min_distance) &&
         !goal.is_beyond(low, high, length)) {
    const double t = (low.t + high.t) / 2;
    const Look middle = look(t, a + t * along);
    min_distance = std::min(min_distance, middle.distance);
    if (std::abs(middle.slope) * (high.t - low.t) <= enough) {
      break;
    }
    (middle.slope > 0 ? high : low) = middle;
  }
  return min_distance;
}

// Parameter of the leg a–b at which its plan crosses the edge, or NaN; parallel lines do not cross.
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

// Lower bound of the distance between the leg a–b and the content of a rectangle, between two
// heights.
class LegGap {
 public:
  LegGap(const Vec3& a, const Vec3& b, double floor, double ceiling, double extent)
      : leg_(leg_box(a, b)), start_{a.x(), a.y()} {
    constexpr double kRounding = 1e-13;  // of the largest coordinate, with a margin
    const double length = std::hypot(b.x() - a.x(), b.y() - a.y());
    if (length > 0) {
      across_ = {(a.y() - b.y()) / length, (b.x() - a.x()) / length};
    }
    rounding_ = kRounding * (leg_.min.cwiseAbs().cwiseMax(leg_.max.cwiseAbs()).maxCoeff() + extent);
    vertical_ = interval_gap(floor, ceiling, leg_.min.z(), leg_.max.z());
  }

  double operator()(const EdgeTree::Rectangle& box) const {
    const double gap_x = interval_gap(box.min[0], box.max[0], leg_.min.x(), leg_.max.x());
    const double gap_y = interval_gap(box.min[1], box.max[1], leg_.min.y(), leg_.max.y());
    // From the line through the leg: tighter for diagonal legs, most of whose bounding box is
    // empty.
    const double middle = across_[0] * ((box.min[0] + box.max[0]) / 2 - start_[0]) +
                          across_[1] * ((box.min[1] + box.max[1]) / 2 - start_[1]);
    const double reach = std::abs(across_[0]) * (box.max[0] - box.min[0]) / 2 +
                         std::abs(across_[1]) * (box.max[1] - box.min[1]) / 2;
    const double gap = std::max({gap_x, gap_y, std::abs(middle) - reach});
    return std::max(0.0, std::sqrt(gap * gap + vertical_ * vertical_) - rounding_);
  }

 private:
  Box leg_;
  Point2 start_;
  Point2 across_{0, 0};
  double rounding_;
  double vertical_;
};

// The nearest point of a prism lies inside it, on a side (a vertical rectangle over an edge), or on
// its floor or ceiling away from the edges; then it is below an end of the leg, or the leg passes
// through.
template <class Edges, class Goal>
double prism_leg_distance(const Prism& prism, const Edges& edges, const Vec3& a, const Vec3& b,
                          const Goal& goal) {
  double min_distance = kInfinity;
  for (const Vec3* p : {&a, &b}) {
    if (edges.covers(p->x(), p->y())) {
      min_distance = std::min(min_distance,
                              std::max(0.0, interval_distance(prism.floor, prism.ceiling, p->z())));
    }
  }
  for (const double level : {prism.floor, prism.ceiling}) {
    if ((a.z() < level) != (b.z() < level) && std::isfinite(level)) {
      const Vec3 p = a + (level - a.z()) / (b.z() - a.z()) * (b - a);
      if (edges.covers(p.x(), p.y())) {
        return 0;
      }
    }
  }
  const Box leg = leg_box(a, b);
  const auto look = [&](const Point2& e, const Point2& f) {
    const double gap_x =
        interval_gap(std::min(e[0], f[0]), std::max(e[0], f[0]), leg.min.x(), leg.max.x());
    const double gap_y =
        interval_gap(std::min(e[1], f[1]), std::max(e[1], f[1]), leg.min.y(), leg.max.y());
    const double gap = std::max(gap_x, gap_y);
    if (gap >= min_distance || goal.is_below(min_distance) || goal.is_beyond(gap)) {
      return;
    }
    const double t = crossing(a, b, e, f);
    const double z = a.z() + t * (b.z() - a.z());
    if (z >= prism.floor && z <= prism.ceiling) {
      min_distance = 0;
      return;
    }
    min_distance =
        std::min(min_distance, convex_leg_distance(a, b, goal, [&](const Vec3& p) {
                   const Point2 q = nearest_on_edge(e, f, p.x(), p.y());
                   return Vec3(q[0], q[1], std::max(prism.floor, std::min(prism.ceiling, p.z())));
                 }));
  };
  const auto limit = [&] {
    return min_distance == 0 || goal.is_below(min_distance)
               ? -1.0
               : std::min(min_distance, goal.max_distance());
  };
  edges.visit(LegGap(a, b, prism.floor, prism.ceiling, edges.extent()), limit, look);
  return min_distance;
}

template <class Goal>
double distance_of(const Indexed& solid, const Vec3& a, const Vec3& b, const Goal& goal) {
  return std::visit(
      Overloaded{[&](const Sphere& s) {
                   return std::max(0.0, point_leg_distance(s.centre, a, b) - s.radius);
                 },
                 [&](const Cylinder& c) {
                   return convex_leg_distance(a, b, goal, [&](const Vec3& p) {
                     const double dx = p.x() - c.x;
                     const double dy = p.y() - c.y;
                     const double far = std::sqrt(dx * dx + dy * dy);
                     const double z = std::max(c.floor, std::min(c.ceiling, p.z()));
                     return far <= c.radius
                                ? Vec3(p.x(), p.y(), z)
                                : Vec3(c.x + dx / far * c.radius, c.y + dy / far * c.radius, z);
                   });
                 },
                 [&](const BoxShape& s) {
                   return convex_leg_distance(a, b, goal,
                                              [&](const Vec3& p) { return clamped(s.box, p); });
                 },
                 [&](const Prism& prism) {
                   return with_edges(prism, solid.tree, [&](const auto& edges) {
                     return prism_leg_distance(prism, edges, a, b, goal);
                   });
                 }},
      solid.shape);
}

// Largest of the coordinates from which points of the surface are computed.
double extent(const Indexed& solid) {
  if (const auto* c = std::get_if<Cylinder>(&solid.shape)) {
    return std::max(std::abs(c->x), std::abs(c->y)) + c->radius;
  }
  if (const auto* prism = std::get_if<Prism>(&solid.shape)) {
    return with_edges(*prism, solid.tree, [](const auto& edges) { return edges.extent(); });
  }
  return 0;
}

// Parameters of the leg where it meets a circle or sphere: |from + t along| = radius.
void add_roots(const Vec3& from, const Vec3& along, double radius, std::vector<double>& shares) {
  const double length2 = along.squaredNorm();
  const double middle = length2 > 0 ? -from.dot(along) / length2 : 0;
  const double half2 = radius * radius - (from + middle * along).squaredNorm();
  if (length2 > 0 && half2 > 0) {
    const double half = std::sqrt(half2 / length2);
    shares.insert(shares.end(), {middle - half, middle + half});
  }
}

// Parameters of the leg between which it stays on one side of the shape's surface.
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
  }
  // Where the leg crosses the edge, and where it passes its ends: crossings there may be missed.
  void add_edge(const Point2& e, const Point2& f) {
    const double t = crossing(a, b, e, f);
    if (!std::isnan(t)) {
      shares.push_back(t);
    }
    for (const Point2& corner : {e, f}) {
      shares.push_back(share_beside(corner));
    }
  }
  // Parameter of the leg at which it passes the point.
  double share_beside(const Point2& p) const {
    const double dx = b.x() - a.x();
    const double dy = b.y() - a.y();
    const double length2 = dx * dx + dy * dy;
    return length2 > 0 ? ((p[0] - a.x()) * dx + (p[1] - a.y()) * dy) / length2 : 0;
  }
  // In ascending order, within the leg.
  std::vector<double> sorted() {
    for (double& share : shares) {
      share = std::clamp(share, 0.0, 1.0);
    }
    std::sort(shares.begin(), shares.end());
    shares.erase(std::unique(shares.begin(), shares.end()), shares.end());
    return std::move(shares);
  }
};

// Between two breaks the leg is entirely inside or outside. Distance to an edge is a convex
// function, so the depth between two breaks is at most the larger of their distances to the edge
// nearest to their midpoint. Where that exceeds twice the depth at the midpoint, the leg passes an
// end of the edge, and the part is split there.
template <class Edges>
double prism_leg_depth(const Prism& prism, const Edges& edges, const Vec3& a, const Vec3& b) {
  constexpr double kBeside = 1e-9;  // of the largest coordinate: margin within which an edge may
                                    // touch the leg
  const double extent = edges.extent() + std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  Breaks breaks{a, b};
  breaks(prism);
  const LegGap beside(a, b, -kInfinity, kInfinity, edges.extent());
  edges.visit(
      beside, [&] { return kBeside * extent; },
      [&](const Point2& e, const Point2& f) { breaks.add_edge(e, f); });
  const std::vector<double> shares = breaks.sorted();
  double deepest = 0;
  std::vector<std::array<double, 2>> parts;
  for (std::size_t n = 0; n + 1 < shares.size(); ++n) {
    parts.push_back({shares[n], shares[n + 1]});
  }
  while (!parts.empty()) {
    const auto [from, to] = parts.back();
    parts.pop_back();
    const Vec3 p = a + (from + to) / 2 * (b - a);
    const double vertical = -interval_distance(prism.floor, prism.ceiling, p.z());
    if (vertical <= deepest || !edges.covers(p.x(), p.y())) {
      continue;
    }
    const auto [e, f] = edges.nearest(p.x(), p.y());
    const double side = distance_to_edge(e, f, p.x(), p.y());
    deepest = std::max(deepest, std::min(side, vertical));
    const auto side_at = [&, &e = e, &f = f](double share) {
      const Vec3 q = a + share * (b - a);
      return distance_to_edge(e, f, q.x(), q.y());
    };
    if (vertical <= side || std::max(side_at(from), side_at(to)) <= 2 * deepest) {
      continue;
    }
    std::array<double, 4> cuts{from, breaks.share_beside(e), breaks.share_beside(f), to};
    for (double& cut : cuts) {
      cut = std::clamp(cut, from, to);
    }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t n = 0; n < 3; ++n) {
      if (cuts[n] < cuts[n + 1] && cuts[n + 1] - cuts[n] < to - from) {
        parts.push_back({cuts[n], cuts[n + 1]});
      }
    }
  }
  return deepest;
}

}  // namespace

double shape_parts::leg_distance(const Indexed& solid, const Vec3& a, const Vec3& b) {
  return distance_of(solid, a, b, Exactly{});
}

bool shape_parts::comes_within(const Indexed& solid, const Vec3& a, const Vec3& b, double limit) {
  constexpr double kRounding = 1e-14;  // of the largest coordinate, with a margin
  const double max_coordinate =
      std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff()) + extent(solid);
  return distance_of(solid, a, b, Below{limit, kRounding * max_coordinate}) < limit;
}

double shape_parts::leg_depth(const Indexed& solid, const Vec3& a, const Vec3& b) {
  if (const auto* prism = std::get_if<Prism>(&solid.shape)) {
    return with_edges(*prism, solid.tree,
                      [&](const auto& edges) { return prism_leg_depth(*prism, edges, a, b); });
  }
  Breaks breaks{a, b};
  std::visit(breaks, solid.shape);
  const std::vector<double> shares = breaks.sorted();
  double min_distance = 0;
  for (std::size_t n = 0; n + 1 < shares.size(); ++n) {
    const double middle = (shares[n] + shares[n + 1]) / 2;
    min_distance = std::min(min_distance, signed_distance(solid, a + middle * (b - a)));
  }
  return -min_distance;
}

double leg_distance(const Shape& shape, const Vec3& a, const Vec3& b) {
  return shape_parts::leg_distance({shape, nullptr}, a, b);
}

bool comes_within(const Shape& shape, const Vec3& a, const Vec3& b, double limit) {
  return shape_parts::comes_within({shape, nullptr}, a, b, limit);
}

double leg_depth(const Shape& shape, const Vec3& a, const Vec3& b) {
  return shape_parts::leg_depth({shape, nullptr}, a, b);
}
}  // namespace altiplan
