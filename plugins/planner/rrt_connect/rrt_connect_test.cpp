// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>

#include "bridges.hpp"
#include "support/support.hpp"

namespace altiplan::rrt_connect_test {
namespace {

using testing::counter;
using testing::make_planner;

constexpr const char* kStep = "{range_m: 12}";

Request among_balls(std::uint64_t seed, int count) {
  RandomStream random(seed);
  const Vec3 start(5, 5, 5);
  const Vec3 goal(95, 85, 35);
  std::vector<Shape> balls;
  while (int(balls.size()) < count) {
    const Vec3 at = random.in({{0, 0, 0}, {100, 90, 40}});
    if ((at - start).norm() > 16 && (at - goal).norm() > 16) {
      balls.emplace_back(Sphere{at, 12});
    }
  }
  Request request = testing::request_in(testing::world_of(std::move(balls)), start, goal,
                                        {{0, 0, 0}, {100, 90, 40}});
  request.limits.min_clearance = request.vehicle.radius_m = 1.5;
  request.random = RandomStream(seed);
  return request;
}

TEST(RrtConnect, AStraightWayIsFoundAtOnceInEqualLegs) {
  const Request request =
      testing::request_in(World(), {0, 0, 0}, {100, 0, 0}, {{-10, -10, -10}, {110, 10, 10}});
  const PlanResult result = make_planner("rrt_connect", "{range_m: 30}")->plan(request);
  ASSERT_EQ(result.route.size(), 5u);
  EXPECT_LE(counter(result, "expanded"), 4);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(result.route[i].x(), 25 * double(i), 1e-9);
  }
}

TEST(RrtConnect, FindsWaysAmongBallsInLegsOfTheRange) {
  int solved = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Request request = among_balls(seed, 25);
    const PlanResult result = make_planner("rrt_connect", kStep)->plan(request);
    solved += result.status == PlanStatus::solved;
    if (result.status == PlanStatus::solved) {
      EXPECT_TRUE(check(result.route, request).ok());
      for (std::size_t i = 0; i + 1 < result.route.size(); ++i) {
        EXPECT_LE((result.route[i + 1] - result.route[i]).norm(), 12 * (1 + 1e-9));
      }
    }
  }
  EXPECT_GE(solved, 38);
}

/// Each leg of a route was checked in one direction; the whole route must be valid in the other.
TEST(RrtConnect, TurnsHoldAtBothEndsAndWhereTheTreesMeet) {
  int solved = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Request request = among_balls(seed, 8);
    request.limits.max_turn_space = radians(50);
    request.limits.max_climb = radians(30);
    request.limits.min_leg = 4;
    request.start.velocity = {10, 2, 0};
    if (seed % 4 == 1) {
      request.limits.min_turn_radius = 9;
    }
    const PlanResult result = make_planner("rrt_connect", kStep)->plan(request);
    if (result.status == PlanStatus::solved) {
      ++solved;
      const CheckResult judged = check(result.route, request);
      EXPECT_TRUE(judged.ok()) << judged.violations.front().message;
    }
  }
  EXPECT_GE(solved, 36);
}

/// Allows a leg after another only if both climb, both descend or both are level.
class NoPorpoising final : public Constraint {
  bool do_admits(const Motion& leg) const override {
    return !leg.before || (leg.from.z() > leg.before->z()) == (leg.to.z() > leg.from.z());
  }
};

TEST(RrtConnect, ConstraintsThatLookAtTwoLegsAreKept) {
  int solved = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Request request = among_balls(seed, 6);
    request.constraints.push_back({"no_porpoising", std::make_shared<NoPorpoising>()});
    const PlanResult result = make_planner("rrt_connect", kStep)->plan(request);
    if (result.status == PlanStatus::solved) {
      ++solved;
      EXPECT_TRUE(check(result.route, request).ok());
    }
  }
  EXPECT_GE(solved, 15);
}

TEST(RrtConnect, RoutesAreNoLongerThanAllowedAndEndWithinTheTolerance) {
  int solved = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Request request = among_balls(seed, 15);
    request.limits.max_route_length = 150;
    request.goal.tolerance_m = seed % 2 == 0 ? 10 : 0;
    const PlanResult result = make_planner("rrt_connect", kStep)->plan(request);
    if (result.status == PlanStatus::solved) {
      ++solved;
      EXPECT_TRUE(check(result.route, request).ok());
    }
  }
  EXPECT_GE(solved, 15);
}

