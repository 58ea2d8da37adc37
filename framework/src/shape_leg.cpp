// SPDX-License-Identifier: Apache-2.0
// How near a leg comes to a shape, and how deep it gets into it.
#include "altiplan/shape.hpp"
#include "shape_parts.hpp"

namespace altiplan {
namespace {

using namespace shape_parts;

// A look at the distance along the leg: at the share t of it, and its slope there.
struct Look {
  double t;
  double distance;
  double slope;
};

// What a search for the least distance is after: the distance itself, …
struct Exactly {
  static bool is_below(double) { return false; }
  static bool is_beyond(double) { return false; }
  static bool is_beyond(const Look&, const Look&, double) { return false; }
};

// … or whether it is below a limit. The answer is the one that the distance would give: below as
// soon as any look is, beyond only by more than rounding can be wrong.
struct Below {
  double limit;
  double rounding;  // of coordinates, metres

  bool is_below(double distance) const { return distance < limit; }
  bool is_beyond(double distance) const { return distance - rounding > limit; }
  // A convex function lies above its tangents, so nowhere below where these two cross.
  bool is_beyond(const Look& low, const Look& high, double length) const {
    const double width = high.t - low.t;
    const double share = (high.distance - high.slope * width - low.distance) /
                         (low.slope - high.slope);  // from low to the crossing
    // Rounding turns the direction away from the solid, the more the nearer it is.
    const double turned = rounding * length / std::min(low.distance, high.distance);
    return is_beyond(low.distance + low.slope * share - turned);
  }
};

// Least distance from the leg to a convex set, given the set's point nearest to a point: the
// distance is a convex function along the leg, so its slope is halved down to the minimum. What is
// left to gain is at most slope x interval.
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
  double least = std::min(low.distance, high.distance);
  while (least > 0 && high.t - low.t > 1e-16 && !goal.is_below(least) &&
         !goal.is_beyond(low, high, length)) {
    const double t = (low.t + high.t) / 2;
    const Look middle = look(t, a + t * along);
    least = std::min(least, middle.distance);
    if (std::abs(middle.slope) * (high.t - low.t) <= enough) {
      break;
    }
    (middle.slope > 0 ? high : low) = middle;
  }
  return least;
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
template <class Goal>
double prism_leg_distance(const Prism& prism, const Vec3& a, const Vec3& b, const Goal& goal) {
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
    const double gap = std::max(gap_x, gap_y);
    if (gap >= least || goal.is_below(least) || goal.is_beyond(gap)) {
      return;
    }
    const double t = crossing(a, b, e, f);
    const double z = a.z() + t * (b.z() - a.z());
    if (z >= prism.floor && z <= prism.ceiling) {
      least = 0;
      return;
    }
    least =
        std::min(least, convex_leg_distance(a, b, goal, [&](const Vec3& p) {
                   const Point2 q = nearest_on_edge(e, f, p.x(), p.y());
                   return Vec3(q[0], q[1], std::max(prism.floor, std::min(prism.ceiling, p.z())));
                 }));
  });
  return least;
}

template <class Goal>
double leg_distance(const Shape& shape, const Vec3& a, const Vec3& b, const Goal& goal) {
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
                 [&](const Prism& prism) { return prism_leg_distance(prism, a, b, goal); }},
      shape);
}

// Greatest of the coordinates that points of the surface are worked out from.
double extent(const Shape& shape) {
  double most = 0;
  if (const auto* c = std::get_if<Cylinder>(&shape)) {
    most = std::max(std::abs(c->x), std::abs(c->y)) + c->radius;
  } else if (const auto* prism = std::get_if<Prism>(&shape)) {
    for_each_edge(*prism, [&](const Point2& e, const Point2&) {
      most = std::max({most, std::abs(e[0]), std::abs(e[1])});
    });
  }
  return most;
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

}  // namespace

double leg_distance(const Shape& shape, const Vec3& a, const Vec3& b) {
  return leg_distance(shape, a, b, Exactly{});
}

bool comes_within(const Shape& shape, const Vec3& a, const Vec3& b, double limit) {
  constexpr double kRounding = 1e-14;  // of the greatest coordinate, with room to spare
  const double most = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff()) + extent(shape);
  return leg_distance(shape, a, b, Below{limit, kRounding * most}) < limit;
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
}  // namespace altiplan
