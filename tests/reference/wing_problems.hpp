// SPDX-License-Identifier: Apache-2.0
// Problems of an aeroplane between two poses, and what planners that steer it are held to.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/kit/dubins/dubins.hpp"
#include "altiplan/shape.hpp"
#include "support/support.hpp"

namespace altiplan::testing {

inline constexpr double kTurnRadius = 80;

/// A wing between two poses, in 4 km by 4 km.
inline Request between(const Pose& from, const Pose& to, World world = {}) {
  Request request = request_in(std::move(world), from.position, to.position,
                               {{-2000, -2000, 0}, {2000, 2000, 400}});
  request.vehicle.wing =
      Wing{20, std::atan(400 / (9.80665 * kTurnRadius)), radians(8), radians(10)};
  request.vehicle.speed_mps = 20;
  request.vehicle.radius_m = 5;
  apply_constraints(request, {}, AppliesTo::route);
  request.start.velocity = 20 * unit_heading(from.heading);
  request.goal.heading = to.heading;
  return request;
}

inline World random_towers(RandomStream& random, int count) {
  std::vector<Shape> towers;
  while (int(towers.size()) < count) {
    const Vec3 p = random.in({{-1500, -1500, 0}, {1500, 1500, 0}});
    towers.push_back(Cylinder{p.x(), p.y(), random.uniform(30, 200), 0, random.uniform(100, 600)});
  }
  return world_of(towers);
}

/// Between random poses among towers, every second time in wind.
inline Request among_towers(RandomStream& random, int n) {
  const Box ends{{-1800, -1800, 50}, {1800, 1800, 350}};
  const Pose from{random.in(ends), random.uniform(-kPi, kPi)};
  const Pose to{random.in(ends), random.uniform(-kPi, kPi)};
  Request request = between(from, to, random_towers(random, 40));
  if (n % 2 == 1) {
    request.wind.layers = {{-kInfinity, 8 * unit_heading(random.uniform(-kPi, kPi))}};
    request.start.velocity = request.ground_velocity(from);
  }
  return request;
}

inline void expect_the_dubins_path_in_the_open(const std::string& planner) {
  RandomStream random(5);
  const Box level{{-1000, -1000, 200}, {1000, 1000, 200}};
  for (int n = 0; n < 50; ++n) {
    const Pose from{random.in(level), random.uniform(-kPi, kPi)};
    const Pose to{random.in(level), random.uniform(-kPi, kPi)};
    const Request request = between(from, to);
    const PlanResult result = make_planner(planner)->plan(request);
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    EXPECT_TRUE(check(result.route, request).ok());
    EXPECT_NEAR(length(result.route), kit::dubins_length(from, to, kTurnRadius), 1e-3) << n;
  }
}

/// Every route is valid, and at least that share of the `count` problems with free ends is solved.
inline void expect_valid_routes_among_towers(const std::string& planner, const std::string& yaml,
                                             double share, std::uint64_t iterations,
                                             int count = 10) {
  RandomStream random(6);
  int solved = 0;
  int turning = 0;
  int possible = 0;
  for (int n = 0; n < count; ++n) {
    Request request = among_towers(random, n);
    request.budget.max_iterations = iterations;
    const PlanResult result = make_planner(planner, yaml)->plan(request);
    possible += result.status != PlanStatus::invalid_problem;
    if (result.status == PlanStatus::solved) {
      ++solved;
      turning += !result.route.is_straight();
      const CheckResult judged = check(result.route, request);
      ASSERT_TRUE(judged.ok()) << n << ": " << judged.violations.front().message;
    }
  }
  EXPECT_GT(possible, count / 2);
  EXPECT_GE(solved, possible * share);
  EXPECT_EQ(turning, solved);
}

/// The same with a border of layers of wind or two between the ends.
inline Request in_layers(RandomStream& random, int n) {
  Request request = among_towers(random, 0);
  request.start.position.z() = random.uniform(50, 120);
  request.goal.position.z() = random.uniform(280, 350);
  const auto wind = [&] {
    return Vec3(random.uniform(1, 9) * unit_heading(random.uniform(-3, 3)));
  };
  request.wind.layers = {{n % 3 == 0 ? 200 : -kInfinity, wind()}, {250, wind()}};
  if (n % 2 == 1) {
    std::swap(request.start.position.z(), request.goal.position.z());
  }
  request.start.velocity =
      request.ground_velocity({request.start.position, random.uniform(-kPi, kPi)});
  return request;
}

/// The greatest corner over the ground between legs that are no rounding; of such none is expected.
inline double greatest_corner(const Route& route) {
  double greatest = 0;
  std::optional<Vec3> arrives;
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Leg leg = route.leg(i);
    EXPECT_GT(leg.length(), 5e-7) << "leg " << i;
    if (leg.length() > 1e-6) {
      greatest = arrives ? std::max(greatest, turn_angle_horizontal(*arrives, leg.rate(0))) : 0;
      arrives = leg.rate(1);
    }
  }
  return greatest;
}

