// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "altiplan/request.hpp"

namespace altiplan {

/// Metrics of a route; those that do not apply are empty (a radius without a bend, clearance in an
/// empty world). Metres, seconds; angles in degrees, smoothness in radians.
struct Measures {
  double length_m = 0;
  std::size_t waypoints = 0;
  std::optional<double> max_turn_deg;  ///< horizontal
  std::optional<double> max_climb_deg;
  std::optional<double> min_radius_m;
  std::optional<double> min_clearance_m;         ///< route to the nearest obstacle, signed
  std::optional<double> min_ground_clearance_m;  ///< vertical
  std::optional<double> smoothness_rad;  ///< sum of turn and climb changes (paper 003, eq. 9)
  std::optional<double> duration_s;      ///< at the vehicle's speed profile
  std::optional<double> time_s;          ///< as flown: with acceleration (flown_route.hpp)
  std::optional<double> energy_wh;       ///< as flown; empty where it is not known
};

/// Of turns, clearances are those of chords within 1e-4 m.
ALTIPLAN_API Measures measure(const Route& route, const Request& request);

/// Minimum clearance of the leg a–b, by bisection on `blocked` so that it agrees with the judge
/// (within 1e-6 m and the layer's over-approximation); signed where the leg enters an obstacle;
/// infinite in an empty layer; any value of at least `enough` once it is known to be that.
ALTIPLAN_API double leg_clearance(const Environment& environment, const Vec3& a, const Vec3& b,
                                  double enough = kInfinity);

/// Seconds from a to b at the vehicle's speed profile.
ALTIPLAN_API double leg_duration(const World& world, const Vehicle& vehicle, const Vec3& a,
                                 const Vec3& b);
/// Seconds of a leg of any kind: of an aeroplane, or in wind, at its airspeed. It begins at
/// `time_s`, in the time of request.start, or at the start.
ALTIPLAN_API double leg_duration(const Leg& leg, double time_s, const Request& request);
ALTIPLAN_API double leg_duration(const Leg& leg, const Request& request);
}  // namespace altiplan
