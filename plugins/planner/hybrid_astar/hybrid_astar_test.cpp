// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/check.hpp"
#include "altiplan/kit/dubins/dubins.hpp"
#include "altiplan/shape.hpp"
#include "support/support.hpp"

namespace altiplan {
namespace {

using testing::counter;
using testing::make_planner;

constexpr double kRadius = 80;
const Box kVolume{{-2000, -2000, 0}, {2000, 2000, 400}};

/// A wing between two poses.
Request between(const Pose& from, const Pose& to, World world = {}) {
  Request request = testing::request_in(std::move(world), from.position, to.position, kVolume);
  request.vehicle.wing = Wing{20, std::atan(400 / (9.80665 * kRadius)), radians(8), radians(10)};
  request.vehicle.speed_mps = 20;
  request.vehicle.radius_m = 5;
  apply_constraints(request, {}, AppliesTo::route);
  request.start.velocity = 20 * unit_heading(from.heading);
  request.goal.heading = to.heading;
  return request;
}

World random_towers(RandomStream& random, int count) {
  std::vector<Shape> towers;
  while (int(towers.size()) < count) {
    const Vec3 p = random.in({{-1500, -1500, 0}, {1500, 1500, 0}});
    towers.push_back(Cylinder{p.x(), p.y(), random.uniform(30, 200), 0, random.uniform(100, 600)});
  }
  return testing::world_of(towers);
}

TEST(HybridAstar, InTheOpenItIsTheDubinsPath) {
  RandomStream random(5);
  for (int n = 0; n < 50; ++n) {
    const Pose from{random.in({{-1000, -1000, 200}, {1000, 1000, 200}}), random.uniform(-kPi, kPi)};
    const Pose to{random.in({{-1000, -1000, 200}, {1000, 1000, 200}}), random.uniform(-kPi, kPi)};
    Request request = between(from, to);
    const PlanResult result = make_planner("hybrid_astar")->plan(request);
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    EXPECT_TRUE(check(result.route, request).ok());
    EXPECT_NEAR(length(result.route), kit::dubins_length(from, to, kRadius), 1e-3) << n;
  }
}

TEST(HybridAstar, RoutesAmongTowersAreValidInCalmAndWind) {
  RandomStream random(6);
  int solved = 0;
  int turning = 0;
  int possible = 0;
  constexpr int kCount = 40;
  for (int n = 0; n < kCount; ++n) {
    const Box ends{{-1800, -1800, 50}, {1800, 1800, 350}};
    const Pose from{random.in(ends), random.uniform(-kPi, kPi)};
    const Pose to{random.in(ends), random.uniform(-kPi, kPi)};
    Request request = between(from, to, random_towers(random, 40));
    if (n % 2 == 1) {
      request.wind.layers = {{-kInfinity, 8 * unit_heading(random.uniform(-kPi, kPi))}};
      request.start.velocity = request.ground_velocity(from);
    }
    request.budget.max_iterations = 20'000;
    const PlanResult result = make_planner("hybrid_astar")->plan(request);
    possible += result.status != PlanStatus::invalid_problem;
    if (result.status == PlanStatus::solved) {
      ++solved;
      turning += !result.route.is_straight();
      const CheckResult judged = check(result.route, request);
      ASSERT_TRUE(judged.ok()) << n << ": " << judged.violations.front().message;
    }
  }
  EXPECT_GT(possible, kCount / 2);
  EXPECT_GE(solved, possible * 8 / 10);
  EXPECT_EQ(turning, solved);
}

TEST(HybridAstar, LeavesAndJoinsLoiterCirclesTangentially) {
  RandomStream random(11);
  int solved = 0;
  int possible = 0;
  for (int n = 0; n < 30; ++n) {
    Request request =
        between({random.in({{-1800, -1800, 100}, {-1000, 1800, 300}}), 0},
                {random.in({{1000, -1800, 100}, {1800, 1800, 300}}), 0}, random_towers(random, 30));
    request.start.velocity.setZero();
    request.goal.heading.reset();
    const double wind = n % 3 == 0 ? 0 : 5;
    if (wind > 0) {
      request.wind.layers = {{-kInfinity, wind * unit_heading(random.uniform(-kPi, kPi))}};
    }
    const double radius = kRadius * (1 + wind / 20) * (1 + wind / 20);
    request.start.loiter = Loiter{radius, random.integer(0, 1) == 0 ? 1 : -1};
    request.goal.loiter = Loiter{radius * random.uniform(1, 2), random.integer(0, 1) == 0 ? 1 : -1};
    request.budget.max_iterations = 20'000;
    const PlanResult result = make_planner("hybrid_astar")->plan(request);
    possible += result.status != PlanStatus::invalid_problem;
    if (result.status == PlanStatus::solved) {
      ++solved;
      const CheckResult judged = check(result.route, request);
      ASSERT_TRUE(judged.ok()) << n << ": " << judged.violations.front().message;
    }
  }
  EXPECT_GT(possible, 5);
  EXPECT_GE(solved, possible * 8 / 10);
}

TEST(HybridAstar, BetweenLoiterCirclesInTheOpenItIsNoLongerThanTheTangent) {
  Request request = between({{-1000, 0, 200}, 0}, {{1000, 0, 200}, 0});
  request.start.velocity.setZero();
  request.goal.heading.reset();
  request.start.loiter = request.goal.loiter = Loiter{100, 1};
  const PlanResult result = make_planner("hybrid_astar")->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  // Leaving the circle where it is nearest to the goal is shorter than their common tangent.
  EXPECT_LT(length(result.route), 2000);
  EXPECT_GT(length(result.route), 1800);
  EXPECT_TRUE(check(result.route, request).ok());
}

TEST(HybridAstar, ClimbsInCirclesWhereThereIsNoRoom) {
  const Pose from{{0, 0, 10}, 0};
  const Pose to{{300, 0, 390}, 0};
  const Request request = between(from, to);
  const PlanResult result = make_planner("hybrid_astar")->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_GE(length(result.route), 380 / std::sin(radians(8)) * (1 - 1e-9));
}

TEST(HybridAstar, ReportsAWindThatItCannotFlyIn) {
  Request request = between({{0, 0, 100}, 0}, {{500, 0, 100}, 0});
  request.wind.layers = {{-kInfinity, {-21, 0, 0}}};
  const PlanResult result = make_planner("hybrid_astar")->plan(request);
  EXPECT_EQ(result.status, PlanStatus::no_route);
  EXPECT_NE(result.message.find("wind"), std::string::npos);
}

TEST(HybridAstar, EqualRequestsGiveEqualRoutes) {
  RandomStream random(9);
  Request request =
      between({{-1500, -1500, 100}, 0}, {{1500, 1500, 200}, 1}, random_towers(random, 30));
  request.budget.max_iterations = 5000;
  const auto planner = make_planner("hybrid_astar");
  EXPECT_EQ(planner->plan(request).route, planner->plan(request).route);
}
}  // namespace
}  // namespace altiplan
