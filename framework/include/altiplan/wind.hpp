// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "altiplan/leg.hpp"

namespace altiplan {

/// Horizontal wind, constant within layers of height.
struct ALTIPLAN_API Wind {
  struct Layer {
    double above_m = -kInfinity;  ///< lower border, metres above sea level
    Vec3 velocity{0, 0, 0};       ///< of the air, m/s, horizontal
  };
  std::vector<Layer> layers;  ///< by ascending border; below the first border there is no wind

  bool is_calm() const { return layers.empty(); }
  /// Velocity of the air at a height.
  Vec3 at(double z) const;
  /// Fractions of a leg's climb at which it crosses a border, ascending, without 0 and 1.
  std::vector<double> crossings(double from_z, double to_z) const;
};

/// Ground speed, m/s, of a vehicle that holds a horizontal course (any length) by crabbing into the
/// wind; none if it cannot make good that course.
ALTIPLAN_API std::optional<double> ground_speed(const Vec3& course, double airspeed,
                                                const Vec3& wind);

/// Heading through the air, radians, that holds that course; none if it cannot.
ALTIPLAN_API std::optional<double> heading_on(const Vec3& course, double airspeed,
                                              const Vec3& wind);

/// Seconds of a straight leg at an airspeed, which is horizontal; infinite if the wind does not let
/// the vehicle hold the course. A leg without a heading takes the time of its length.
ALTIPLAN_API double flight_time(const Vec3& from, const Vec3& to, double airspeed,
                                const Wind& wind);
}  // namespace altiplan
