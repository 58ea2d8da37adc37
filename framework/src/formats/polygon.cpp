// SPDX-License-Identifier: Apache-2.0
#include "altiplan/formats/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "../shape/edge_tree.hpp"

namespace altiplan::formats {
namespace {

std::string place(const Point2& p) {
  char text[80];
  std::snprintf(text, sizeof text, "(%.9g, %.9g)", p[0], p[1]);
  return text;
}

bool within_box(const Point2& e, const Point2& f, const Point2& p) {
  return p[0] >= std::min(e[0], f[0]) && p[0] <= std::max(e[0], f[0]) &&
         p[1] >= std::min(e[1], f[1]) && p[1] <= std::max(e[1], f[1]);
}

// Intersection of two edges, if there is one; touching counts.
std::optional<Point2> meeting(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  if (std::max(a[0], b[0]) < std::min(c[0], d[0]) || std::max(c[0], d[0]) < std::min(a[0], b[0]) ||
      std::max(a[1], b[1]) < std::min(c[1], d[1]) || std::max(c[1], d[1]) < std::min(a[1], b[1])) {
    return std::nullopt;
  }
  const double c_side = cross(a, b, c);
  const double d_side = cross(a, b, d);
  const double a_side = cross(c, d, a);
  const double b_side = cross(c, d, b);
  if (((c_side > 0 && d_side < 0) || (c_side < 0 && d_side > 0)) &&
      ((a_side > 0 && b_side < 0) || (a_side < 0 && b_side > 0))) {
    const double share = c_side / (c_side - d_side);
    return Point2{c[0] + share * (d[0] - c[0]), c[1] + share * (d[1] - c[1])};
  }
  if (c_side == 0 && within_box(a, b, c)) {
    return c;
  }
  if (d_side == 0 && within_box(a, b, d)) {
    return d;
  }
  if (a_side == 0 && within_box(c, d, a)) {
    return a;
  }
  if (b_side == 0 && within_box(c, d, b)) {
    return b;
  }
  return std::nullopt;
}

// A ring, and the tree over its edges.
struct Edges {
  const Ring& ring;
  EdgeTree tree;
  Point2 min{kInfinity, kInfinity};
  Point2 max{-kInfinity, -kInfinity};

