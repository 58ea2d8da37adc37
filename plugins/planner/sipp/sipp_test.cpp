// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/measures.hpp"
#include "reference/timed_reach.hpp"
#include "support/support.hpp"

namespace altiplan {
namespace {

constexpr double kCell = 10;
const Cell kCounts = {5, 5, 2};

/// A small world of cells with blocks and moving balls; start and goal are centres of cells.
struct SmallWorld {
  Request request;
  Cell start{0, 0, 0};
  Cell goal{4, 4, 1};
};

SmallWorld small_world(std::uint64_t seed) {
  RandomStream draw = RandomStream(seed).sub("sipp");
  SmallWorld world;
  std::vector<Shape> blocks;
  for (int i = 0; i < 3; ++i) {
    const Vec3 at(std::floor(draw.uniform(0, 5)), std::floor(draw.uniform(0, 5)), 0);
    if (at.head<2>() != Vec3(0, 0, 0).head<2>() && at.head<2>() != Vec3(4, 4, 0).head<2>()) {
      blocks.push_back(BoxShape{{kCell * at, kCell * (at + Vec3(1, 1, 2))}});
    }
  }
  std::vector<MovingObstacle> movers;
  const int count = 1 + int(draw.uniform(0, 24));
  for (int i = 0; i < count; ++i) {
    // Each passes through the box in the first 20 seconds, so that waiting may help.
    const Vec3 through = draw.in({{0, 0, 0}, {50, 50, 20}});
    const double heading = draw.uniform(0, 2 * kPi);
    const double speed = draw.uniform(1, 12);
    const Vec3 velocity = speed * Vec3(std::cos(heading), std::sin(heading), draw.uniform(-.3, .3));
    const Vec3 at_0 = through - draw.uniform(0, 20) * velocity;
    movers.push_back(
        {"m" + std::to_string(i), Sphere{at_0, draw.uniform(2, 9)}, velocity, 0, true, true});
  }
  World empty = blocks.empty() ? World() : testing::world_of(std::move(blocks));
  world.request = testing::request_in(empty.with_moving(std::move(movers)), {5, 5, 5}, {45, 45, 15},
                                      {{0, 0, 0}, {50, 50, 20}});
  world.request.vehicle.speed_mps = 5;
  if (seed % 2 == 0) {
    world.request.vehicle.climb_mps = 2;
    world.request.vehicle.sink_mps = 3;
  }
  world.request.limits.min_clearance = world.request.vehicle.radius_m = 1;
  return world;
}

struct Seen {
  int found = 0;
  int waits = 0;
  int later = 0;  ///< than with nothing moving
};

Seen compare(std::uint64_t first, std::uint64_t last) {
  const auto sipp = testing::make_planner("sipp", "{cell_m: [10, 10, 10]}");
  Seen seen;
  for (std::uint64_t seed = first; seed < last; ++seed) {
    const SmallWorld world = small_world(seed);
    const Request& request = world.request;
    if (meets_moving(Leg::straight({5, 5, 5}, {5, 5, 5}), 0, request) != nullptr) {
      EXPECT_EQ(sipp->plan(request).status, PlanStatus::invalid_problem) << seed;
      continue;
    }
    reference::TimedReach reach(request, kCounts, {5, 5, 5}, kCell, 200);
    const auto earliest = reach.earliest(world.start, world.goal);
    const PlanResult plan = sipp->plan(request);
    EXPECT_EQ(plan.status == PlanStatus::solved, earliest.has_value()) << seed << plan.message;
    if (plan.status != PlanStatus::solved || !earliest) {
      continue;
    }
    const CheckResult judged = check(plan.route, request);
    EXPECT_TRUE(judged.ok()) << seed << ": " << judged.violations.front().message;
    EXPECT_NEAR(*measure(plan.route, request).duration_s, *earliest, 1e-6) << seed;
    ++seen.found;
    seen.waits += plan.route.waits();
    Request still = request;
    still.world = std::make_shared<World>(request.world->with_moving({}));
    seen.later += *measure(sipp->plan(still).route, still).duration_s < *earliest - 1e-6;
  }
  return seen;
}

TEST(Sipp, ArrivesAsEarlyAsAnExhaustiveSearchInSpaceAndTime) {
  const Seen seen = compare(1, 41);
  EXPECT_GT(seen.found, 32);
  EXPECT_GT(seen.waits, 4);
  EXPECT_GT(seen.later, 8);
}

TEST(NightlySipp, ArrivesAsEarlyAsAnExhaustiveSearchInSpaceAndTime) {
  EXPECT_GT(compare(1001, 2001).found, 800);
}

/// A corridor of cells along x, which a ball of the corridor's width passes against the vehicle.
Request corridor(const Vec3& velocity) {
  const Box volume{{0, 0, 0}, {100, 10, 10}};
  const MovingObstacle ball{"train", Sphere{{55, 5, 5}, 6}, velocity, 0, true, true};
  Request request = testing::request_in(World().with_moving({ball}), {5, 5, 5}, {95, 5, 5}, volume);
  request.vehicle.speed_mps = 5;
  return request;
}

TEST(Sipp, WaitsUntilAnObstacleHasCrossed) {
  const Request request = corridor({0, 0.3, 0});
  const PlanResult plan = testing::make_planner("sipp", "{cell_m: [10, 10, 10]}")->plan(request);
  ASSERT_EQ(plan.status, PlanStatus::solved) << plan.message;
  EXPECT_TRUE(check(plan.route, request).ok());
  EXPECT_FALSE(check({plan.route.front(), plan.route.back()}, request).ok());
  // It waits at x = 45, 10 m before the ball's centre line, and leaves at t so that the line of its
  // flight relative to the ball, along (5, -0.3), is tangential to the ball of 6 m.
  const double leaves = (6 * std::hypot(5, 0.3) - 3) / 1.5;
  EXPECT_TRUE(plan.route.waits());
  EXPECT_NEAR(*measure(plan.route, request).duration_s, leaves + 10, 1e-9);
}

TEST(Sipp, ProvesThatNothingPassesAnObstacleThatFillsTheCorridor) {
  const PlanResult plan =
      testing::make_planner("sipp", "{cell_m: [10, 10, 10]}")->plan(corridor({0, 0, 0}));
  EXPECT_EQ(plan.status, PlanStatus::no_route);
  EXPECT_TRUE(plan.proved);
}

TEST(Sipp, BeginsAtTheTimeOfTheStart) {
  Request request = corridor({-5, 0, 0});  // comes against the vehicle: there is no room beside it
  const auto sipp = testing::make_planner("sipp", "{cell_m: [10, 10, 10]}");
  EXPECT_EQ(sipp->plan(request).status, PlanStatus::no_route);
  request.start.time_s = 20;  // it has left
  const PlanResult plan = sipp->plan(request);
  ASSERT_EQ(plan.status, PlanStatus::solved) << plan.message;
  EXPECT_TRUE(check(plan.route, request).ok());
}

TEST(Sipp, SaysWhatItDoesNotPlan) {
  const auto sipp = testing::make_planner("sipp", "{cell_m: [10, 10, 10]}");
  const auto refusal = [&](const auto& change) {
    Request request = corridor({0, 1, 0});
    change(request);
    const PlanResult plan = sipp->plan(request);
    EXPECT_EQ(plan.status, PlanStatus::invalid_problem);
    return plan.message;
  };
  EXPECT_NE(refusal([](Request& r) { r.vehicle.wing = Wing{}; }).find("aeroplane"),
            std::string::npos);
  EXPECT_NE(refusal([](Request& r) {
              r.wind.layers = {{-kInfinity, {1, 0, 0}}};
            }).find("still air"),
            std::string::npos);
  EXPECT_NE(refusal([](Request& r) {
              r.vehicle.speed_near = {{5, 1}};
            }).find("one speed"),
            std::string::npos);
  EXPECT_NE(refusal([](Request& r) { r.limits.max_turn_horizontal = 1; }).find("limits on turns"),
            std::string::npos);
  EXPECT_NE(refusal([](Request& r) { r.limits.max_route_length = 99; }).find("route's length"),
            std::string::npos);
  EXPECT_NE(refusal([](Request& r) {
              r.world = std::make_shared<World>(World().with_moving(
                  {{"cart", BoxShape{{{50, 0, 0}, {60, 10, 10}}}, {0, 1, 0}, 0, true, true}}));
            }).find("'cart'"),
            std::string::npos);
  EXPECT_NE(refusal([](Request& r) {
              r.world = std::make_shared<World>(
                  World().with_moving({{"lid", Sphere{{5, 5, 5}, 3}, {0, 1, 0}, 0, true, true}}));
            }).find("'lid'"),
            std::string::npos);
}

/// 200 balls of 90 m over 100 × 100 × 20 cells, which leave few ways through.
TEST(Sipp, PlansAmong200MovingObstacles) {
  RandomStream draw = RandomStream(3).sub("many");
  const Box volume{{0, 0, 0}, {1000, 1000, 200}};
  const Vec3 start(5, 5, 5);
  std::vector<MovingObstacle> movers;
  while (movers.size() < 200) {
    const double heading = draw.uniform(0, 2 * kPi);
    const Vec3 at = draw.in(volume);
    if ((at - start).norm() > 100) {
      movers.push_back({"m" + std::to_string(movers.size()), Sphere{at, 90},
                        8 * Vec3(std::cos(heading), std::sin(heading), 0), 0, true, true});
    }
  }
  Request request =
      testing::request_in(World().with_moving(std::move(movers)), start, {995, 995, 195}, volume);
  request.vehicle.speed_mps = 10;
  request.limits.min_clearance = request.vehicle.radius_m = 1;
  const PlanResult plan = testing::make_planner("sipp", "{cell_m: [10, 10, 10]}")->plan(request);
  ASSERT_EQ(plan.status, PlanStatus::solved) << plan.message;
  EXPECT_TRUE(check(plan.route, request).ok());
  EXPECT_EQ(testing::counter(plan, "lattice_cells"), 200000);
  EXPECT_LT(testing::counter(plan, "expanded"), 50000);
}
}  // namespace
}  // namespace altiplan
