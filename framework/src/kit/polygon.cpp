// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace altiplan::kit {
namespace {

std::string place(const Point2& p) {
  char text[80];
  std::snprintf(text, sizeof text, "(%.9g, %.9g)", p[0], p[1]);
  return text;
}

double cross(const Point2& o, const Point2& p, const Point2& q) {
  return (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
}

bool within_box(const Point2& e, const Point2& f, const Point2& p) {
  return p[0] >= std::min(e[0], f[0]) && p[0] <= std::max(e[0], f[0]) &&
         p[1] >= std::min(e[1], f[1]) && p[1] <= std::max(e[1], f[1]);
}

// Where two edges meet, if they do; touching counts.
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

std::optional<Point2> meeting(const Ring& one, const Ring& other) {
  const bool same = &one == &other;
  const std::size_t size = one.size();
  for (std::size_t n = 0; n < size; ++n) {
    const Point2& a = one[n];
    const Point2& b = one[(n + 1) % size];
    for (std::size_t m = same ? n + 1 : 0; m < other.size(); ++m) {
      const Point2& c = other[m];
      const Point2& d = other[(m + 1) % other.size()];
      if (same && (m == n + 1 || (n == 0 && m + 1 == size))) {
        // Neighbours share a corner; they may not fold back onto each other.
        const Point2& corner = m == n + 1 ? b : a;
        const Point2& before = m == n + 1 ? a : c;
        const Point2& after = m == n + 1 ? d : b;
        const double along = (before[0] - corner[0]) * (after[0] - corner[0]) +
                             (before[1] - corner[1]) * (after[1] - corner[1]);
        if (cross(before, corner, after) == 0 && along > 0) {
          return corner;
        }
        continue;
      }
      if (const auto at = meeting(a, b, c, d)) {
        return at;
      }
    }
  }
  return std::nullopt;
}

bool covers(const Ring& ring, const Point2& p) {
  bool inside = false;
  for (std::size_t n = 0; n < ring.size(); ++n) {
    const Point2& e = ring[n];
    const Point2& f = ring[(n + 1) % ring.size()];
    if ((e[1] > p[1]) != (f[1] > p[1])) {
      inside ^= (cross(e, f, p) > 0) == (f[1] > e[1]);
    }
  }
  return inside;
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

std::string polygon_problem(const Polygon& polygon) {
  std::vector<const Ring*> rings{&polygon.outline};
  for (const Ring& hole : polygon.holes) {
    rings.push_back(&hole);
  }
  for (std::size_t n = 0; n < rings.size(); ++n) {
    const std::string name = n == 0 ? "the outline" : "hole " + std::to_string(n);
    if (rings[n]->size() < 3) {
      return name + " needs at least three different points, found " +
             std::to_string(rings[n]->size());
    }
    for (std::size_t m = 0; m <= n; ++m) {
      if (const auto at = meeting(*rings[n], *rings[m])) {
        return name +
               (m == n   ? " meets itself"
                : m == 0 ? " meets the outline"
                         : " meets hole " + std::to_string(m)) +
               " at " + place(*at);
      }
    }
    if (n > 0 && !covers(polygon.outline, rings[n]->front())) {
      return name + " lies outside of the outline, at " + place(rings[n]->front());
    }
    for (std::size_t m = 1; m < n; ++m) {
      if (covers(*rings[m], rings[n]->front()) || covers(*rings[n], rings[m]->front())) {
        return name + " and hole " + std::to_string(m) + " lie one in the other";
      }
    }
  }
  return "";
}
}  // namespace altiplan::kit
