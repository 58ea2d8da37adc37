// SPDX-License-Identifier: Apache-2.0
#include "host/flight/flight_run.hpp"

#include <algorithm>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {

// Who has the command, and why: the route ahead is unsafe, a target is to be visited, or a straight
// leg leads back.
namespace {

constexpr double kMargin = 0.05;         ///< of the pilot's reach: the pilot takes over below this
constexpr double kClearMargin = 0.075;   ///< above this the route is clear again
constexpr double kMinLeg = 1e-3;         ///< metres: no leg back to the route is shorter
const double kGentleTurn = radians(30);  ///< of a hand-back, at both ends of its leg
}  // namespace

double Flight::takeover_distance() const { return required_ + kMargin * reach_; }

bool Flight::pilot_takes_over() {
  if (pilot_ == nullptr) {
    return false;
  }
  const std::string* danger =
      danger_ahead(route_.progress, state_.time_s, speed(), takeover_distance());
  if (danger == nullptr) {
    return false;
  }
  const std::string why = "the route ahead passes too close to '" + *danger + "'";
  if (!vehicle_->takes_commands()) {
    note(why);
    return false;
  }
  hand_over(true, why);
  return true;
}

void Flight::meet_target(const FlightEvent::Near& target) {
  if (pilot_ == nullptr) {
    throw Error("event visit: the fly step has no local planner");
  }
  targets_.push_back(target);
  const std::string why = "a target at " + place(target.at);
  if (!vehicle_->takes_commands()) {
    note(why);
  } else if (!pilot_commands_) {
    hand_over(true, why);
  }
}

void Flight::note(const std::string& danger) {
  const std::string why = danger + ", but commands are not allowed";
  if (result_.handovers.empty() || result_.handovers.back().why != why) {
    hand_over(false, why);
  }
}

void Flight::hand_over(bool to_pilot, std::string why) {
  pilot_commands_ = to_pilot;
  result_.handovers.push_back(
      {state_.time_s, to_pilot ? setup_.pilot_name : "route", std::move(why)});
}

bool Flight::hand_back() {
  const double room = required_ + kClearMargin * reach_;
  // The last leg between two reported positions is too short to give a course.
  const bool has_course = setup_.telemetry && state_.velocity != Vec3::Zero();
  const std::optional<Approach> before =
      has_course ? Approach(state_.position - state_.velocity) : before_;
  for (int k = 1; k <= 8; ++k) {
    const double s = std::min(route_.progress + reach_ * k / 8, route_.path.length());
    const Vec3 q = route_.path.at(s);
    const Vec3 leg = q - state_.position;
    if (leg.norm() <= kMinLeg) {
      continue;
    }
    const Vec3 onward = s < route_.path.length() ? Vec3(route_.path.next_waypoint(s) - q) : leg;
    const double t1 = state_.time_s + leg.norm() / speed();
    if (turn_angle_in_space(state_.velocity, leg) <= kGentleTurn &&
        turn_angle_in_space(leg, onward) <= kGentleTurn &&
        leg_ok(before, state_.position, q, request_) &&
        danger_on(state_.position, state_.time_s, q, t1, room) == nullptr &&
        danger_ahead(s, t1, speed(), room) == nullptr) {
      route_.path.rejoin(state_.position, s);
      route_.restart();
      hand_over(false, "clear: a straight leg leads back to the route");
      return true;
    }
    if (s == route_.path.length()) {
      break;
    }
  }
  return false;
}
}  // namespace altiplan::host
