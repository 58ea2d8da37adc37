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
/// speed; an aeroplane's airspeed, climb and turns by wing_violations(). Uses only the request, the
/// true world and the events of `setup`. An event happens at the first point of the track at or
/// after its time, or within its distance.
TrackVerdict judge_track(const Track& track, const FlightSetup& setup);

/// The positions of a track.
Polyline places_of(const Track& track);

/// Measures that follow from the times of a track, not from its line.
void take_times(Measures& measures, const Track& track, const Request& request);

/// The tightest turn of a track; none if it is straight.
struct TrackRadius {
  std::optional<double> radius_m;
  std::size_t at = 0;  ///< index of the track's point
};
/// At each point the larger radius of two interpretations of the samples: they lie on the curve
/// flown (the circle through a sample and its neighbours), or the vehicle flew straight legs with
/// fillets between them (fillet_radius). One sampling cannot distinguish the two.
TrackRadius track_radius(const Polyline& track, const Vehicle& vehicle);

/// The limits that straight legs between the points of a track are judged by: without those on the
/// turn radius, and on an aeroplane's climb, which are judged for the whole track.
Limits limits_of_legs(const Request& request);

/// The request by which positions are judged that a vehicle reports, rounded and at times of its
/// own: without what depends on differences between neighbouring ones (turns, climb, speed, level
/// flight), which the vehicle's autopilot limits, and with a tolerance at the goal within which
/// autopilots end a mission.
Request as_telemetry(Request request);

/// Violations of a whole track, beyond its legs: its turns (minimum turn radius in `limits`), an
/// aeroplane's motion (neither of telemetry), its length, and the constraints on whole tracks.
std::vector<Violation> whole_track_violations(const Track& track, const Request& request,
                                              const Limits& limits, bool telemetry = false);

/// The first violation of each of an aeroplane's limits, judged by the times of the track in the
/// air mass, which moves with the wind at the beginning of each step: airspeed; climb and sink; and
/// turn rate: two successive steps may differ in heading by what a turn of the minimum radius
/// allows in the time from the middle of one to the middle of the other. No flight within the
/// limits violates them, however it is sampled.
std::vector<Violation> wing_violations(const Track& track, const Request& request,
                                       const Limits& limits);

/// The violation of a vehicle that touches the layer or moving obstacle of that id.
Violation collision(std::size_t at, const std::string& met, const World& truth);
/// The violation of a track that does not come near a target.
Violation not_visited(const FlightEvent::Near& target, const Track& track);

/// Distance of a position from the goal, or from its loiter circle.
double distance_from(const Goal& goal, const Vec3& p);
/// True if the position is at the goal: within its tolerance, of an aeroplane also within a tenth
/// of its turn radius, since it passes abeam of a point that it cannot stop at.
bool at_goal(const Vec3& p, const Request& request);
/// That distance, metres.
double arrival_distance(const Request& request);
}  // namespace altiplan::host