/// A wall across x, 2 m thick, in a volume of 80 x 80 x 100 m, with one gap of 4 x 4 m.
std::vector<Shape> wall_with_gap(double x, double y, double z) {
  const auto box = [](const Vec3& min, const Vec3& max) { return Shape(BoxShape{{min, max}}); };
  return {box({x, 0, 0}, {x + 2, y, 100}), box({x, y + 4, 0}, {x + 2, 80, 100}),
          box({x, y, 0}, {x + 2, y + 4, z}), box({x, y, z + 4}, {x + 2, y + 4, 100})};
}

TEST(RrtConnect, FindsNarrowGapsInWalls) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    RandomStream random(seed);
    std::vector<Shape> walls;
    for (double x = 12; x < 70; x += 12) {
      const auto wall = wall_with_gap(x, random.uniform(0, 76), random.uniform(0, 96));
      walls.insert(walls.end(), wall.begin(), wall.end());
    }
    Request request = testing::request_in(testing::world_of(std::move(walls)), {5, 5, 5},
                                          {75, 75, 95}, {{0, 0, 0}, {80, 80, 100}});
    request.random = RandomStream(seed);
    const PlanResult result = make_planner("rrt_connect")->plan(request);
    ASSERT_EQ(result.status, PlanStatus::solved) << seed << ": " << result.message;
    EXPECT_TRUE(check(result.route, request).ok());
  }
}

TEST(RrtConnect, SeeksPassagesInWallsButNotInClutter) {
  const Box volume{{0, 0, 0}, {80, 80, 100}};
  const auto bridges = [&](std::vector<Shape> shapes) {
    const Request request =
        testing::request_in(testing::world_of(std::move(shapes)), {5, 5, 5}, {75, 75, 95}, volume);
    const kit::LegRules rules(request);
    return rrt_connect::find_bridges(volume, 15, 50'000, rules, RandomStream(1));
  };
  std::vector<Shape> walls = wall_with_gap(30, 30, 50);
  const std::vector<Shape> second = wall_with_gap(42, 50, 30);
  walls.insert(walls.end(), second.begin(), second.end());
  const auto in_walls = bridges(std::move(walls));
  ASSERT_TRUE(in_walls);
  EXPECT_FALSE(in_walls->empty());
  RandomStream random(1);
  std::vector<Shape> clutter;
  while (clutter.size() < 2'000) {
    const Vec3 corner = random.in(volume);
    clutter.emplace_back(BoxShape{{corner, corner + Vec3::Constant(5)}});
  }
  EXPECT_FALSE(bridges(std::move(clutter)));
}

TEST(RrtConnect, SaysWhatWasInTheWayAndNeverThatThereIsNoWay) {
  testing::Drawn sealed = testing::draw({"S....\n.....\n..###\n..#G#\n..###"});
  sealed.request.level_m = 0.5;
  const PlanResult shut =
      make_planner("rrt_connect", "{max_iterations: 500}")->plan(sealed.request);
  EXPECT_EQ(shut.status, PlanStatus::no_route);
  EXPECT_FALSE(shut.proved || shut.budget_hit);
  EXPECT_EQ(counter(shut, "expanded"), 500);
  EXPECT_NE(shut.message.find("m of the goal"), std::string::npos) << shut.message;
  EXPECT_NE(shut.message.find("refused by '"), std::string::npos) << shut.message;
  sealed.request.budget.max_iterations = 30;
  const PlanResult cut = make_planner("rrt_connect")->plan(sealed.request);
  EXPECT_EQ(cut.status, PlanStatus::timed_out);
  EXPECT_TRUE(cut.budget_hit);
}

TEST(RrtConnect, TheTraceHoldsATreeForEachSide) {
  struct Kept final : Trace {
    std::vector<TraceEvent> events;
    void add(const TraceEvent& event) override { events.push_back(event); }
  } trace;
  Request request = among_balls(3, 25);
  request.trace = &trace;
  const PlanResult result = make_planner("rrt_connect", kStep)->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved);
  EXPECT_EQ(std::int64_t(trace.events.size()), counter(result, "nodes"));
  std::set<std::int64_t> added;
  for (const TraceEvent& event : trace.events) {
    EXPECT_TRUE(added.insert(event.node).second);
    if (event.parent >= 0) {
      EXPECT_TRUE(added.contains(event.parent));
      EXPECT_EQ(event.parent % 2, event.node % 2);
    }
  }
}
}  // namespace
}  // namespace altiplan::rrt_connect_test
