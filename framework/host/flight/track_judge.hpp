// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "host/flight/flight.hpp"

namespace altiplan::host {

/// Times (s) and positions, as in FlightResult.
using Track = std::vector<std::pair<double, Vec3>>;

struct TrackVerdict {
  CheckResult check;
  int collisions = 0;  ///< number of contacts
  bool reached = false;
  Measures measures;                       ///< as of FlightResult
  std::optional<double> min_separation_m;  ///< as of FlightResult
};

/// Judges a track against the true world over time, without flying it: every leg against layers and
/// constraints, as exactly as in fly(), moving obstacles by their times, and the vehicle's maximum
/// speed. Uses only the request, the true world and the events of `setup`. An event happens at the
/// first point of the track at or after its time, or within its distance.
TrackVerdict judge_track(const Track& track, const FlightSetup& setup);

/// The tightest turn of a track; none if it is straight.
struct TrackRadius {
  std::optional<double> radius_m;
  std::size_t at = 0;  ///< index of the track's point
};
/// At each point the larger radius of two interpretations of the samples: they lie on the curve
/// flown (the circle through a sample and its neighbours), or the vehicle flew straight legs with
/// fillets between them (fillet_radius). One sampling cannot distinguish the two.
TrackRadius track_radius(const Polyline& track, const Vehicle& vehicle);

/// Violations of a whole track, beyond its legs: its minimum turn radius, its length, and the
/// constraints on whole tracks.
std::vector<Violation> whole_track_violations(const Polyline& track, const Request& request,
                                              double min_turn_radius);

/// The maximum of the vehicle's speed profile.
double top_speed(const Vehicle& vehicle);
}  // namespace altiplan::host
