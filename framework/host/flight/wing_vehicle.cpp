// SPDX-License-Identifier: Apache-2.0
#include "host/flight/wing_vehicle.hpp"

#include <algorithm>
#include <cmath>

#include "host/flight/point_vehicle.hpp"
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

State WingVehicle::take_off(const Request& request, const RouteAhead& route, const State& first) {
  request_ = &request;
  wing_.emplace(request);
  const auto& loiter = request_->start.loiter;
  wing_->take_over(first, route.path.course_at(0), loiter ? loiter->sense / loiter->radius : 0);
  State flying = first;
  flying.velocity = wing_->velocity(first.position, first.velocity.z());
  return flying;
}

FlownTo WingVehicle::follow(RouteAhead& route, const State& from, double duration,
                            const Report& report) {
  return fly(
      route, from, duration, true, [&](const State& now) { return reference_on(route, now); },
      report);
}

FlownTo WingVehicle::go(RouteAhead& route, const State& from, const State& command,
                        const Report& report) {
  const Vec3 way = command.position - from.position;
  const double run = std::max(way.head<2>().norm(), kLengthTolerance);
  const auto reference = [&](const State& now) {
    const double lookahead = wing_->lookahead(now.velocity);
    return Reference{now.position + lookahead / run * way, lookahead};
  };
  return fly(route, from, command.time_s - from.time_s, false, reference, report);
}

FlownTo WingVehicle::fly(RouteAhead& route, const State& from, double duration, bool on_route,
                         const ReferenceFor& reference_for, const Report& report) {
  const double turn_step = kMaxStepTurn / wing_->max_turn_rate();
  const int steps = int(std::ceil(duration / std::min(kMaxGuidanceStep, turn_step)));
  const double dt = duration / steps;
  State last = from;  // point of the track
  State now = from;
  bool goes_on = true;
  bool is_past = false;
  for (int i = 1; i <= steps && goes_on && !is_past; ++i) {
    const Reference reference = reference_for(now);
    State next = wing_->fly(now, reference.point, reference.ahead, dt);
    next.time_s = from.time_s + i * dt;
    const bool other_wind = request_->wind.at(now.position) != request_->wind.at(last.position);
    if (now.time_s > last.time_s && (other_wind || bends(last, next))) {
      goes_on = report(now);
      last = now;
    }
    now = next;
    if (on_route) {
      route.advance(now, dt);
    }
    is_past = passes_goal(route, *request_, now, on_route);
  }
  if (goes_on) {
    report(now);
  }
  return is_past ? FlownTo::past_goal : FlownTo::on_the_way;
}

WingVehicle::Reference WingVehicle::reference_on(RouteAhead& route, const State& now) const {
  const FlightPath& path = route.path;
  const double off = (now.position - path.at(route.progress)).head<2>().norm();
  const double distance = std::max(wing_->lookahead(now.velocity), kIntercept * off);
  route.reference = path.first_beyond(distance, now.position, route.progress);
  Vec3 point = path.at(route.reference);
  double ahead = path.level(route.reference) - path.level(route.progress);
  if (route.reference >= path.length()) {
    const double beyond = std::max(0.0, distance - (point - now.position).head<2>().norm());
    point = beyond_the_end(path, beyond);
    ahead += beyond;
  }
  return {point, std::max(ahead, kMinAhead)};
}

Vec3 WingVehicle::beyond_the_end(const FlightPath& path, double distance) const {
  const Vec3 end = path.at(path.length());
  const Goal& goal = request_->goal;
  if (!goal.loiter || !goal.loiter->passes(goal.position, end)) {
    return end + distance * path.end_direction();
  }
  const Vec3 arm = end - goal.position;
  const double angle =
      std::atan2(arm.y(), arm.x()) + goal.loiter->sense * distance / goal.loiter->radius;
  return goal.position + goal.loiter->radius * unit_heading(angle);
}

bool passes_goal(const RouteAhead& route, const Request& request, const State& now, bool on_route) {
  const Goal& goal = request.goal;
  const Vec3 end = route.path.at(route.path.length());
  if (!goal.loiter && goal.reached_at(now.position)) {
    return true;
  }
  if (!on_route) {
    const Vec3 way = (goal.loiter ? end : goal.position) - now.position;
    return at_goal(now.position, request) && way.dot(now.velocity) <= 0;
  }
  const Vec3 beyond = now.position - end;
  const bool is_at_end = route.progress >= route.path.length() - kLengthTolerance;  // a sum of legs
  return is_at_end && beyond.head<2>().dot(route.path.end_direction().head<2>()) >= 0;
}

std::unique_ptr<FlownVehicle> simulated_vehicle(const Vehicle& vehicle) {
  if (vehicle.wing) {
    return std::make_unique<WingVehicle>();
  }
  return std::make_unique<PointVehicle>();
}
}  // namespace altiplan::host
