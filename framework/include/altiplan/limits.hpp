// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// Altitude limits of a route.
struct AltitudeBand {
  enum class Datum { sea, ground };
  Datum datum = Datum::sea;
  double min = -kInfinity;  ///< metres above the datum
  double max = kInfinity;
};

/// The standard limits, tightened by constraints; planners check them inline. Metres, radians.
struct Limits {
  double min_clearance = 0;  ///< route to obstacles; at least the vehicle's radius
  std::optional<double> min_ground_clearance;  ///< vertical, above ground
  std::vector<AltitudeBand> altitude;
  double min_leg = 0;
  double max_leg = kInfinity;
  double max_turn_horizontal = kPi;
  double max_turn_space = kPi;
  double min_turn_radius = 0;  ///< for the corners of a route (fillet_radius) and the curvature of
                               ///< a track
  double max_climb = kPi / 2;
  std::optional<double> max_sink{};  ///< of descents; none: max_climb
  double max_route_length = kInfinity;

  /// The steepest leg that may be flown both ways.
  double max_slope() const { return std::min(max_climb, max_descent()); }
  double max_descent() const { return max_sink.value_or(max_climb); }
  /// True if two legs that each satisfy the limits may violate one together.
  bool turns() const {
    return max_turn_horizontal < kPi || max_turn_space < kPi || min_turn_radius > 0;
  }
};
}  // namespace altiplan
