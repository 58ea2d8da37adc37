// SPDX-License-Identifier: Apache-2.0
#include "host/flight/flight_run.hpp"

#include <algorithm>

#include "host/base/words.hpp"
#include "host/flight/track_judge.hpp"

namespace altiplan::host {
namespace {

constexpr double kMinSpeed = 0.1;  ///< m/s: an aeroplane may stand against the wind
}  // namespace

double Flight::speed() const {
  if (request_.vehicle.wing) {
    return std::max(state_.velocity.head<2>().norm(), kMinSpeed);
  }
  return request_.vehicle.speed_at(request_.world->clearance(state_.position));
}

void Flight::fly_route() {
  if (pilot_takes_over()) {
    fly_pilot();
    return;
  }
  const State from = state_;  // which reports change
  take(vehicle_->follow(route_, from, setup_.step_s, track_report()));
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
    end_flight(RunStatus::not_reached, Reason::route_ended,
               "passed the goal at a distance of " + away() + ", above " +
                   with_decimals(arrival_distance(request_), 1) + " m");
  }
}
}  // namespace altiplan::host
