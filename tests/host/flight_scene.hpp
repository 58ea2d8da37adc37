// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "host/flight/flight.hpp"
#include "support/support.hpp"

namespace altiplan::host {

inline Layer layer(const std::string& id, Shape shape, bool known = true) {
  return {id, "shape", std::make_shared<kit::ShapeLayer>(std::vector<Shape>{std::move(shape)}),
          known};
}
inline Cylinder post(double x, double y, double radius) { return {x, y, radius}; }

/// East along y = 15 km, 26 km at 30 m/s and at 500 m, one post beside the way.
struct FlightScene {
  FlightSetup setup;
  std::unique_ptr<LocalPlanner> apf = testing::make_local_planner("apf");

  FlightScene() {
    World known = World().with(layer("beside", post(9000, 13000, 500)));
    setup.truth = known;
    setup.request = testing::request_in(std::move(known), {2000, 15000, 500}, {28000, 15000, 500},
                                        {{0, 0, 0}, {30e3, 30e3, 4000}});
    setup.request.vehicle.radius_m = 2;
    setup.request.vehicle.speed_mps = 30;
    setup.request.vehicle.sensing_m = 4000;
    setup.request.limits.min_clearance = 2;
    setup.request.limits.max_climb = radians(15);
    setup.route_request = setup.request;
    setup.route = {{2000, 15000, 500}, {12000, 15000, 500}, {28000, 15000, 500}};
    setup.pilot = apf.get();
    setup.pilot_name = "apf";
  }
  void hide(Layer hidden) {
    hidden.known = false;
    setup.truth = setup.truth.with(std::move(hidden));
  }
  void hide_moving(const Vec3& meets_at, double at_s, const Vec3& velocity, double radius) {
    setup.truth = setup.truth.with_moving(
        {{"mover", Sphere{meets_at - velocity * at_s, radius}, velocity, 0, false}});
  }
  void follow_alone() {
    setup.pilot = nullptr;
    setup.pilot_name = "route";
  }
};

/// A sound flight with commands in turn.
inline void expect_flown(const FlightResult& result, std::size_t min_handovers) {
  EXPECT_EQ(result.status, RunStatus::solved) << result.message;
  EXPECT_TRUE(result.reached);
  EXPECT_TRUE(result.check.ok());
  EXPECT_EQ(result.collisions, 0);
  ASSERT_GE(result.handovers.size(), min_handovers);
  for (std::size_t i = 0; i < result.handovers.size(); ++i) {
    EXPECT_EQ(result.handovers[i].to, i % 2 == 0 ? "apf" : "route");
    EXPECT_FALSE(result.handovers[i].why.empty());
  }
}
}  // namespace altiplan::host
