// SPDX-License-Identifier: Apache-2.0
#pragma once

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
};

/// Judges a track against the true world in time, without flying it: every leg against the layers
/// and rules, as exactly as the flight was, moving obstacles by their times, and the vehicle's
/// greatest speed. Of `setup` only the request, the truth and the events count. An event happens at
/// the first point of the track at or after its time, or within its distance.
TrackVerdict judge_track(const Track& track, const FlightSetup& setup);

/// What is asked of a track as a whole, beyond its legs: the length, and the constraints that look
/// at all of it.
std::vector<Violation> whole_track_violations(const Route& track, const Request& request);

/// The fastest that the vehicle's speed law allows anywhere.
double top_speed(const Vehicle& vehicle);
}  // namespace altiplan::host
