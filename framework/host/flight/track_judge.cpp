// SPDX-License-Identifier: Apache-2.0
#include "host/flight/track_judge.hpp"

#include <algorithm>
#include <memory>

#include "altiplan/error.hpp"
#include "host/flight/flight_world.hpp"

namespace altiplan::host {
namespace {

class Replay {
 public:
  explicit Replay(const FlightSetup& setup)
      : world_(setup), events_(setup.events), request_(setup.request) {}

  TrackVerdict operator()(const Track& track) {
    if (track.empty() || track.front().second != request_.start.position) {
      found().push_back({"start", 0, 0, 0, "the track does not begin at the start"});
      return std::move(verdict_);
    }
    std::optional<Vec3> before = request_.before_start();
    bool touching = false;
    note_contact(track.front(), track.front(), 0, touching);
    for (std::size_t i = 0; i + 1 < track.size(); ++i) {
      meet_events(track[i].first, track[i].second);
      judge_leg(before, track[i], track[i + 1], i, touching);
      before = track[i].second;
    }
    meet_events(track.back().first, track.back().second);
    Route places;
    for (const auto& [t, p] : track) {
      places.push_back(p);
    }
    finish(places);
    return std::move(verdict_);
  }

 private:
  std::vector<Violation>& found() { return verdict_.check.violations; }

  void meet_events(double time_s, const Vec3& p) {
    for (auto event = events_.begin(); event != events_.end();) {
      if (!event->is_due(time_s, p)) {
        ++event;
        continue;
      }
      if (event->kind == FlightEvent::Kind::move_goal) {
        request_.goal.position = event->vector;
      } else {
        world_.apply(*event);
      }
      event = events_.erase(event);
    }
  }

  void judge_leg(const std::optional<Vec3>& before, const std::pair<double, Vec3>& from,
                 const std::pair<double, Vec3>& to, std::size_t at, bool& touching) {
    const auto& [t0, a] = from;
    const auto& [t1, b] = to;
    const double run = (b - a).norm();
    const double fastest = top_speed(request_.vehicle);
    if (!(t1 > t0) || run > fastest * (t1 - t0) * (1 + 1e-6) + kLengthTolerance) {
      found().push_back({"speed", at, t1 > t0 ? run / (t1 - t0) : kInfinity, fastest,
                         "the track is faster there than the vehicle"});
    }
    request_.world = std::shared_ptr<const World>(std::shared_ptr<const World>(), &world_.truth());
    for (Violation& violation : leg_violations(before, a, b, request_, at)) {
      found().push_back(std::move(violation));
    }
    note_contact(from, to, at, touching);
  }

  /// A contact that goes on from leg to leg counts once.
  void note_contact(const std::pair<double, Vec3>& from, const std::pair<double, Vec3>& to,
                    std::size_t at, bool& touching) {
    const std::string* met =
        world_.contact(from.second, from.first, to.second, to.first, request_.vehicle.radius_m);
    if (met != nullptr && !touching) {
      ++verdict_.collisions;
      found().push_back({"collision", at, 0, 0, "the vehicle touches '" + *met + "'"});
    }
    touching = met != nullptr;
  }

  void finish(const Route& track) {
    request_.world = std::shared_ptr<const World>(std::shared_ptr<const World>(), &world_.truth());
    verdict_.reached = verdict_.collisions == 0 && request_.goal.reached_at(track.back());
    if (!request_.goal.reached_at(track.back())) {
      found().push_back({"goal", track.size() - 1, (track.back() - request_.goal.position).norm(),
                         request_.goal.tolerance_m, "the track does not end at the goal"});
    }
    for (Violation& violation : whole_track_violations(track, request_)) {
      found().push_back(std::move(violation));
    }
  }

  FlightWorld world_;
  std::vector<FlightEvent> events_;  ///< still to come
  Request request_;                  ///< in the true world as it is then
  TrackVerdict verdict_;
};
}  // namespace

TrackVerdict judge_track(const Track& track, const FlightSetup& setup) {
  return Replay(setup)(track);
}

std::vector<Violation> whole_track_violations(const Route& track, const Request& request) {
  std::vector<Violation> found;
  const double total = length(track);
  if (total > request.limits.max_route_length + kLengthTolerance) {
    found.push_back({"route_length", 0, total, request.limits.max_route_length,
                     "the flight is longer than the route may be"});
  }
  for (const NamedConstraint& named : request.constraints) {
    for (Violation& violation : named.constraint->violations(track, request)) {
      violation.constraint = named.name;
      found.push_back(std::move(violation));
    }
  }
  return found;
}

double top_speed(const Vehicle& vehicle) {
  double top = vehicle.speed_mps;
  for (const SpeedNear& near : vehicle.speed_near) {
    top = std::max(top, near.speed_mps);
  }
  return top;
}
}  // namespace altiplan::host
