// SPDX-License-Identifier: Apache-2.0
#include "host/base/words.hpp"
#include "host/flight/flight_run.hpp"
#include "host/flight/track_judge.hpp"

#include <algorithm>
#include <cmath>

namespace altiplan::host {
namespace {

/// The farthest from its limit, of the constraint that the first is of: others have other units.
const Violation& worst_of_first_kind(const std::vector<Violation>& violations) {
  constexpr double kWorse = 1 + 1e-6;  // legs of one slope differ by rounding
  const auto excess = [](const Violation& violation) {
    return std::abs(violation.value - violation.limit);
  };
  const Violation* worst = &violations.front();
  for (const Violation& violation : violations) {
    if (violation.constraint == worst->constraint && excess(violation) > kWorse * excess(*worst)) {
      worst = &violation;
    }
  }
  return *worst;
}
}  // namespace

void Flight::fly_leg(const State& next) {
  const Vec3 a = state_.position;
  const double t0 = state_.time_s;
  const double t1 = next.time_s;
  const Vec3& b = next.position;
  if (a != b) {  // a hovering vehicle flies no leg, but may still be hit
    for (Violation& violation :
         leg_violations(before_, a, b, truth_request_, result_.track.size() - 1)) {
      result_.check.violations.push_back(std::move(violation));
    }
  }
  result_.track.emplace_back(t1, b);
  state_ = next;
  end_on_contact(a, t0, b, t1);
  if (a != b) {
    before_ = onward(before_, a);
  }
  meet_events();  // at the goal too: an obstacle may appear there
}

void Flight::end_on_contact(const Vec3& a, double t0, const Vec3& b, double t1) {
  world_.flown(a, t0, b, t1);
  const std::string* met = world_.contact(before_, a, t0, b, t1, truth_request_);
  if (met == nullptr || ended_) {  // events after the end of the flight do not count
    return;
  }
  ++result_.collisions;
  result_.check.violations.push_back(collision(result_.track.size() - 1, *met, world_.truth()));
  end_flight(RunStatus::collided, Reason::none, "collided with '" + *met + "' near " + place(b));
}

void Flight::finish() {
  result_.reached = !ended_ && at_goal(state_.position, request_);
  const Polyline track = places_of(result_.track);
  result_.measures = measure(track, truth_request_);
  result_.measures.min_radius_m = track_radius(track, request_.vehicle).radius_m;
  take_times(result_.measures, result_.track, truth_request_);
  if (const double separation = world_.separation().distance; std::isfinite(separation)) {
    result_.min_separation_m = separation;
  }
  result_.cross_track_max_m = route_.error.across_quantile(1);
  result_.cross_track_p999_m = route_.error.across_quantile(0.999);
  result_.height_error_max_m = route_.error.height_max();
  if (pilot_ != nullptr) {
    result_.counters = pilot_->counters();
  }
  for (Counter& counter : vehicle_->counters()) {
    result_.counters.push_back(std::move(counter));
  }
  result_.counters.insert(result_.counters.begin(), {"steps", steps_});
  judge_whole();
  if (!ended_) {
    const CheckResult& check = result_.check;
    result_.status = check.ok() ? RunStatus::solved : RunStatus::rejected;
    result_.reason = check.ok() ? Reason::none : Reason::constraint;
    result_.message = check.ok() ? "reached the goal" : "reached the goal, but " + attribute_to();
  }
}

std::string Flight::attribute_to() const {
  const Violation& worst = worst_of_first_kind(result_.check.violations);
  if (worst.constraint == "route_length") {
    return worst.message;  // of the whole track
  }
  const auto& [time_s, at] = result_.track[std::min(worst.at, result_.track.size() - 1)];
  return "at " + with_decimals(time_s, 1) + " s, near " + place(at) + " m: " + worst.message;
}

void Flight::judge_whole() {
  const Request& request = truth_request_;
  std::vector<Violation>& found = result_.check.violations;
  const Limits& limits = setup_.telemetry ? request.limits : request_.limits;
  const Vec3& end = state_.position;
  if (!at_goal(end, request_)) {  // the goal as it is now
    found.push_back({"goal", result_.track.size() - 1, distance_from(request_.goal, end),
                     arrival_distance(request_), "the flight ended " + away() + " from the goal",
                     "", "m"});
  }
  for (const FlightEvent::Near& target : targets_) {
    found.push_back(not_visited(target, result_.track));
  }
  for (Violation& violation :
       whole_track_violations(result_.track, request, limits, setup_.telemetry)) {
    found.push_back(std::move(violation));
  }
}
}  // namespace altiplan::host
