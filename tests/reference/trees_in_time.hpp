// SPDX-License-Identifier: Apache-2.0
// What planners that grow trees are held to among moving obstacles that are known beforehand.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/support.hpp"

namespace altiplan::testing {

/// Balls that cross the straight way from the start to the goal as the vehicle would pass there.
inline Request among_crossing_balls(std::uint64_t seed) {
  constexpr double kSpeed = 10;
  const Vec3 start(10, 100, 50);
  const Vec3 goal(190, 100, 50);
  RandomStream draw = RandomStream(seed).sub("balls");
  std::vector<MovingObstacle> balls;
  for (int i = 0; i < 12; ++i) {
    const double share = draw.uniform(0.15, 0.9);
    const double heading = draw.uniform(0, 2 * kPi);
    const Vec3 velocity =
        draw.uniform(2, 15) * Vec3(std::cos(heading), std::sin(heading), draw.uniform(-0.3, 0.3));
    const double passed_s = share * (goal - start).norm() / kSpeed;
    const Vec3 beside(0, draw.uniform(-25, 25), draw.uniform(-10, 10));
    const Vec3 at_0 = start + share * (goal - start) + beside - passed_s * velocity;
    balls.push_back(
        {"ball_" + std::to_string(i), Sphere{at_0, draw.uniform(5, 15)}, velocity, 0, true, true});
  }
  Request request =
      request_in(World().with_moving(std::move(balls)), start, goal, {{0, 0, 0}, {200, 200, 100}});
  request.vehicle.speed_mps = kSpeed;
  request.vehicle.radius_m = 1;
  request.random = RandomStream(seed);
  return request;
}

/// Every route meets no ball at its times, though the straight way meets some in most of the
/// worlds.
inline void expect_routes_in_time(const std::string& planner, const std::string& parameters) {
  const auto tree = make_planner(planner, parameters);
  int found = 0;
  int crossed = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Request request = among_crossing_balls(seed);
    const Vec3& start = request.start.position;
    if (meets_moving(Leg::straight(start, start), 0, request) != nullptr) {
      continue;
    }
    const PlanResult plan = tree->plan(request);
    if (plan.status != PlanStatus::solved) {
      continue;
    }
    const CheckResult judged = check(plan.route, request);
    EXPECT_TRUE(judged.ok()) << planner << " " << seed << ": " << judged.violations.front().message;
    ++found;
    crossed += meets_moving(Leg::straight(start, request.goal.position), 0, request) != nullptr;
  }
  EXPECT_GE(found, 36) << planner;
  EXPECT_GE(crossed, 30) << planner;
}
}  // namespace altiplan::testing
