// SPDX-License-Identifier: Apache-2.0
#include "host/flight/flight_run.hpp"
#include "host/flight/track_judge.hpp"

#include <algorithm>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {
namespace {

constexpr double kMargin = 0.05;         ///< of the pilot's reach: the pilot takes over below this
constexpr double kClearMargin = 0.075;   ///< above this the route is clear again
constexpr double kMinWay = 1e-3;         ///< metres: a shorter rest of a leg is flown with the step
constexpr double kMinShare = 1e-9;       ///< of a step: a shorter rest is rounding error, not flown
const double kGentleTurn = radians(30);  ///< of a hand-back, at both ends of its leg
constexpr double kMinSpeed = 0.1;        ///< m/s: an aeroplane may stand against the wind
constexpr int kMaxStuck = 3;
}  // namespace

double Flight::speed() const {
  if (wing_) {
    return std::max(state_.velocity.head<2>().norm(), kMinSpeed);
  }
  return request_.vehicle.speed_at(request_.world->clearance(state_.position));
}

void Flight::restart_path() {
  progress_ = 0;
  reference_ = 0;
}

void Flight::fly_route() {
  if (pilot_ != nullptr) {
    const double room = required_ + kMargin * reach_;
    if (const std::string* danger = danger_ahead(progress_, state_.time_s, speed(), room)) {
      hand_over(true, "the route ahead passes too close to '" + *danger + "'");
      fly_pilot();
      return;
    }
  }
  if (wing_) {
    fly_wing_on_route();
    return;
  }
  double left = setup_.step_s;
  while (!ended_ && left > kMinShare * setup_.step_s) {
    const Vec3 next = path_.next_waypoint(progress_);
    const Vec3 way = next - state_.position;
    const double to_next = way.norm();
    if (to_next <= kMinWay && progress_ + kMinWay >= path_.length()) {
      if (!request_.goal.reached_at(state_.position)) {
        end_flight(RunStatus::not_reached, Reason::route_ended,
                   "the route ended " + away() + " from the goal");
      }
      return;
    }
    if (to_next == 0) {
      progress_ = path_.end_of_leg(progress_);
      continue;
    }
    const double v = speed();
    const bool whole = to_next - v * left <= kMinWay;
    const double run = whole ? to_next : v * left;
    progress_ = whole ? path_.end_of_leg(progress_) : progress_ + run;
    const double dt = run / v;
    fly_leg({state_.time_s + dt, whole ? next : Vec3(state_.position + way / to_next * run),
             way / to_next * v});
    left -= dt;
    if (request_.goal.reached_at(state_.position)) {
      return;
    }
  }
}

void Flight::fly_pilot() {
  progress_ = path_.nearest(state_.position, progress_, progress_ + 2 * reach_);
  if (!setup_.always && hand_back()) {
    fly_route();
    return;
  }
  rest_.clear();
  path_.append_waypoints_after(progress_, rest_);
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
  wing_ ? fly_wing_toward(step.next) : fly_leg(step.next);
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
  const double room = required_ + kMargin * reach_;
  double s = progress_ + reach_ / 2;
  while (s < path_.length() && !is_free(path_.at(s), room)) {
    s += reach_ / 20;
  }
  return s < path_.length() ? path_.at(s) : goal_of_pilot().position;
}

Goal Flight::goal_of_pilot() const {
  Goal goal = request_.goal;
  if (goal.loiter) {
    goal.position = path_.at(path_.length());
    goal.loiter.reset();
  }
  return goal;
}

bool Flight::hand_back() {
  const double room = required_ + kClearMargin * reach_;
  for (int k = 1; k <= 8; ++k) {
    const double s = std::min(progress_ + reach_ * k / 8, path_.length());
    const Vec3 q = path_.at(s);
    const Vec3 leg = q - state_.position;
    if (leg.norm() <= kMinWay) {
      continue;
    }
    const Vec3 onward = s < path_.length() ? Vec3(path_.next_waypoint(s) - q) : leg;
    const double t1 = state_.time_s + leg.norm() / speed();
    if (turn_angle_in_space(state_.velocity, leg) <= kGentleTurn &&
        turn_angle_in_space(leg, onward) <= kGentleTurn &&
        leg_ok(before_, state_.position, q, request_) &&
        danger_on(state_.position, state_.time_s, q, t1, room) == nullptr &&
        danger_ahead(s, t1, speed(), room) == nullptr) {
      path_.rejoin(state_.position, s);
      restart_path();
      hand_over(false, "clear: a straight leg leads back to the route");
      return true;
    }
    if (s == path_.length()) {
      break;
    }
  }
  return false;
}
}  // namespace altiplan::host
