// SPDX-License-Identifier: Apache-2.0
#include "host/flight/track_judge.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "altiplan/energy.hpp"
#include "altiplan/error.hpp"
#include "altiplan/flown_route.hpp"
#include "host/base/words.hpp"
#include "host/flight/flight_world.hpp"

namespace altiplan::host {
namespace {

class Replay {
 public:
  explicit Replay(const FlightSetup& setup)
      : world_(setup),
        events_(setup.events),
        telemetry_(setup.telemetry),
        request_(telemetry_ ? as_telemetry(setup.request) : setup.request),
        limits_(request_.limits) {
    request_.limits = limits_of_legs(request_);
  }

  TrackVerdict operator()(const Track& track) {
    if (track.empty() || (!telemetry_ && !request_.start.starts_at(track.front().second))) {
      found().push_back({"start", 0, 0, 0, "the track does not begin at the start"});
      return std::move(verdict_);
    }
    std::optional<Approach> before = request_.before_start(track.front().second);
    bool touching = false;
    note_contact(before, track.front(), track.front(), 0, touching);
    for (std::size_t i = 0; i + 1 < track.size(); ++i) {
      meet_events(track[i], i, touching);
      judge_leg(before, track[i], track[i + 1], i, touching);
      if (track[i].second != track[i + 1].second) {
        before = onward(before, track[i].second);
      }
    }
    meet_events(track.back(), track.size() - 1, touching);
    finish(track);
    take_measures(track, places_of(track));
    return std::move(verdict_);
  }

 private:
  std::vector<Violation>& found() { return verdict_.check.violations; }

  /// Applies due events; anything that then covers the vehicle is a contact.
  void meet_events(const std::pair<double, Vec3>& here, std::size_t at, bool& touching) {
    bool world_differs = false;
    if (!targets_.empty() && targets_.front().is_near(here.second)) {
      targets_.erase(targets_.begin());
    }
    for (auto event = events_.begin(); event != events_.end();) {
      if (!event->is_due(here.first, here.second)) {
        ++event;
        continue;
      }
      if (event->kind == FlightEvent::Kind::visit) {
        targets_.push_back(event->target);
      } else if (event->kind == FlightEvent::Kind::move_goal) {
        request_.goal.position = event->vector;
      } else {
        world_.apply(*event);
        world_differs = true;
      }
      event = events_.erase(event);
    }
    if (world_differs) {
      note_contact(std::nullopt, here, here, at, touching);
    }
  }

  void judge_leg(const std::optional<Approach>& before, const std::pair<double, Vec3>& from,
                 const std::pair<double, Vec3>& to, std::size_t at, bool& touching) {
    const auto& [t0, a] = from;
    const auto& [t1, b] = to;
    const double run = (b - a).norm();
    const bool has_own_limit = telemetry_ || request_.vehicle.wing;
    const double fastest = has_own_limit ? kInfinity : request_.vehicle.max_speed();
    if (!(t1 > t0) || run > fastest * (t1 - t0) * (1 + 1e-6) + kLengthTolerance) {
      found().push_back({"speed", at, t1 > t0 ? run / (t1 - t0) : kInfinity, fastest,
                         "the track is faster than the vehicle there", "", "m/s"});
    }
    request_.world = std::shared_ptr<const World>(std::shared_ptr<const World>(), &world_.truth());
    if (a != b) {
      for (Violation& violation : leg_violations(before, a, b, request_, at)) {
        found().push_back(std::move(violation));
      }
    }
    note_contact(before, from, to, at, touching);
  }

  /// A contact that continues from point to leg to point counts once.
  void note_contact(const std::optional<Approach>& before, const std::pair<double, Vec3>& from,
                    const std::pair<double, Vec3>& to, std::size_t at, bool& touching) {
    const std::string* met =
        world_.contact(before, from.second, from.first, to.second, to.first, request_);
    world_.flown(from.second, from.first, to.second, to.first);
    if (met != nullptr && !touching) {
      ++verdict_.collisions;
      found().push_back(collision(at, *met, world_.truth()));
    }
    touching = met != nullptr;
  }

  void finish(const Track& track) {
    const Vec3& end = track.back().second;
    request_.world = std::shared_ptr<const World>(std::shared_ptr<const World>(), &world_.truth());
    verdict_.reached = verdict_.collisions == 0 && at_goal(end, request_);
    if (!at_goal(end, request_)) {
      found().push_back({"goal", track.size() - 1, distance_from(request_.goal, end),
                         arrival_distance(request_), "the track does not end at the goal", "",
                         "m"});
    }
    for (const FlightEvent::Near& target : targets_) {
      found().push_back(not_visited(target, track));
    }
    for (Violation& violation : whole_track_violations(track, request_, limits_, telemetry_)) {
      found().push_back(std::move(violation));
    }
  }

  void take_measures(const Track& track, const Polyline& places) {
    verdict_.measures = measure(places, request_);
    verdict_.measures.min_radius_m = track_radius(places, request_.vehicle).radius_m;
    take_times(verdict_.measures, track, request_);
    if (const double separation = world_.separation().distance; std::isfinite(separation)) {
      verdict_.min_separation_m = separation;
    }
  }