/// No route has a corner where layers of wind meet, and at least a third of `count` are found.
inline void expect_no_corners_in_layers(const std::string& planner, const std::string& yaml,
                                        std::uint64_t iterations, int count = 6) {
  RandomStream random(17);
  int solved = 0;
  for (int n = 0; n < count; ++n) {
    Request request = in_layers(random, n);
    request.budget.max_iterations = iterations;
    const PlanResult result = make_planner(planner, yaml)->plan(request);
    if (result.status == PlanStatus::solved) {
      ++solved;
      EXPECT_LT(greatest_corner(result.route), 1e-6) << n;
      const CheckResult judged = check(result.route, request);
      EXPECT_TRUE(judged.ok()) << n << ": " << judged.violations.front().message;
      const Route shorter = make_smoother("shortcut")->smooth(result.route, request).route;
      EXPECT_LT(greatest_corner(shorter), 1e-6) << n;
    }
  }
  EXPECT_GE(solved, count / 3);
}

/// The `count` routes among towers between loiter circles are valid, and that share of them is
/// found.
inline void expect_loiter_circles_left_and_joined(const std::string& planner, double share,
                                                  std::uint64_t iterations, int count = 10) {
  RandomStream random(11);
  int solved = 0;
  int possible = 0;
  for (int n = 0; n < count; ++n) {
    Request request =
        between({random.in({{-1800, -1800, 100}, {-1000, 1800, 300}}), 0},
                {random.in({{1000, -1800, 100}, {1800, 1800, 300}}), 0}, random_towers(random, 30));
    request.start.velocity.setZero();
    request.goal.heading.reset();
    const double wind = n % 3 == 0 ? 0 : 5;
    if (wind > 0) {
      request.wind.layers = {{-kInfinity, wind * unit_heading(random.uniform(-kPi, kPi))}};
    }
    const double radius = kTurnRadius * (1 + wind / 20) * (1 + wind / 20);
    request.start.loiter = Loiter{radius, random.integer(0, 1) == 0 ? 1 : -1};
    request.goal.loiter = Loiter{radius * random.uniform(1, 2), random.integer(0, 1) == 0 ? 1 : -1};
    request.budget.max_iterations = iterations;
    const PlanResult result = make_planner(planner)->plan(request);
    possible += result.status != PlanStatus::invalid_problem;
    if (result.status == PlanStatus::solved) {
      ++solved;
      const CheckResult judged = check(result.route, request);
      ASSERT_TRUE(judged.ok()) << n << ": " << judged.violations.front().message;
    }
  }
  EXPECT_GT(possible, count / 6);
  EXPECT_GE(solved, possible * share);
}

inline void expect_the_shortest_between_loiter_circles(const std::string& planner) {
  Request request = between({{-1000, 0, 200}, 0}, {{1000, 0, 200}, 0});
  request.start.velocity.setZero();
  request.goal.heading.reset();
  request.start.loiter = request.goal.loiter = Loiter{100, 1};
  const PlanResult result = make_planner(planner)->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  // Leaving the circle where it is nearest to the goal is shorter than their common tangent.
  EXPECT_LT(length(result.route), 2000);
  EXPECT_GT(length(result.route), 1800);
  EXPECT_TRUE(check(result.route, request).ok());
}

inline void expect_a_wind_too_strong_reported(const std::string& planner) {
  Request request = between({{0, 0, 100}, 0}, {{500, 0, 100}, 0});
  request.wind.layers = {{-kInfinity, {-21, 0, 0}}};
  const PlanResult result = make_planner(planner)->plan(request);
  EXPECT_EQ(result.status, PlanStatus::no_route);
  EXPECT_NE(result.message.find("wind"), std::string::npos);
}
}  // namespace altiplan::testing
