// SPDX-License-Identifier: Apache-2.0
// Random maps of discs in 2-D, for tests of the robust variant.
#pragma once

#include <vector>

#include "reference/circle_visibility.hpp"
#include "reference/velocity_flights.hpp"
#include "threats.hpp"

namespace velocity_field {

inline std::vector<Disc> discs_of(const std::vector<Cylinder>& threats) {
  std::vector<Disc> discs;
  for (const Cylinder& threat : threats) {
    discs.push_back({{threat.x, threat.y}, threat.radius});
  }
  return discs;
}

inline reference::CircleVisibility reference_of(const std::vector<Disc>& discs) {
  std::vector<reference::Circle> circles;
  for (const Disc& disc : discs) {
    circles.push_back({{disc.centre.x(), disc.centre.y()}, disc.radius});
  }
  return reference::CircleVisibility(circles);
}

inline bool enters_one(const std::vector<Disc>& discs, const Vec2& a, const Vec2& b) {
  return std::any_of(discs.begin(), discs.end(), [&](const Disc& disc) {
    // An independent formulation: by the nearest of both ends and the foot between them.
    const Vec2 ab = b - a;
    const Vec2 ac = disc.centre - a;
    double minimum = std::min(ac.norm(), (disc.centre - b).norm());
    if (ac.dot(ab) > 0 && ac.dot(ab) < ab.squaredNorm()) {
      minimum = std::min(minimum, std::abs(cross(ab, ac)) / ab.norm());
    }
    return minimum < disc.radius;
  });
}

inline bool is_inside_one(const std::vector<Disc>& discs, const Vec2& p) {
  return enters_one(discs, p, p);
}
}  // namespace velocity_field