  FlightWorld world_;
  std::vector<FlightEvent> events_;         ///< still to come
  std::vector<FlightEvent::Near> targets_;  ///< still to be visited, in order
  bool telemetry_;
  Request request_;  ///< in the true world at that time
  Limits limits_;    ///< of the whole track
  TrackVerdict verdict_;
};
}  // namespace

TrackVerdict judge_track(const Track& track, const FlightSetup& setup) {
  return Replay(setup)(track);
}

namespace {
/// Drops the points that lie on the straight line from the last one kept to the next; `index`
/// receives the track indices of the points kept.
Polyline stretches(const Polyline& track, std::vector<std::size_t>& index) {
  Polyline kept;
  for (std::size_t i = 0; i < track.size(); ++i) {
    const bool ends = i == 0 || i + 1 == track.size();
    if (ends || point_leg_distance(track[i], kept.back(), track[i + 1]) > kLengthTolerance) {
      kept.push_back(track[i]);
      index.push_back(i);
    }
  }
  return kept;
}
}  // namespace

Polyline places_of(const Track& track) {
  Polyline places;
  for (const auto& [t, p] : track) {
    places.push_back(p);
  }
  return places;
}

TrackRadius track_radius(const Polyline& track, const Vehicle& vehicle) {
  TrackRadius tightest;
  std::vector<std::size_t> index;
  const Polyline bends = stretches(track, index);
  std::optional<Approach> before;
  for (std::size_t k = 1; k + 1 < bends.size(); ++k) {
    before = onward(before, bends[k - 1]);
    const std::size_t i = index[k];
    double radius = corner_radius(*before, bends[k], bends[k + 1], vehicle.turns_on_the_spot);
    if (radius > 0 && track[i - 1] != track[i] && track[i] != track[i + 1]) {
      radius = std::max(radius, radius_through(track[i - 1], track[i], track[i + 1]));
    }
    if (radius < tightest.radius_m.value_or(kInfinity)) {
      tightest = {radius, i};
    }
  }
  return tightest;
}

std::vector<Violation> whole_track_violations(const Track& track, const Request& request,
                                              const Limits& limits, bool telemetry) {
  const Polyline places = places_of(track);
  std::vector<Violation> found;
  if (request.vehicle.wing && !telemetry) {
    found = wing_violations(track, request, limits);
  } else if (const TrackRadius tightest = track_radius(places, request.vehicle);
             tightest.radius_m && *tightest.radius_m < limits.min_turn_radius - kLengthTolerance) {
    char message[96];
    std::snprintf(message, sizeof message,
                  "the track turns on a radius of %.9g m, below the limit of %.9g m",
                  *tightest.radius_m, limits.min_turn_radius);
    found.push_back(
        {"turn_radius", tightest.at, *tightest.radius_m, limits.min_turn_radius, message, "", "m"});
  }
  const double total = length(places);
  if (total > request.limits.max_route_length + kLengthTolerance) {
    found.push_back({"route_length", 0, total, request.limits.max_route_length,
                     "the flight is longer than the maximum route length", "", "m"});
  }
  if (request.vehicle.energy != nullptr) {
    if (const auto violation = energy_violation(
            track_energy(track, request, *request.vehicle.energy->power), request.vehicle)) {
      found.push_back(*violation);
    }
  }
  for (const NamedConstraint& named : request.constraints) {
    for (Violation& violation : named.constraint->violations(places, request)) {
      violation.constraint = named.name;
      found.push_back(std::move(violation));
    }
  }
  return found;
}

void take_times(Measures& measures, const Track& track, const Request& request) {
  measures.duration_s = track.back().first - track.front().first;
  measures.time_s = measures.duration_s;
  if (request.vehicle.energy != nullptr) {
    measures.energy_wh = track_energy(track, request, *request.vehicle.energy->power);
  }
}

Request as_telemetry(Request request) {
  constexpr double kArrival = 5;  // metres: autopilots of multirotors accept waypoints within 2 m
  Limits& limits = request.limits;
  limits.min_turn_radius = limits.min_leg = 0;
  limits.max_turn_horizontal = limits.max_turn_space = kPi;
  limits.max_climb = kPi / 2;
  limits.max_sink.reset();
  request.level_m.reset();
  const auto& wing = request.vehicle.wing;
  request.goal.tolerance_m =
      std::max({request.goal.tolerance_m, kArrival, wing ? wing->turn_radius() : 0});
  return request;
}

Violation collision(std::size_t at, const std::string& met, const World& truth) {
  return {"collision",
          at,
          0,
          0,
          "the vehicle touches '" + met + "'",
          truth.find(met) != nullptr ? met : ""};
}

Violation not_visited(const FlightEvent::Near& target, const Track& track) {
  double min_distance = kInfinity;
  for (const auto& [t, p] : track) {
    min_distance = std::min(min_distance, (p - target.at).norm());
  }
  return {"visit",
          track.size() - 1,
          min_distance,
          target.within_m,
          "the track does not visit the target at " + place(target.at),
          "",
          "m"};
}
}  // namespace altiplan::host
