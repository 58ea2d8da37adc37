// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

#include "altiplan/world.hpp"

/// \file What a world answers to numbers of Python, which need not be finite.
namespace altiplan::host {

/// Signed distance (m); -infinity of a point that is not finite.
inline double asked_clearance(const World& world, const Vec3& point) {
  return is_finite(point) ? world.clearance(point) : -kInfinity;
}

/// Height of the ground (m); nan where there is none.
inline double asked_ground(const World& world, double x, double y) {
  const bool finite = std::isfinite(x) && std::isfinite(y);
  return (finite ? world.ground(x, y) : std::nullopt)
      .value_or(std::numeric_limits<double>::quiet_NaN());
}

/// Whether a sphere meets an obstacle on the leg; true of points that are not finite.
inline bool asked_blocked(const World& world, const Vec3& a, const Vec3& b, double radius_m) {
  return !is_finite(a) || !is_finite(b) || world.blocked(a, b, radius_m);
}
}  // namespace altiplan::host
