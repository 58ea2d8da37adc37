// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "altiplan/api.hpp"

namespace altiplan::formats {

using Point2 = std::array<double, 2>;
using Ring = std::vector<Point2>;

/// Twice the signed area of the triangle; positive if its corners run counter-clockwise.
inline double cross(const Point2& o, const Point2& p, const Point2& q) {
  return (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
}

/// An outline and its holes; rings are not closed by a repeated point.
struct Polygon {
  Ring outline;
  std::vector<Ring> holes;
};

/// Drops points that repeat the preceding one (and the last, where it repeats the first).
ALTIPLAN_API Ring without_repeats(const Ring& ring);

/// True if a polygon in longitude and latitude is degenerate (a point or a line), to 1e-9 degrees
/// (0.1 mm).
ALTIPLAN_API bool is_flat(const Polygon& polygon);

/// "'park', 'pier' and 3 more": a short list of names for a note.
ALTIPLAN_API std::string names_text(const std::vector<std::string>& names);

/// The defect of a polygon (a ring that intersects itself or another one, a hole outside, no area),
/// with its position in the ring's units; "" where there is none.
ALTIPLAN_API std::string polygon_problem(const Polygon& polygon);
}  // namespace altiplan::formats
