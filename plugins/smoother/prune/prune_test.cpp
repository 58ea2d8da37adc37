// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan::prune_test {
namespace {

using testing::make_smoother;

Request among_balls(SplitMix64& random, int count) {
  std::vector<Shape> shapes;
  for (int i = 0; i < count; ++i) {
    const Vec3 centre(random.uniform() * 100, random.uniform() * 100, random.uniform() * 100);
    shapes.push_back(Sphere{centre, 9});
  }
  Request request = testing::request_in(testing::world_of(std::move(shapes)), {0, 0, 0},
                                        {100, 100, 100}, {{0, 0, 0}, {100, 100, 100}});
  request.limits.min_clearance = request.vehicle.radius_m = 1;
  return request;
}

/// A valid route of random points; repeats until one is found.
Polyline random_route(SplitMix64& random, Request& request, std::size_t points) {
  Polyline route;
  for (int attempt = 0; attempt < 3000 && route.size() < points; ++attempt) {
    const Vec3 p(random.uniform() * 100, random.uniform() * 100, random.uniform() * 100);
    if (route.empty() ? point_problem(p, request).empty()
                      : leg_ok(approach(route, route.size() - 1, request.before_start()),
                               route.back(), p, request)) {
      route.push_back(p);
    }
  }
  request.start.position = route.front();
  request.goal.position = route.back();
  return route;
}

/// Fewest points, then shortest length, over all subsets that keep the ends and satisfy every
/// constraint.
std::pair<std::size_t, double> best_subset(const Polyline& route, const Request& request) {
  std::pair<std::size_t, double> best = {route.size() + 1, kInfinity};
  const unsigned inner = unsigned(route.size()) - 2;
  for (unsigned subset = 0; subset < 1U << inner; ++subset) {
    Polyline kept = {route.front()};
    for (unsigned i = 0; i < inner; ++i) {
      if ((subset >> i & 1) != 0) {
        kept.push_back(route[i + 1]);
      }
    }
    kept.push_back(route.back());
    const std::pair<std::size_t, double> size = {kept.size(), length(kept)};
    if (size < best && check(kept, request).ok()) {
      best = size;
    }
  }
  return best;
}

TEST(Prune, KeepsTheFewestOfAllSubsets) {
  SplitMix64 random(11);
  const auto prune = make_smoother("prune");
  int shorter = 0;
  for (int world = 0; world < 120; ++world) {
    Request request = among_balls(random, 12);
    if (world % 2 == 1) {
      request.limits.max_turn_space = radians(100);
      request.limits.max_climb = radians(60);
    }
    const Polyline route = random_route(random, request, 9);
    if (route.size() < 4 || !check(route, request).ok()) {
      continue;
    }
    const PlanResult result = prune->smooth(route, request);
    ASSERT_EQ(result.status, PlanStatus::solved);
    EXPECT_TRUE(check(result.route, request).ok());
    const auto [size, metres] = best_subset(route, request);
    EXPECT_EQ(result.route.size(), size);
    EXPECT_NEAR(length(result.route), metres, 1e-9 * metres);
    EXPECT_EQ(prune->smooth(result.route, request).route, result.route);
    shorter += result.route.size() < route.size();
  }
  EXPECT_GT(shorter, 60);
}

TEST(Prune, HoldsTheFirstLegToTheHeading) {
  Request request =
      testing::request_in(World(), {0, 0, 0}, {10, 10, 0}, {{-20, -20, -20}, {20, 20, 20}});
  request.limits.max_turn_horizontal = radians(65);
  request.start.velocity = {1, 0, 0};
  const Polyline route = {{0, 0, 0}, {5, 0, 0}, {10, 5, 0}, {10, 10, 0}};
  EXPECT_EQ(make_smoother("prune")->smooth(route, request).route.size(), 2u);
  request.start.velocity = {1, -1, 0};
  const Route kept = make_smoother("prune")->smooth(route, request).route;
  EXPECT_TRUE(check(kept, request).ok());
  EXPECT_EQ(kept.size(), 3u);
}

TEST(Prune, LeavesWhatIsUnsoundOrOutOfBudget) {
  SplitMix64 random(12);
  Request request = testing::request_in(testing::world_of({Shape{Sphere{{5, 0, 0}, 2}}}), {0, 0, 0},
                                        {10, 0, 0}, {{-20, -20, -20}, {20, 20, 20}});
  const Polyline through = {{0, 0, 0}, {1, 0, 0}, {9, 0, 0}, {10, 0, 0}};
  EXPECT_EQ(make_smoother("prune")->smooth(through, request).route, through);
  const Polyline around = {{0, 0, 0}, {1, 1, 0}, {5, 5, 0}, {9, 1, 0}, {10, 0, 0}};
  EXPECT_EQ(make_smoother("prune")->smooth(around, request).route.size(), 3u);
  request.budget.max_iterations = 0;
  const PlanResult result = make_smoother("prune")->smooth(around, request);
  EXPECT_EQ(result.route, around);
  EXPECT_TRUE(result.budget_hit);
}

TEST(Prune, RepeatedPointsGo) {
  const Request request =
      testing::request_in(World(), {0, 0, 0}, {1, 0, 0}, {{-9, -9, -9}, {9, 9, 9}});
  const Polyline route = {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(make_smoother("prune")->smooth(route, request).route.size(), 2u);
}
}  // namespace
}  // namespace altiplan::prune_test
