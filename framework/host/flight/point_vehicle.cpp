// SPDX-License-Identifier: Apache-2.0
#include "host/flight/point_vehicle.hpp"

#include <algorithm>

namespace altiplan::host {
namespace {

constexpr double kMinRest = 1e-3;   ///< metres: a shorter rest of a leg is flown with the step
constexpr double kMinShare = 1e-9;  ///< of a step: a shorter rest is rounding error, not flown
}  // namespace

FlownTo PointVehicle::follow(RouteAhead& route, const State& from, double duration,
                             const Report& report) {
  State now = from;
  double left = duration;
  while (left > kMinShare * duration) {
    if (const double wait_s = route.path.wait_at(route.progress); wait_s > 0) {
      const double dt = std::min(wait_s, left);
      route.path.waited(route.progress, dt);
      left -= dt;
      now = {now.time_s + dt, now.position};
      if (!report(now)) {
        break;
      }
      continue;
    }
    const Vec3 next = route.path.next_waypoint(route.progress);
    const Vec3 way = next - now.position;
    const double to_next = way.norm();
    if (to_next <= kMinRest && route.progress + kMinRest >= route.path.length()) {
      return FlownTo::end_of_route;
    }
    if (to_next == 0) {
      route.progress = route.path.end_of_leg(route.progress);
      continue;
    }
    const double speed = request_->vehicle.speed_at(request_->world->clearance(now.position));
    const double climbs_s = request_->vehicle.climb_time(way.z());
    const double v = climbs_s * speed > to_next ? to_next / climbs_s : speed;
    const bool whole = to_next - v * left <= kMinRest;
    const double run = whole ? to_next : v * left;
    route.progress = whole ? route.path.end_of_leg(route.progress) : route.progress + run;
    const double dt = run / v;
    now = {now.time_s + dt, whole ? next : Vec3(now.position + way / to_next * run),
           way / to_next * v};
    left -= dt;
    if (!report(now) || request_->goal.reached_at(now.position)) {
      break;
    }
  }
  return FlownTo::on_the_way;
}
}  // namespace altiplan::host
