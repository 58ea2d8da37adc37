// SPDX-License-Identifier: Apache-2.0
#include "host/flight/flight_run.hpp"

#include <algorithm>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {

void Flight::meet_events() {
  if (!targets_.empty() && targets_.front().is_near(state_.position)) {
    targets_.erase(targets_.begin());
  }
  bool world_differs = false;
  for (auto event = events_.begin(); event != events_.end();) {
    if (!event->is_due(state_.time_s, state_.position)) {
      ++event;
      continue;
    }
    if (event->kind == FlightEvent::Kind::visit) {
      meet_target(event->target);
    } else if (event->kind == FlightEvent::Kind::move_goal) {
      request_.goal.position = event->vector;
      const bool is_beside =
          pilot_commands_ || setup_.vehicle != nullptr || request_.vehicle.wing.has_value();
      route_.path.move_end(is_beside ? route_.path.at(route_.progress) : state_.position,
                           route_.progress, event->vector);
      route_.restart();
      end_moved_ = true;
      ask_replan();
    } else {
      world_.apply(*event);
      world_differs = true;
    }
    event = events_.erase(event);
  }
  if (world_differs) {
    end_on_contact(state_.position, state_.time_s, state_.position, state_.time_s);
  }
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

void Flight::sense() {
  const std::vector<Change> changes = world_.sense(state_.position, state_.time_s);
  request_.world = world_.known();
  changes_.insert(changes_.end(), changes.begin(), changes.end());
  replan_changes_.insert(replan_changes_.end(), changes.begin(), changes.end());
  if (setup_.replanner == nullptr) {
    return;
  }
  if ((setup_.when == ReplanWhen::any_change && !changes.empty()) ||
      (!world_.fresh().empty() && rest_is_blocked())) {
    ask_replan();
  }
}

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
  route_.path.for_each_leg(from, from + reach_, [&](const Vec3& a, const Vec3& b) {
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
