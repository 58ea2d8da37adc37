// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/base/words.hpp"
#include "host/flight/flight_run.hpp"
#include "host/flight/track_judge.hpp"

namespace altiplan::host {
namespace {

constexpr double kMaxGuidanceStep = 0.05;    ///< seconds
constexpr double kMaxStepTurn = radians(1);  ///< of a guidance step, at the minimum radius
constexpr double kSagitta = 0.01;            ///< metres between the flight and the track's legs
constexpr double kIntercept = 1.5;  ///< times the distance from the route: an angle of 42 degrees
constexpr double kMinAhead = 1;     ///< metres along the route to the reference point

/// True if a leg from one state to the other is farther than kSagitta from the curve flown.
bool bends(const State& from, const State& to) {
  const double run = (to.position - from.position).norm();
  return turn_angle_in_space(from.velocity, to.velocity) * run / 8 > kSagitta;
}
}  // namespace

void Flight::take_off_wing() {
  wing_.emplace(request_);
  const double airspeed = request_.vehicle.wing->airspeed_mps;
  for (const double z : path_.heights_across(request_.wind)) {
    if (const double wind = request_.wind.at(z).norm(); wind >= airspeed) {
      char message[160];
      std::snprintf(message, sizeof message,
                    "the wind of %g m/s at a height of %.0f m is not below the airspeed of %g m/s: "
                    "the aeroplane cannot hold its course there",
                    wind, z, airspeed);
      end_flight(RunStatus::not_reached, Reason::none, message);
      return;
    }
  }
  const auto& loiter = setup_.request.start.loiter;
  wing_->take_over(state_, path_.course_at(0), loiter ? loiter->sense / loiter->radius : 0);
  state_.velocity = wing_->velocity(state_.position.z(), state_.velocity.z());
}

void Flight::fly_wing_on_route() {
  fly_wing(setup_.step_s, true, [&](const State& now) { return reference_on_route(now); });
}

void Flight::fly_wing_toward(const State& command) {
  const Vec3 way = command.position - state_.position;
  const double run = std::max(way.head<2>().norm(), kLengthTolerance);
  fly_wing(command.time_s - state_.time_s, false, [&](const State& now) {
    const double lookahead = wing_->lookahead(now.velocity);
    return Reference{now.position + lookahead / run * way, lookahead};
  });
}

void Flight::fly_wing(double duration, bool on_route, const ReferenceFor& reference_for) {
  const double begin = state_.time_s;
  const double turn_step = kMaxStepTurn / wing_->max_turn_rate();
  const int steps = int(std::ceil(duration / std::min(kMaxGuidanceStep, turn_step)));
  const double dt = duration / steps;
  State now = state_;
  for (int i = 1; i <= steps && !ended_ && !passes_goal_; ++i) {
    const Reference reference = reference_for(now);
    State next = wing_->fly(now, reference.point, reference.ahead, dt);
    next.time_s = begin + i * dt;
    const bool other_wind =
        request_.wind.at(now.position.z()) != request_.wind.at(state_.position.z());
    if (now.time_s > state_.time_s && (other_wind || bends(state_, next))) {
      fly_leg(now);
    }
    now = next;
    if (on_route) {
      note_errors(now, dt);
    }
    passes_goal_ = passes_goal(now, on_route);
  }
  if (!ended_) {
    fly_leg(now);
  }
  if (!ended_ && passes_goal_ && !at_goal(now.position, request_)) {
    char limit[32];
    std::snprintf(limit, sizeof limit, "%.1f m", arrival_distance(request_));
    end_flight(RunStatus::not_reached, Reason::route_ended,
               "passed the goal at a distance of " + away() + ", above " + limit);
  }
}

Flight::Reference Flight::reference_on_route(const State& now) {
  const double off = (now.position - path_.at(progress_)).head<2>().norm();
  const double distance = std::max(wing_->lookahead(now.velocity), kIntercept * off);
  reference_ = path_.first_beyond(distance, now.position, progress_);
  Vec3 point = path_.at(reference_);
  double ahead = path_.level(reference_) - path_.level(progress_);
  if (reference_ >= path_.length()) {
    const double beyond = std::max(0.0, distance - (point - now.position).head<2>().norm());
    point = beyond_the_end(beyond);
    ahead += beyond;
  }
  return {point, std::max(ahead, kMinAhead)};
}

Vec3 Flight::beyond_the_end(double distance) const {
  const Vec3 end = path_.at(path_.length());
  const Goal& goal = request_.goal;
  if (!goal.loiter || !goal.loiter->passes(goal.position, end)) {
    return end + distance * path_.end_direction();
  }
  const Vec3 arm = end - goal.position;
  const double angle =
      std::atan2(arm.y(), arm.x()) + goal.loiter->sense * distance / goal.loiter->radius;
  return goal.position + goal.loiter->radius * unit_heading(angle);
}

void Flight::note_errors(const State& now, double dt) {
  progress_ = path_.nearest_level(now.position, progress_, reference_);
  const Vec3 off = now.position - path_.at(progress_);
  follow_error_.add(off.head<2>().norm(), off.z(), dt);
}

bool Flight::passes_goal(const State& now, bool on_route) const {
  const Goal& goal = request_.goal;
  if (!goal.loiter && goal.reached_at(now.position)) {
    return true;
  }
  if (!on_route) {
    const Vec3 way = goal_of_pilot().position - now.position;
    return at_goal(now.position, request_) && way.dot(now.velocity) <= 0;
  }
  const Vec3 beyond = now.position - path_.at(path_.length());
  const bool is_at_end = progress_ >= path_.length() - kLengthTolerance;  // a sum of legs
  return is_at_end && beyond.head<2>().dot(path_.end_direction().head<2>()) >= 0;
}
}  // namespace altiplan::host
