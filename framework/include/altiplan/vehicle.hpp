// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// Speed of the vehicle within `within_m` of an obstacle's surface.
struct SpeedNear {
  double within_m = 0;
  double speed_mps = 0;
};

/// A sphere whose speed depends on its distance to the nearest obstacle.
struct ALTIPLAN_API Vehicle {
  double radius_m = 0;
  double speed_mps = 10;
  double sensing_m = kInfinity;
  std::vector<SpeedNear> speed_near;  ///< by ascending within_m
  bool turns_on_the_spot = false;     ///< to any heading, when climbing or descending vertically

  /// Speed at a distance to the nearest obstacle (for example paper 002, eq. 6).
  double speed_at(double distance_m) const;
};

/// Position and velocity of the vehicle; a velocity of zero means that no heading is given.
struct State {
  double time_s = 0;
  Vec3 position{0, 0, 0};
  Vec3 velocity{0, 0, 0};
};
}  // namespace altiplan
