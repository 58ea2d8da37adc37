// SPDX-License-Identifier: Apache-2.0
#include "host/flight/flight_run.hpp"

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
}  // namespace altiplan::host
