// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "host/flight/flight.hpp"

namespace altiplan::host {

/// Seconds and places, as in FlightResult.
using Track = std::vector<std::pair<double, Vec3>>;

struct TrackVerdict {
  CheckResult check;
  int collisions = 0;  ///< times that the vehicle came to touch something
  bool reached = false;
  Measures measures;                       ///< as of FlightResult
  std::optional<double> min_separation_m;  ///< as of FlightResult
};

/// Judges a track against the true world in time, without flying it: every leg against the layers
/// and rules, as exactly as the flight was, moving obstacles by their times, and the vehicle's
/// greatest speed. Of `setup` only the request, the truth and the events count. An event happens at
/// the first point of the track at or after its time, or within its distance.
TrackVerdict judge_track(const Track& track, const FlightSetup& setup);

/// The tightest turn of a track; none where it goes straight on.
struct TrackRadius {
  std::optional<double> radius_m;
  std::size_t at = 0;  ///< index of the track's point
};
/// At each point the larger of what two readings of the samples say: that they lie on the curve
/// that was flown (the circle through a sample and its neighbours), or that the vehicle flew
/// straight stretches with fillets between them (fillet_radius). One sampling cannot tell the two
/// apart.
TrackRadius track_radius(const Route& track, const Vehicle& vehicle);

/// What is asked of a track as a whole, beyond its legs: its least turn radius, its length, and the
/// constraints that look at all of it.
std::vector<Violation> whole_track_violations(const Route& track, const Request& request,
                                              double min_turn_radius);

/// The fastest that the vehicle's speed law allows anywhere.
double top_speed(const Vehicle& vehicle);
}  // namespace altiplan::host