  explicit Edges(const Ring& of) : ring(of), tree({&of}) {
    for (const Point2& p : ring) {
      min = {std::min(min[0], p[0]), std::min(min[1], p[1])};
      max = {std::max(max[0], p[0]), std::max(max[1], p[1])};
    }
  }
  bool reaches(const Edges& other) const {
    return min[0] <= other.max[0] && other.min[0] <= max[0] && min[1] <= other.max[1] &&
           other.min[1] <= max[1];
  }
  bool covers(const Point2& p) const { return tree.covers(p[0], p[1]); }
};

// Intersection of edge n of a ring with its edge m > n.
std::optional<Point2> meeting_in_ring(const Ring& ring, std::size_t n, std::size_t m) {
  const std::size_t size = ring.size();
  const Point2& a = ring[n];
  const Point2& b = ring[(n + 1) % size];
  const Point2& c = ring[m];
  const Point2& d = ring[(m + 1) % size];
  if (m != n + 1 && (n != 0 || m + 1 != size)) {
    return meeting(a, b, c, d);
  }
  // Neighbours share a corner; they may not fold back onto each other.
  const Point2& corner = m == n + 1 ? b : a;
  const Point2& before = m == n + 1 ? a : c;
  const Point2& after = m == n + 1 ? d : b;
  const double along = (before[0] - corner[0]) * (after[0] - corner[0]) +
                       (before[1] - corner[1]) * (after[1] - corner[1]);
  if (cross(before, corner, after) == 0 && along > 0) {
    return corner;
  }
  return std::nullopt;
}

// The first intersection of two rings, in order along the one and then along the other.
std::optional<Point2> meeting(const Edges& one, const Edges& other) {
  if (!one.reaches(other)) {
    return std::nullopt;
  }
  const bool same = &one == &other;
  const std::size_t size = one.ring.size();
  for (std::size_t n = 0; n < size; ++n) {
    const Point2& a = one.ring[n];
    const Point2& b = one.ring[(n + 1) % size];
    const EdgeTree::Rectangle leg{{std::min(a[0], b[0]), std::min(a[1], b[1])},
                                  {std::max(a[0], b[0]), std::max(a[1], b[1])}};
    std::size_t first = other.ring.size();
    std::optional<Point2> found;
    other.tree.visit(
        [&](const EdgeTree::Rectangle& box) {
          return box.min[0] <= leg.max[0] && leg.min[0] <= box.max[0] && box.min[1] <= leg.max[1] &&
                         leg.min[1] <= box.max[1]
                     ? 0.0
                     : 1.0;
        },
        [] { return 0.0; },
        [&](std::size_t m, const EdgeTree::Edge& edge) {
          if (m >= first || (same && m <= n)) {
            return;
          }
          if (const auto at =
                  same ? meeting_in_ring(one.ring, n, m) : meeting(a, b, edge.from, edge.to)) {
            first = m;
            found = at;
          }
        });
    if (found) {
      return found;
    }
  }
  return std::nullopt;
}
bool has_area(const Ring& ring) {
  constexpr double kThin = 1e-9;
  const auto distance2 = [&](const Point2& p) {
    return (p[0] - ring[0][0]) * (p[0] - ring[0][0]) + (p[1] - ring[0][1]) * (p[1] - ring[0][1]);
  };
  // The line through the first corner and the corner farthest from it would contain all others.
  const auto far = std::max_element(
      ring.begin(), ring.end(),
      [&](const Point2& p, const Point2& q) { return distance2(p) < distance2(q); });
  return far != ring.end() && std::any_of(ring.begin(), ring.end(), [&](const Point2& p) {
           return std::abs(cross(ring[0], *far, p)) > kThin * std::sqrt(distance2(*far));
         });
}
}  // namespace

Ring without_repeats(const Ring& ring) {
  Ring result;
  for (const Point2& p : ring) {
    if (result.empty() || result.back() != p) {
      result.push_back(p);
    }
  }
  while (result.size() > 1 && result.back() == result.front()) {
    result.pop_back();
  }
  return result;
}

bool is_flat(const Polygon& polygon) {
  return !has_area(polygon.outline) &&
         std::none_of(polygon.holes.begin(), polygon.holes.end(), has_area);
}

std::string names_text(const std::vector<std::string>& names) {
  constexpr std::size_t kMax = 40;
  std::string text;
  for (std::size_t n = 0; n < std::min(names.size(), kMax); ++n) {
    text += (n == 0 ? "'" : ", '") + names[n] + "'";
  }
  return names.size() <= kMax ? text
                              : text + " and " + std::to_string(names.size() - kMax) + " more";
}

std::string polygon_problem(const Polygon& polygon) {
  std::vector<Edges> rings;
  rings.reserve(polygon.holes.size() + 1);
  rings.emplace_back(polygon.outline);
  for (const Ring& hole : polygon.holes) {
    rings.emplace_back(hole);
  }
  for (std::size_t n = 0; n < rings.size(); ++n) {
    const std::string name = n == 0 ? "the outline" : "hole " + std::to_string(n);
    const Ring& ring = rings[n].ring;
    if (ring.size() < 3) {
      return name + " needs at least three different points, found " + std::to_string(ring.size());
    }
    for (std::size_t m = 0; m <= n; ++m) {
      if (const auto at = meeting(rings[n], rings[m])) {
        return name +
               (m == n   ? " meets itself"
                : m == 0 ? " meets the outline"
                         : " meets hole " + std::to_string(m)) +
               " at " + place(*at);
      }
    }
    if (n > 0 && !rings[0].covers(ring.front())) {
      return name + " lies outside of the outline, at " + place(ring.front());
    }
    for (std::size_t m = 1; m < n; ++m) {
      if (rings[m].covers(ring.front()) || rings[n].covers(rings[m].ring.front())) {
        return name + " and hole " + std::to_string(m) + " lie one inside the other";
      }
    }
  }
  return "";
}
}  // namespace altiplan::formats
