// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "altiplan/shape.hpp"

/// What the files on shapes share: visiting, intervals of heights, and the plan of a prism.
namespace altiplan::shape_parts {

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

using Point2 = std::array<double, 2>;

inline double interval_distance(double floor, double ceiling, double z) {
  return std::max(floor - z, z - ceiling);
}

inline double interval_gap(double low, double high, double other_low, double other_high) {
  return std::max({0.0, low - other_high, other_low - high});
}

inline Vec3 clamped(const Box& box, const Vec3& p) { return p.cwiseMax(box.min).cwiseMin(box.max); }

template <class Visit>
void for_each_edge(const Prism& prism, const Visit& visit) {
  const auto ring = [&](const std::vector<Point2>& points) {
    for (std::size_t n = 1; n < points.size(); ++n) {
      visit(points[n - 1], points[n]);
    }
    if (!points.empty()) {
      visit(points.back(), points.front());
    }
  };
  ring(prism.outline);
  for (const std::vector<Point2>& hole : prism.holes) {
    ring(hole);
  }
}

// Whether a ray from (x, y) to the east crosses the edge; without branches, as nothing foretells
// it.
inline bool crosses(const Point2& e, const Point2& f, double x, double y) {
  const double side = (f[0] - e[0]) * (y - e[1]) - (x - e[0]) * (f[1] - e[1]);
  const bool spans = (e[1] > y) != (f[1] > y);
  const bool is_east = (side > 0) == (f[1] > e[1]);
  return spans & is_east;
}

// Whether (x, y) lies in the polygon: the ray crosses its edges an odd number of times.
inline bool covers(const Prism& prism, double x, double y) {
  bool inside = false;
  for_each_edge(prism, [&](const Point2& e, const Point2& f) { inside ^= crosses(e, f, x, y); });
  return inside;
}

inline Point2 nearest_on_edge(const Point2& e, const Point2& f, double x, double y) {
  const double dx = f[0] - e[0];
  const double dy = f[1] - e[1];
  const double length2 = dx * dx + dy * dy;
  const double share =
      length2 > 0 ? std::clamp(((x - e[0]) * dx + (y - e[1]) * dy) / length2, 0.0, 1.0) : 0.0;
  return share < 1 ? Point2{e[0] + share * dx, e[1] + share * dy} : f;
}
}  // namespace altiplan::shape_parts
