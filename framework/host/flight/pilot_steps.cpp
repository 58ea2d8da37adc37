// SPDX-License-Identifier: Apache-2.0
#include "host/flight/flight_run.hpp"

#include <algorithm>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"
#include "host/flight/track_judge.hpp"

namespace altiplan::host {
namespace {

constexpr int kMaxStuck = 3;
}  // namespace

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
  if (run > request_.vehicle.max_speed() * dt * (1 + 1e-6) + kLengthTolerance) {
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
  const double room = takeover_distance();
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
}  // namespace altiplan::host
