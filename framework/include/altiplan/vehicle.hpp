// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// Within `within_m` of an obstacle's edge the vehicle flies at `speed_mps`.
struct SpeedNear {
  double within_m = 0;
  double speed_mps = 0;
};

/// A sphere that flies at a speed given by its distance to the nearest obstacle.
struct ALTIPLAN_API Vehicle {
  double radius_m = 0;
  double speed_mps = 10;
  double sensing_m = kInfinity;
  std::vector<SpeedNear> speed_near;  ///< by ascending within_m
  bool turns_on_the_spot = false;     ///< to any heading, where it climbs or sinks on the spot

  /// Speed at a distance to the nearest obstacle (paper 002, eq. 6, is one such law).
  double speed_at(double distance_m) const;
};

/// Where the vehicle is. A velocity of zero means that no heading is given.
struct State {
  double time_s = 0;
  Vec3 position{0, 0, 0};
  Vec3 velocity{0, 0, 0};
};
}  // namespace altiplan
