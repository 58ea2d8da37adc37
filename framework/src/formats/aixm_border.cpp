// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "aixm_surface.hpp"
#include "altiplan/earth.hpp"
#include "altiplan/geometry.hpp"

namespace altiplan::formats {
namespace {

// The ends of the curves beside a piece of a border lie within this of it, metres.
constexpr double kNearBorder = 2000;

/// Index of the vertex before the position nearest to p, with the fraction to the next one.
double along(const std::vector<Point2>& border, const Point2& p) {
  const double east = std::cos(radians(p[1]));
  double best = kInfinity;
  double result = 0;
  Point2 nearest = p;
  for (std::size_t n = 0; n + 1 < border.size(); ++n) {
    const double first = longitude_near(border[n][0], p[0]);
    const double dx = longitude_near(border[n + 1][0], first) - first;
    const double dy = border[n + 1][1] - border[n][1];
    const double ox = p[0] - first;
    const double oy = p[1] - border[n][1];
    const double length2 = dx * dx * east * east + dy * dy;
    const double along = ox * dx * east * east + oy * dy;
    const double share = length2 > 0 ? std::clamp(along / length2, 0.0, 1.0) : 0;
    const double off = std::hypot((ox - share * dx) * east, oy - share * dy);
    if (off < best) {
      best = off;
      result = double(n) + share;
      nearest = {first + share * dx, border[n][1] + share * dy};
    }
  }
  if (!(geodesic_course(p, nearest).metres <= kNearBorder)) {
    throw Error("expected curves that begin and end within 2 km of the border beside them");
  }
  return result;
}
}  // namespace

Outline along_border(const std::vector<Point2>& border, const Point2& from, const Point2& to) {
  if (border.size() < 2 || border.front() == border.back()) {
    throw Error("expected a border that is open, found a closed one");
  }
  const double first = along(border, from);
  const double last = along(border, to);
  const double low = std::min(first, last);
  const double high = std::max(first, last);
  Outline between;
  for (auto n = std::size_t(std::floor(low)) + 1; double(n) < high; ++n) {
    between.emplace_back(border[n]);
  }
  if (first > last) {
    std::reverse(between.begin(), between.end());
  }
  return between;
}
}  // namespace altiplan::formats
