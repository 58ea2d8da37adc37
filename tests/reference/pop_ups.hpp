// SPDX-License-Identifier: Apache-2.0
// Threats that appear on a route while it is flown (paper 000).
#pragma once

#include <memory>
#include <optional>

#include "altiplan/check.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"

namespace altiplan::testing {

struct PopUp {
  State state;    ///< of the vehicle, on its route
  Sphere threat;  ///< on the rest of it
  std::shared_ptr<const World> world;
  Change change;
};

/// The place and heading after `along` metres of the route.
inline State on_route(const Route& route, double along, double speed) {
  State state{0, route.front(), {0, 0, 0}};
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    const Vec3 leg = route[i + 1] - route[i];
    const double length = leg.norm();
    state.velocity = speed / length * leg;
    state.position = route[i] + std::min(1.0, along / length) * leg;
    if (along < length) {
      break;
    }
    along -= length;
  }
  return state;
}

/// A sphere of that radius about the rest of the route, at least `room` beyond the radius from the
/// vehicle and from the goal.
inline PopUp draw_pop_up(const Route& route, const Request& request, double radius, double room,
                         RandomStream random) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    length += (route[i + 1] - route[i]).norm();
  }
  while (true) {
    const double flown = random.uniform(0, 1) * length;
    const double ahead = random.uniform(flown, length);
    const Vec3 aside = random.in({{-1, -1, -0.5}, {1, 1, 0.5}});
    PopUp pop_up;
    pop_up.state = on_route(route, flown, request.vehicle.speed_mps);
    const Vec3 centre = on_route(route, ahead, 1).position + radius / 2 * aside;
    pop_up.threat = Sphere{centre, radius};
    const auto shape = std::make_shared<kit::ShapeLayer>(std::vector<Shape>{pop_up.threat});
    const auto near = [&](const Vec3& p) { return shape->clearance(p) < room; };
    bool meets = false;
    for (std::size_t i = 0; i + 1 < route.size(); ++i) {
      meets = meets || shape->blocked(route[i], route[i + 1], request.vehicle.radius_m);
    }
    if (meets && !near(pop_up.state.position) && !near(request.goal.position)) {
      pop_up.change = {Change::Kind::add, "pop_up", shape->bounds()};
      pop_up.world = std::make_shared<const World>(
          request.world->with(Layer{"pop_up", "sphere", shape, true}));
      return pop_up;
    }
  }
}
}  // namespace altiplan::testing
