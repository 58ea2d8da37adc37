// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "altiplan/request.hpp"

/// \file How a route is flown: the one rule by which its time and its energy are counted. A vehicle
/// flies each leg at its speed (leg_duration), or as fast as its rates of climb and sink allow.
/// With an acceleration it flies from rest to rest: through a waypoint as fast as an arc within
/// `corner_radius_m` before and after it, at most to the middle of a leg, takes no more than that
/// acceleration, or it stops there. An aeroplane keeps its airspeed.
namespace altiplan {

class Power;

/// A change of speed on a straight line, or its flight at one speed.
struct Ramp {
  double seconds = 0;
  double metres = 0;
};
/// Between two speeds (m/s), in the shortest time.
ALTIPLAN_API Ramp ramp(double from_mps, double to_mps, const Acceleration& acceleration);

/// A straight line that is begun and ended at given speeds.
struct Sprint {
  Ramp up;
  double top_mps = 0;
  Ramp level;
  Ramp down;
  double seconds() const { return up.seconds + level.seconds + down.seconds; }
};
/// In the shortest time, at most at `max_mps`; none where the line is too short for the speeds.
/// All speeds within the maximum.
ALTIPLAN_API std::optional<Sprint> sprint(double metres, double from_mps, double to_mps,
                                          double max_mps, const Acceleration& acceleration);

/// The greatest speed (m/s) through a corner that turns by so much (radians).
ALTIPLAN_API double corner_speed(double turn, double radius_m, double mps2);

/// A part of a flight: a straight line at a speed that changes evenly, a turn or a wait.
struct FlownPhase {
  Vec3 from{0, 0, 0};
  Vec3 to{0, 0, 0};
  double from_mps = 0;  ///< along the track over the ground; of a turn through the air, horizontal
  double to_mps = 0;
  double seconds = 0;        ///< infinite: the wind does not let it be flown
  double turn_radius_m = 0;  ///< 0: straight
};

/// Calls for each part of a route from the start, in order.
ALTIPLAN_API void fly(const Route& route, const Request& request,
                      const std::function<void(const FlownPhase&)>& use);

/// Seconds.
ALTIPLAN_API double flown_time(const Route& route, const Request& request);
/// Wh by a model of power; infinite where it knows none.
ALTIPLAN_API double flown_energy(const Route& route, const Request& request, const Power& power);
/// Of one leg at its steady speed, without stops, from a time, that of request.start.
ALTIPLAN_API double leg_energy(const Leg& leg, double time_s, const Request& request,
                               const Power& power);
/// Of a track of times (s) and places.
ALTIPLAN_API double track_energy(const std::vector<std::pair<double, Vec3>>& track,
                                 const Request& request, const Power& power);

/// What takes more energy than the vehicle's battery may give; none where that is not known, or
/// enough.
ALTIPLAN_API std::optional<Violation> energy_violation(double needed_wh, const Vehicle& vehicle);
}  // namespace altiplan
