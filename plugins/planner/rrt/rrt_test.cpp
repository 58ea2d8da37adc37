// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <optional>

#include "reference/trees_in_time.hpp"
#include "support/support.hpp"

namespace altiplan::rrt_test {
namespace {

using testing::make_planner;

/// The nodes that a plan adds to its tree.
struct Grown : Trace {
  void add(const TraceEvent& event) override {
    if (event.kind == TraceEvent::Kind::added) {
      nodes.push_back(event);
    }
  }
  std::vector<TraceEvent> nodes;
};

/// Balls around the direct path; the goal lies behind a shell of them unless it is reachable.
Request among_balls(std::uint64_t seed, bool reachable) {
  SplitMix64 random(seed);
  std::vector<Shape> balls;
  for (int i = 0; i < 25; ++i) {
    const double x = 30 + 140 * random.uniform();
    const double y = 200 * random.uniform();
    balls.emplace_back(Sphere{{x, y, 100 * random.uniform()}, 15});
  }
  if (!reachable) {
    balls.emplace_back(Sphere{{170, 100, 50}, 5});
    for (const Vec3& side : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
      balls.emplace_back(Sphere{Vec3(190, 100, 50) + 14 * side, 12});
      balls.emplace_back(Sphere{Vec3(190, 100, 50) - 14 * side, 12});
    }
  }
  Request request = testing::request_in(testing::world_of(std::move(balls)), {5, 100, 50},
                                        {190, 100, 50}, {{0, 0, 0}, {200, 200, 100}});
  request.random = RandomStream(seed);
  return request;
}

/// The paper's loop examining every node: eqs. (2) to (5) and the readings of its README.
struct PlainTree {
  const Request& request;
  double step, w_random, w_goal, random_share;
  bool goal_once;
  std::size_t max_failures;
  std::vector<Vec3> points = {};
  std::vector<std::int64_t> parents = {};
  std::vector<bool> toward_goal = {};
  std::vector<std::size_t> failures = {};
  std::vector<bool> rests = {};

  void add(const Vec3& p, std::int64_t parent) {
    points.push_back(p);
    parents.push_back(parent);
    toward_goal.push_back(false);
    failures.push_back(0);
    rests.push_back(false);
  }
  std::size_t choose(const Vec3& sample) const {
    std::optional<std::size_t> best;
    const auto cost = [&](std::size_t i) {
      return w_goal == 0 ? (points[i] - sample).squaredNorm()
                         : w_random * (points[i] - sample).norm() +
                               w_goal * (points[i] - request.goal.position).norm();
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!rests[i] && (!best || cost(i) < cost(*best))) {
        best = i;
      }
    }
    return *best;
  }
  void grow(int iterations) {
    RandomStream random = request.random.sub("growth");
    add(request.start.position, -1);
    for (int i = 0; i < iterations; ++i) {
      const Vec3 sample = random.in(request.volume);
      const std::size_t near = choose(sample);
      const bool to_goal = !(random.uniform() < random_share) && !(goal_once && toward_goal[near]);
      toward_goal[near] = toward_goal[near] || to_goal;
      const Vec3 way = (to_goal ? request.goal.position : sample) - points[near];
      const Vec3 p = points[near] + step / way.norm() * way;
      std::optional<Vec3> before;
      if (near > 0) {
        before = points[std::size_t(parents[near])];
      }
      if (leg_ok(before, points[near], p, request)) {
        add(p, std::int64_t(near));
      } else if (max_failures > 0 && ++failures[near] >= max_failures) {
        rests[near] = true;
        ASSERT_NE(std::count(rests.begin(), rests.end(), false), 0) << "too small a world";
      }
    }
  }
};

void expect_plain_tree(const std::string& parameters, double w_goal, double random_share,
                       bool goal_once, std::size_t max_failures) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Request request = among_balls(seed, false);
    request.limits.max_turn_horizontal = radians(60);
    constexpr int kIterations = 3000;
    PlainTree plain{request, 4, 1, w_goal, random_share, goal_once, max_failures};
    plain.grow(kIterations);
    Grown grown;
    request.trace = &grown;
    request.budget.max_iterations = kIterations;
    const PlanResult result = make_planner("rrt", parameters)->plan(request);
    EXPECT_EQ(result.status, PlanStatus::timed_out) << result.message;
    ASSERT_EQ(grown.nodes.size(), plain.points.size());
    EXPECT_GT(plain.points.size(), 300u);
    for (std::size_t i = 0; i < plain.points.size(); ++i) {
      ASSERT_EQ(grown.nodes[i].position, plain.points[i]) << i;
      ASSERT_EQ(grown.nodes[i].parent, plain.parents[i]) << i;
    }
  }
}

TEST(Rrt, TheBasicTreeIsThatOfALookAtEveryNode) {
  expect_plain_tree(
      "{step_m: 4, weight_goal: 0, random_share: 1, toward_goal_once: false, max_failures: 0}", 0,
      1, false, 0);
}

TEST(Rrt, TheImprovedTreeIsThatOfALookAtEveryNode) {
  expect_plain_tree("{step_m: 4, max_failures: 2000}", 1, 0.5, true, 2000);
}

TEST(Rrt, RoutesKeepTheFlightConstraints) {
  int solved = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Request request = among_balls(seed, true);
    request.limits.max_turn_horizontal = radians(45);
    request.limits.max_climb = radians(30);
    request.limits.min_leg = 5;
    request.limits.min_clearance = request.vehicle.radius_m = 1;
    if (seed % 2 == 0) {
      request.level_m = 50;
    }
    if (seed % 3 == 0) {
      request.start.velocity = {0, 10, 0};
    }
    if (seed % 5 == 0) {
      request.limits.max_route_length = 300;
    }
    const PlanResult result =
        make_planner("rrt", "{step_m: 5, max_iterations: 5000}")->plan(request);
    if (result.status == PlanStatus::solved) {
      ++solved;
      EXPECT_TRUE(check(result.route, request).ok())
          << check(result.route, request).violations[0].message;
    }
  }
  EXPECT_GT(solved, 30);
}

TEST(Rrt, WithoutARouteItSaysHowNearItCame) {
  Request request = among_balls(1, false);
  const PlanResult result = make_planner("rrt", "{step_m: 4, max_iterations: 3000}")->plan(request);
  EXPECT_EQ(result.status, PlanStatus::no_route);
  EXPECT_FALSE(result.proved);
  EXPECT_NE(result.message.find("m from the goal; on the next leg"), std::string::npos)
      << result.message;

  // A constraint on the whole route prevents it.
  request = testing::request_in(testing::world_of(std::vector<Shape>{Sphere{{50, 50, 50}, 5}}),
                                {5, 50, 50}, {95, 50, 50}, {{0, 0, 0}, {100, 100, 100}});
  request.limits.max_route_length = 80;
  const PlanResult longer = make_planner("rrt", "{max_iterations: 3000}")->plan(request);
  EXPECT_EQ(longer.status, PlanStatus::no_route);
  EXPECT_NE(longer.message.find("refused: the route's length is"), std::string::npos)
      << longer.message;
}

TEST(Rrt, KeepsOffMovingObstaclesInTime) {
  testing::expect_routes_in_time("rrt", "{max_iterations: 20000}");
}
}  // namespace
}  // namespace altiplan::rrt_test
