// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "altiplan/kit/dubins/airplane.hpp"

/// \file The words of Dubins paths in a constant wind, whose turns are trochoids over the ground.
/// T. G. McGee, J. K. Hedrick: Optimal Path Planning with a Kinematic Airplane Model. Journal of
/// Guidance, Control, and Dynamics 30(2), 2007, doi:10.2514/1.25042; L. Techy, C. A. Woolsey:
/// Minimum-Time Path Planning for Unmanned Aerial Vehicles in Steady Uniform Winds. Journal of
/// Guidance, Control, and Dynamics 32(6), 2009, doi:10.2514/1.44580.
///
/// In the air mass the goal moves against the wind, so a path must have the length that is flown
/// until it meets the goal. Where a turn shrinks to nothing or grows to a circle, lengths change by
/// a circle and may pass the right one by; hence a first turn may have whole circles more, and
/// there is always a path. Of these, that with the least time is taken; its middle turn of three
/// may be less than a half circle.
namespace altiplan::kit {

struct Air {
  double speed = 0;          ///< airspeed, m/s, greater than that of the wind
  Vec3 wind = Vec3::Zero();  ///< horizontal, m/s
};

struct ALTIPLAN_API WindPath {
  AirplanePath through_air;
  Air air;

  double seconds() const { return through_air.length() / air.speed; }
  /// Turns with a drift and straight legs, whose heights change linearly in time.
  std::vector<Leg> legs(const Pose& from, const Vec3& to) const {
    return through_air.legs(from, to, air.wind / air.speed);
  }
};

/// Headings are through the air. No path if the wind is not slower than the airspeed.
ALTIPLAN_API std::optional<WindPath> wind_path(const Pose& from, const Pose& to, double radius,
                                               const Air& air);
/// Climbing and sinking within the limits, which are angles in the air mass; nor a path where there
/// is none without wind, nor if it is longer through the air than `at_most`, which takes less time.
ALTIPLAN_API std::optional<WindPath> wind_path(const Pose& from, const Pose& to,
                                               const AirplaneLimits& limits, const Air& air,
                                               double at_most = kInfinity);
}  // namespace altiplan::kit
