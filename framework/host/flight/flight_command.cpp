// SPDX-License-Identifier: Apache-2.0
#include "host/flight/flight_run.hpp"
#include "host/flight/track_judge.hpp"

#include <algorithm>
#include <cstdio>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {
namespace {

constexpr double kMargin = 0.05;         ///< of the pilot's reach: the pilot takes over below this
constexpr double kClearMargin = 0.075;   ///< above this the route is clear again
constexpr double kMinLeg = 1e-3;         ///< metres: no leg back to the route is shorter
const double kGentleTurn = radians(30);  ///< of a hand-back, at both ends of its leg
constexpr double kMinSpeed = 0.1;        ///< m/s: an aeroplane may stand against the wind
constexpr int kMaxStuck = 3;
}  // namespace

double Flight::speed() const {
  if (request_.vehicle.wing) {
    return std::max(state_.velocity.head<2>().norm(), kMinSpeed);
  }
  return request_.vehicle.speed_at(request_.world->clearance(state_.position));
}

void Flight::fly_route() {
  if (pilot_ != nullptr) {
    const double room = required_ + kMargin * reach_;
    if (const std::string* danger = danger_ahead(route_.progress, state_.time_s, speed(), room)) {
      const std::string why = "the route ahead passes too close to '" + *danger + "'";
      if (vehicle_->takes_commands()) {
        hand_over(true, why);
        fly_pilot();
        return;
      }
      note(why);
    }
  }
  const State from = state_;  // which reports change
  take(vehicle_->follow(route_, from, setup_.step_s, track_report()));
}

void Flight::note(const std::string& danger) {
  const std::string why = danger + ", but commands are not allowed";
  if (result_.handovers.empty() || result_.handovers.back().why != why) {
    hand_over(false, why);
  }
}

FlownVehicle::Report Flight::track_report() {
  return [this](const State& now) {
    fly_leg(now);
    return !ended_;
  };
}

void Flight::take(FlownTo flown) {
  passes_goal_ = flown == FlownTo::past_goal;
  if (ended_) {
    return;
  }
  if (flown == FlownTo::end_of_route && !request_.goal.reached_at(state_.position)) {
    end_flight(RunStatus::not_reached, Reason::route_ended,
               "the route ended " + away() + " from the goal");
  } else if (passes_goal_ && !at_goal(state_.position, request_)) {
    char limit[32];
    std::snprintf(limit, sizeof limit, "%.1f m", arrival_distance(request_));
    end_flight(RunStatus::not_reached, Reason::route_ended,
               "passed the goal at a distance of " + away() + ", above " + limit);
  }
}

void Flight::fly_pilot() {
  route_.progress =
      route_.path.nearest(state_.position, route_.progress, route_.progress + 2 * reach_);
  if (!setup_.always && targets_.empty() && hand_back()) {
    fly_route();
    return;
  }
  rest_.clear();
  route_.path.append_waypoints_after(route_.progress, rest_);
  Observation seen;
  seen.state = state_;
  seen.local_target = local_target();
  seen.goal = goal_of_pilot();
  seen.rest = rest_;
  seen.world = request_.world.get();
  seen.changes = changes_;
  seen.moving = world_.sensed(state_.position, state_.time_s);
  seen.max_dt_s = setup_.step_s;
  PilotStep step = pilot_->step(seen);
  changes_.clear();
  if (step.outcome == PilotStep::Outcome::stuck) {
    stuck(std::string(step.why));
    return;
  }
  const double dt = step.next.time_s - state_.time_s;
  const double run = (step.next.position - state_.position).norm();
  if (run > top_speed(request_.vehicle) * dt * (1 + 1e-6) + kLengthTolerance) {
    throw PluginError("violated the contract of its interface: a step faster than the vehicle",
                      Reason::contract);
  }
  const State from = state_;
  take(vehicle_->go(route_, from, step.next, track_report()));
}

void Flight::stuck(const std::string& why) {
  ask_replan();
  if (++stuck_ > kMaxStuck) {
    end_flight(RunStatus::not_reached, Reason::stuck,
               "the pilot '" + setup_.pilot_name + "' is stuck at " + place(state_.position) +
                   ", " + away() + " from the goal: " + why);
  }
}

Vec3 Flight::local_target() const {
  if (!targets_.empty()) {
    return targets_.front().at;
  }
  const double room = required_ + kMargin * reach_;
  double s = route_.progress + reach_ / 2;
  while (s < route_.path.length() && !is_free(route_.path.at(s), room)) {
    s += reach_ / 20;
  }
  return s < route_.path.length() ? route_.path.at(s) : goal_of_pilot().position;
}

Goal Flight::goal_of_pilot() const {
  Goal goal = request_.goal;
  if (!targets_.empty()) {
    goal = {targets_.front().at, targets_.front().within_m};
  } else if (goal.loiter) {
    goal.position = route_.path.at(route_.path.length());
    goal.loiter.reset();
  }
  return goal;
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
