// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <set>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/random.hpp"
#include "support/posts.hpp"
#include "support/support.hpp"

namespace altiplan::testing::terrain_follow_test {
namespace {

constexpr double kSpacing = 20;
constexpr int kPosts = 16;

World ground(const std::function<double(double x, double y)>& height) {
  std::vector<float> all;
  for (int j = 0; j < kPosts; ++j) {
    for (int i = 0; i < kPosts; ++i) {
      all.push_back(float(height(i * kSpacing, j * kSpacing)));
    }
  }
  return world_of(std::make_shared<Posts>(
      HeightField({0, 0}, {kSpacing, kSpacing}, kPosts, kPosts, std::move(all))));
}

double ramp(double x, double) { return x > 100 ? std::min(x - 100, 60.0) : 0; }

Request over(World world, const Polyline& route, double low, double high) {
  Request request =
      request_in(std::move(world), route.front(), route.back(), {{0, 0, 0}, {300, 300, 400}});
  request.limits.altitude = {{AltitudeBand::Datum::ground, low, high}};
  return request;
}

PlanResult followed(const Polyline& route, const Request& request,
                    const std::string& yaml = "{station_m: 20, height_step_m: 1}") {
  return make_smoother("terrain_follow", yaml)->smooth(route, request);
}

Polyline above(const World& world, const Polyline& plan, double height) {
  Polyline route;
  for (const Vec3& p : plan) {
    route.emplace_back(p.x(), p.y(), *world.ground(p.x(), p.y()) + height);
  }
  return route;
}

TEST(TerrainFollow, OneLegWhereOneSuffices) {
  const World world = ground(ramp);
  const Polyline route = above(world, {{10, 50, 0}, {60, 50, 0}, {110, 50, 0}, {290, 50, 0}}, 40);
  const Request request = over(world, route, 10, 200);
  const PlanResult result = followed(route, request);
  EXPECT_EQ(result.route, (Polyline{route.front(), route.back()}));
  EXPECT_EQ(result.message,
            "2 waypoints for 4; climbs 60.0 m and sinks 0.0 m, before 60.0 and 0.0 m");
}

TEST(TerrainFollow, LaysATooHighRouteIntoTheBand) {
  const World world = ground(ramp);
  Polyline route = above(world, {{10, 50, 0}, {150, 50, 0}, {290, 50, 0}}, 40);
  route[1].z() = 300;
  const Request request = over(world, route, 30, 50);
  ASSERT_FALSE(check(route, request).ok());
  const PlanResult result = followed(route, request);
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_EQ(result.route.size(), 4U) << "level, up the ramp, level";
}

TEST(TerrainFollow, KeepsClimbAndSink) {
  const World world = ground(ramp);
  const Polyline route = above(world, {{10, 50, 0}, {60, 50, 0}, {290, 50, 0}}, 40);
  Request request = over(world, route, 20, 100);
  request.limits.max_climb = radians(20);
  request.limits.max_sink = radians(5);
  const PlanResult result = followed(route, request);
  EXPECT_TRUE(check(result.route, request).ok()) << result.message;
  request.limits.max_climb = radians(5);  // 25 m over all the way
  EXPECT_EQ(followed(route, request).route, route);
  EXPECT_NE(followed(route, request).message.find("no heights were found"), std::string::npos);
}

TEST(TerrainFollow, KeepsThePlan) {
  const World world = ground([](double x, double y) { return 20 + 20 * std::sin((x + y) / 30); });
  const Polyline route =
      above(world, {{10, 50, 0}, {150, 60, 0}, {155, 200, 0}, {290, 290, 0}, {20, 250, 0}}, 30);
  const Request request = over(world, route, 20, 45);
  const PlanResult result = followed(route, request);
  ASSERT_TRUE(check(result.route, request).ok());
  const Polyline points = result.route.waypoints();
  for (const Vec3& corner : route) {
    EXPECT_TRUE(std::any_of(points.begin(), points.end(),
                            [&](const Vec3& p) { return (p - corner).head<2>().norm() < 1e-9; }));
  }
}

TEST(TerrainFollow, FindsABandThatHoldsNoStepOrNoHeight) {
  const World world = ground(ramp);
  const Polyline route = above(world, {{10, 50, 0}, {60, 51, 0}, {110, 50, 0}, {290, 51, 0}}, 40);
  Request request = over(world, route, 36, 44);
  const PlanResult coarse = followed(route, request, "{station_m: 5, height_step_m: 60}");
  EXPECT_TRUE(check(coarse.route, request).ok()) << coarse.message;
  // A wall between two stations leaves no height at one of them.
  request.world = std::make_shared<const World>(
      world.with({"wall", "box",
                  std::make_shared<kit::ShapeLayer>(
                      std::vector<Shape>{BoxShape{{{150, 0, 0}, {170, 300, 400}}}}),
                  true}));
  EXPECT_NE(followed(route, request).message.find("no heights were found"), std::string::npos);
}

TEST(TerrainFollow, LeavesWhatItCannotImprove) {
  const World world = ground(ramp);
  const Polyline route{{10, 50, 40}, {290, 50, 100}};
  EXPECT_EQ(followed(route, over(world, route, 10, 200)).route, route);
  const Polyline upright{{10, 50, 40}, {10, 50, 80}, {10, 50, 60}};
  EXPECT_EQ(followed(upright, over(world, upright, 10, 200)).route, upright);
  Request level = over(world, {{10, 50, 90}, {100, 50, 90}, {290, 50, 90}}, 10, 200);
  level.level_m = 90;
  EXPECT_EQ(followed({{10, 50, 90}, {100, 50, 90}, {290, 50, 90}}, level).route.size(), 3U);
}

TEST(TerrainFollow, StopsWhereTheBudgetEnds) {
  const World world = ground(ramp);
  const Polyline route = above(world, {{10, 50, 0}, {60, 50, 0}, {290, 50, 0}}, 40);
  Request request = over(world, route, 10, 200);
  request.budget.max_iterations = 3;
  const PlanResult result = followed(route, request);
  EXPECT_TRUE(result.budget_hit);
  EXPECT_EQ(result.route, route);
}

TEST(TerrainFollow, RefusesWrongParameters) {
  EXPECT_NE(parameter_problems("smoother", "terrain_follow", "{station_m: 0}"), "");
  EXPECT_NE(parameter_problems("smoother", "terrain_follow", "{height_step_m: 0}"), "");
}

struct Best {
  std::size_t legs = 1000000;
  double climb = kInfinity;
  bool operator<(const Best& other) const {
    return legs < other.legs || (legs == other.legs && climb < other.climb - 1e-9);
  }
};

/// Every route over stations and heights, each leg by the judge.
Best exhaustive(const Polyline& route, const Request& request, double station_m, double step) {
  struct Position {
    Vec3 at;
    Best best;
  };
  std::vector<std::vector<Position>> stations{{{route.front(), {0, 0}}}};
  std::vector<bool> is_corner{true};
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    const int count = int(std::ceil((route[i + 1] - route[i]).head<2>().norm() / station_m - 1e-9));
    for (int n = 1; n <= count; ++n) {
      is_corner.push_back(n == count);
      stations.emplace_back();
      const Vec3 p = route[i] + double(n) / count * (route[i + 1] - route[i]);
      for (double z = 0; z <= 400; z += step) {
        stations.back().push_back({Vec3(p.x(), p.y(), z), {}});
      }
    }
  }
  stations.back() = {{route.back(), {}}};
  for (std::size_t i = 0; i < stations.size(); ++i) {
    for (const Position& from : stations[i]) {
      for (std::size_t j = i + 1; from.best.legs < 1000 && j < stations.size(); ++j) {
        for (Position& to : stations[j]) {
          const Best by{from.best.legs + 1, from.best.climb + std::abs(to.at.z() - from.at.z())};
          if (by < to.best && leg_ok(std::nullopt, from.at, to.at, request)) {
            to.best = by;
          }
        }
        if (is_corner[j]) {
          break;
        }
      }
    }
  }
  return stations.back().front().best;
}

void compare(int rounds, std::uint64_t seed) {
  RandomStream random(seed);
  int found = 0;
  int more_than_two = 0;
  for (int n = 0; n < rounds; ++n) {
    const double high = random.uniform(5, 60);
    const World world = ground([&](double, double) { return random.uniform(0, high); });
    const double low = random.uniform(5, 20);
    const double width = random.uniform(6, 60);
    Polyline plan{random.in(Box{{10, 10, 0}, {290, 290, 0}})};
    while (plan.size() < 3) {
      const Vec3 p = random.in(Box{{10, 10, 0}, {290, 290, 0}});
      if ((p - plan.back()).norm() > 40) {
        plan.push_back(p);
      }
    }
    const Polyline route = above(world, plan, low + width / 2);
    Request request = over(world, route, low, low + width);
    request.limits.max_climb = radians(random.uniform(10, 90));
    request.limits.max_sink = radians(random.uniform(10, 90));
    request.limits.min_leg = random.uniform() < 0.3 ? 30 : 0;
    if (random.uniform() < 0.5) {
      const double maximum = random.uniform(low + width / 2, low + width);
      apply_constraints(
          request,
          {{"ground_distance",
            make_constraint("ground_distance", "{max_m: " + std::to_string(maximum) + "}")}},
          AppliesTo::route);
      request.limits.altitude = {{AltitudeBand::Datum::ground, low, kInfinity}};
    }
    const Best best = exhaustive(route, request, 20, 2);
    const Route smoothed = followed(route, request, "{station_m: 20, height_step_m: 2}").route;
    Best its{smoothed.leg_count(), 0};
    for (std::size_t i = 0; i + 1 < smoothed.size(); ++i) {
      its.climb += std::abs(smoothed[i + 1].z() - smoothed[i].z());
    }
    if (best.legs > 1000) {
      EXPECT_EQ(smoothed.waypoints(), route) << n;
      continue;
    }
    ++found;
    more_than_two += best.legs > 2;
    EXPECT_TRUE(check(smoothed, request).ok()) << n;
    EXPECT_LE(its.legs, best.legs) << n;
    if (smoothed.waypoints() != route) {  // off the grid
      EXPECT_EQ(its.legs, best.legs) << n;
      EXPECT_NEAR(its.climb, best.climb, 1e-6) << n;
    }
  }
  EXPECT_GT(found, rounds / 4);
  EXPECT_GT(more_than_two, rounds / 8);
}

TEST(TerrainFollow, AgreesWithExhaustiveSearch) { compare(5, 28); }
TEST(NightlyTerrainFollow, AgreesWithExhaustiveSearch) { compare(100, 29); }
}  // namespace
}  // namespace altiplan::testing::terrain_follow_test
