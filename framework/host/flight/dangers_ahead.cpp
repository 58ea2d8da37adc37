// SPDX-License-Identifier: Apache-2.0
#include "host/flight/flight_run.hpp"

#include <algorithm>

namespace altiplan::host {

const std::string* Flight::unplanned_near(const Vec3& a, const Vec3& b, double room) const {
  for (const Layer& layer : request_.world->layers()) {
    if (world_.fresh().count(layer.id) > 0 && layer.environment->blocked(a, b, room)) {
      return &layer.id;
    }
    if (end_moved_ && layer.environment->blocked(a, b, required_)) {
      return &layer.id;
    }
  }
  return nullptr;
}

bool Flight::rest_is_blocked() const {
  bool blocked = false;
  route_.path.for_each_leg(route_.progress, route_.path.length(),
                           [&](const Vec3& a, const Vec3& b) {
                             blocked = blocked || unplanned_near(a, b, required_) != nullptr;
                           });
  return blocked;
}

const std::string* Flight::danger_on(const Vec3& a, double t0, const Vec3& b, double t1,
                                     double room) const {
  if (const std::string* layer = unplanned_near(a, b, room)) {
    return layer;
  }
  for (const MovingObstacle& obstacle : request_.world->moving()) {
    if (hits(obstacle, a, t0, b, t1, room)) {
      return &obstacle.id;
    }
  }
  return nullptr;
}

const std::string* Flight::danger_ahead(double from, double t, double speed, double room) const {
  const std::string* danger = nullptr;
  if (world_.fresh().empty() && !end_moved_ && request_.world->moving().empty()) {
    return danger;  // the route was planned around everything known
  }
  double s = from;
  route_.path.for_each_leg(from, from + reach_, [&](const Vec3& a, const Vec3& b) {
    if (const double wait_s = route_.path.wait_at(s); wait_s > 0) {
      danger = danger == nullptr ? danger_on(a, t, a, t + wait_s, room) : danger;
      t += wait_s;
    }
    s = route_.path.end_of_leg(s);
    const double t1 = t + (b - a).norm() / speed;
    if (danger == nullptr) {
      danger = danger_on(a, t, b, t1, room);
    }
    t = t1;
  });
  return danger;
}

bool Flight::is_free(const Vec3& p, double room) const {
  return unplanned_near(p, p, room) == nullptr &&
         std::none_of(request_.world->moving().begin(), request_.world->moving().end(),
                      [&](const MovingObstacle& moving) {
                        return signed_distance(moving.at(state_.time_s), p) < room;
                      });
}
}  // namespace altiplan::host
