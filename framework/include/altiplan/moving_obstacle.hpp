// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/shape.hpp"

namespace altiplan {

/// A solid in uniform straight motion: `shape` at `since_s`, moving with `velocity`.
struct MovingObstacle {
  std::string id;
  Shape shape;
  Vec3 velocity{0, 0, 0};
  double since_s = 0;
  bool known = true;
  bool planned = false;  ///< known beforehand: routes keep off it, in time

  Shape at(double time_s) const { return moved(shape, velocity * (time_s - since_s)); }
};

/// True if a sphere of radius r that flies a–b between the times t0 and t1 comes nearer than r to
/// the moving obstacle: exact, by relative motion.
ALTIPLAN_API bool hits(const MovingObstacle& obstacle, const Vec3& a, double t0, const Vec3& b,
                       double t1, double r);
/// Minimum distance between that flight and the obstacle's surface; 0 where they meet.
ALTIPLAN_API double separation(const MovingObstacle& obstacle, const Vec3& a, double t0,
                               const Vec3& b, double t1);
}  // namespace altiplan
