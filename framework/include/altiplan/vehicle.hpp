// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "altiplan/leg.hpp"

namespace altiplan {

struct Body;
struct Energy;

/// Speed of the vehicle within `within_m` of an obstacle's surface.
struct SpeedNear {
  double within_m = 0;
  double speed_mps = 0;
};

/// An aeroplane: it flies at a constant airspeed and turns by banking.
struct ALTIPLAN_API Wing {
  double airspeed_mps = 15;        ///< horizontal component
  double bank = radians(30);       ///< maximum bank angle, radians, in (0, pi/2)
  double climb = radians(10);      ///< maximum climb angle through the air
  double sink = radians(10);       ///< maximum descent angle through the air
  double roll_rate = radians(60);  ///< maximum rate of the bank angle, radians/s; of flights alone

  /// Radius of a coordinated turn at the maximum bank angle: airspeed² / (g tan bank).
  double turn_radius() const;
};

/// How a vehicle that is no aeroplane speeds up and slows down along a route: from rest at its
/// start to rest at its end.
struct Acceleration {
  double mps2 = kInfinity;       ///< infinite: speeds change at once
  double jerk_mps3 = kInfinity;  ///< of each change of speed
  double jerk_time_s = 0;        ///< in which the jerk itself sets in and ends (ArduPilot's)
  /// How near it passes a waypoint at which it turns, without a stop; none: it stops at each.
  std::optional<double> corner_radius_m{};

  bool takes_time() const { return std::isfinite(mps2); }
};

/// A sphere, or a body that contains it, whose speed depends on its distance to the nearest
/// obstacle.
struct ALTIPLAN_API Vehicle {
  double radius_m = 0;  ///< of the sphere about the reference point: with a body, its inner_m()
  double speed_mps = 10;
  double sensing_m = kInfinity;
  std::vector<SpeedNear> speed_near;   ///< by ascending within_m
  bool turns_on_the_spot = false;      ///< to any heading, when climbing or descending vertically
  std::optional<Wing> wing{};          ///< of an aeroplane; speed_mps is then its airspeed
  std::shared_ptr<const Body> body{};  ///< null: the sphere is all
  double climb_mps = kInfinity;        ///< greatest rate of climb: steeper legs are flown slowly
  double sink_mps = kInfinity;
  Acceleration acceleration{};             ///< of other vehicles than aeroplanes
  std::shared_ptr<const Energy> energy{};  ///< null: not known

  /// No part of the vehicle is farther from its reference point, metres.
  double reach_m() const;
  /// Speed at a distance to the nearest obstacle (for example paper 002, eq. 6).
  double speed_at(double distance_m) const;
  /// The greatest speed at any distance to obstacles.
  double max_speed() const;
  /// True if both are limited: its speed is then that over the ground, as of autopilots that hover.
  bool has_rates() const { return std::isfinite(climb_mps) && std::isfinite(sink_mps); }
  /// Metres of a straight way that count at its speed.
  double counted_m(const Vec3& way) const {
    return has_rates() ? way.head<2>().norm() : way.norm();
  }
  /// Seconds that a change of height takes at least.
  double climb_time(double rise_m) const {
    return rise_m >= 0 ? rise_m / climb_mps : -rise_m / sink_mps;
  }
};

/// Position and velocity of the vehicle; a velocity of zero means that no heading is given. A route
/// from a vehicle that loiters around the position leaves the circle anywhere, tangentially.
struct State {
  double time_s = 0;
  Vec3 position{0, 0, 0};
  Vec3 velocity{0, 0, 0};
  std::optional<Loiter> loiter{};

  /// True if a route may begin at p.
  bool starts_at(const Vec3& p) const {
    return loiter ? loiter->passes(position, p) : p == position;
  }
};
}  // namespace altiplan
