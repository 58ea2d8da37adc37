// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/world.hpp"

namespace altiplan {

/// Start of the first part of a leg that has no ground below it.
inline Vec3 ground_ends(const World& world, const Vec3& a, const Vec3& b) {
  if (!world.ground_below(a, a)) {
    return a;
  }
  double known = 0;
  double unknown = 1;
  for (int i = 0; i < 50; ++i) {
    const double t = (known + unknown) / 2;
    (world.ground_below(a, a + t * (b - a)) ? known : unknown) = t;
  }
  return a + unknown * (b - a);
}
}  // namespace altiplan
