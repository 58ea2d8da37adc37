// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/measures.hpp"
#include "support/support.hpp"
#include "support/walks.hpp"

namespace altiplan {
namespace {

using testing::counter;
using testing::make_smoother;
using testing::open_request;

/// The route's arcs of this radius, where nothing is in the way.
PlanResult arcs(const Route& route, double radius, const std::string& more = "") {
  Request request = open_request(route);
  request.limits.min_turn_radius = radius;
  return make_smoother("arc", "{" + more + "}")->smooth(route, request);
}

TEST(Arc, TouchesBothLegsAndKeepsToItsCircle) {
  const Route route = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}};
  const PlanResult result = arcs(route, 20);
  ASSERT_EQ(result.status, Status::solved);
  EXPECT_EQ(result.message, "1 of 1 corners are arcs of 20 m");
  EXPECT_EQ(counter(result, "filleted"), 1);
  ASSERT_EQ(result.route.size(), 2u + 7u) << "six chords of 15 degrees";
  EXPECT_NEAR((result.route[1] - Vec3(80, 0, 0)).norm(), 0, 1e-6);
  EXPECT_NEAR((result.route[7] - Vec3(100, 20, 0)).norm(), 0, 1e-6);
  for (std::size_t i = 1; i <= 7; ++i) {
    EXPECT_NEAR((result.route[i] - Vec3(80, 20, 0)).norm(), 20, 1e-6);
  }
  const Measures measures = measure(result.route, open_request(route));
  EXPECT_GE(*measures.min_radius_m, 20);
  EXPECT_NEAR(*measures.min_radius_m, 20, 1e-6);
  EXPECT_NEAR(*measures.max_turn_deg, 15, 1e-6);
}

TEST(Arc, ChordsKeepTheSag) {
  const Route route = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}};
  for (const double sag : {0.001, 0.1, 3.0}) {
    const Route arc = arcs(route, 40, "sag_m: " + std::to_string(sag)).route;
    double most = 0;
    for (std::size_t i = 1; i + 2 < arc.size(); ++i) {
      most = std::max(most, 40 - ((arc[i] + arc[i + 1]) / 2 - Vec3(60, 40, 0)).norm());
    }
    EXPECT_LE(most, sag + 1e-6);
    EXPECT_GT(most, sag / 8);
  }
}

TEST(Arc, TheRadiusHoldsForEveryRouteWhoseCornersAllHaveArcs) {
  // In space, as the judge measures it: joints of arcs in different planes included.
  int whole = 0;
  int touching = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    RandomStream random(seed);
    Route route = {{0, 0, 0}};
    while (route.size() < 7) {
      route.push_back(route.back() + random.in({Vec3::Constant(-100), Vec3::Constant(100)}));
    }
    // The greatest radius for which all have room, so that two of the arcs touch.
    double radius = kInfinity;
    std::vector<double> tangents = {0};
    for (std::size_t i = 1; i + 1 < route.size(); ++i) {
      tangents.push_back(
          std::tan(turn_angle_in_space(route[i] - route[i - 1], route[i + 1] - route[i]) / 2));
    }
    tangents.push_back(0);
    for (std::size_t i = 0; i + 1 < route.size(); ++i) {
      radius = std::min(radius, (route[i + 1] - route[i]).norm() / (tangents[i] + tangents[i + 1]));
    }
    for (const double share : {0.5, 0.999999, 1.00001}) {
      const PlanResult result = arcs(route, share * radius);
      const bool all = counter(result, "filleted") == 5;
      EXPECT_EQ(all, share < 1) << seed << ' ' << share << ": " << result.message;
      Request request = open_request(route);
      request.limits.min_turn_radius = share * radius;
      if (all) {
        EXPECT_TRUE(check(result.route, request).ok()) << seed;
        EXPECT_GE(*measure(result.route, request).min_radius_m, share * radius - 1e-9);
        touching += share > 0.9;
      }
      EXPECT_EQ(testing::grown_excess(route, result.route, request), "") << seed;
      EXPECT_LE(length(result.route), length(route) + 1e-9);
      whole += all;
    }
  }
  EXPECT_EQ(whole, 800);
  EXPECT_EQ(touching, 400);
}

/// The most corners that have room for their arcs together, by trying all sets.
int most_arcs(const Route& route, double radius) {
  int most = 0;
  const std::size_t inner = route.size() - 2;
  for (unsigned set = 0; set < 1U << inner; ++set) {
    bool room = true;
    double taken = 0;  // of the leg into waypoint i
    for (std::size_t i = 1; i + 1 < route.size() && room; ++i) {
      const Vec3 into = route[i] - route[i - 1];
      const Vec3 out_of = route[i + 1] - route[i];
      const bool arc = (set >> (i - 1) & 1) != 0;
      const double t = arc ? radius * std::tan(turn_angle_in_space(into, out_of) / 2) : 0;
      room = taken + t <= into.norm() && t <= out_of.norm();
      taken = t;
    }
    most = room ? std::max(most, __builtin_popcount(set)) : most;
  }
  return most;
}

TEST(Arc, NoSetOfCornersLeavesFewer) {
  int left = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    RandomStream random(seed);
    Route route = {{0, 0, 0}};
    while (route.size() < 9) {
      route.push_back(route.back() + random.in({Vec3::Constant(-100), Vec3::Constant(100)}));
    }
    const double radius = random.uniform(5, 60);
    const PlanResult result = make_smoother("arc", "{radius_m: " + std::to_string(radius) + "}")
                                  ->smooth(route, open_request(route));
    EXPECT_EQ(counter(result, "corners"), 7);
    EXPECT_EQ(counter(result, "filleted"), most_arcs(route, radius)) << seed;
    left += counter(result, "filleted") < 7;
    EXPECT_EQ(counter(result, "filleted") == 7,
              result.message.find("too short") == std::string::npos);
  }
  EXPECT_GT(left, 100);
}

TEST(Arc, NoRuleOfRandomRoutesGetsWorse) {
  int filleted = 0;
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    const bool sound = seed % 4 != 0;
    const auto [request, route] =
        testing::random_walk(RandomStream(seed).sub("arc"), 8, sound, [&](Limits& limits) {
          limits.min_turn_radius = seed % 2 == 0 ? double(seed % 20) : 0;
          limits.min_clearance = seed % 3 == 0 ? 2 : 0;
          limits.max_turn_horizontal = seed % 5 == 0 ? radians(110) : kPi;
          limits.max_climb = seed % 7 == 0 ? radians(50) : kPi / 2;
          limits.min_leg = seed % 11 == 0 ? 4 : 0;
        });
    if (route.size() < 3) {
      continue;
    }
    const PlanResult result = make_smoother("arc", "{radius_m: 8}")->smooth(route, request);
    ASSERT_EQ(result.status, Status::solved) << result.message;
    ASSERT_EQ(testing::grown_excess(route, result.route, request), "") << seed;
    ASSERT_TRUE(!sound || check(result.route, request).ok()) << seed;
    EXPECT_LE(length(result.route), length(route) + 1e-9);
    filleted += counter(result, "filleted") > 0;
    refused += counter(result, "refused") > 0;
  }
  EXPECT_GT(filleted, 300);
  EXPECT_GT(refused, 50);
}

TEST(Arc, MendsWhatTheJudgeFoundTooTight) {
  // The circle through the three waypoints has 70.7 m; the arc may use whole legs.
  const Route route = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}};
  Request request = open_request(route);
  request.limits.min_turn_radius = 90;
  EXPECT_FALSE(check(route, request).ok());
  EXPECT_TRUE(check(arcs(route, 90).route, request).ok());
}

TEST(Arc, LeavesShortLegsAndObstacles) {
  const Route route = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {130, 100, 0}};
  const PlanResult tight =
      make_smoother("arc", "{radius_m: 40}")->smooth(route, open_request(route));
  EXPECT_EQ(tight.message, "1 of 2 corners are arcs of 40 m; the legs of 1 are too short for it");
  EXPECT_EQ(tight.route.back(), route.back());
  Request request = open_request(route);
  // Where the middle of the first arc would pass.
  const Vec3 middle = Vec3(60, 40, 0) + 40 * std::sqrt(0.5) * Vec3(1, -1, 0);
  request.world = std::make_shared<const World>(testing::world_of({Shape{Sphere{middle, 1}}}));
  const PlanResult refused = make_smoother("arc", "{radius_m: 40}")->smooth(route, request);
  EXPECT_EQ(refused.route, route);
  EXPECT_EQ(refused.message,
            "0 of 2 corners are arcs of 40 m; the legs of 1 are too short for it; 1 would break a "
            "rule");
}

TEST(Arc, ChordsKeepTheLimitsOnLegsAndTurns) {
  const Route route = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}};
  Request request = open_request(route);
  request.limits.min_leg = 10;
  request.limits.max_turn_space = radians(20);
  request.limits.min_turn_radius = 20;
  EXPECT_FALSE(check(route, request).ok());
  const Route coarse = make_smoother("arc")->smooth(route, request).route;
  EXPECT_EQ(coarse.size(), 2u + 4u) << "three chords of 30 degrees are 10.35 m";
  EXPECT_EQ(testing::grown_excess(route, coarse, request), "");
  request.limits.min_leg = 4;
  const Route fine = make_smoother("arc", "{sag_m: 3}")->smooth(route, request).route;
  EXPECT_EQ(fine.size(), 2u + 6u) << "five chords of 18 degrees are 6.26 m";
  EXPECT_TRUE(check(fine, request).ok());
}

TEST(Arc, StraightStretchesAreOneLeg) {
  const Route route = {{0, 0, 0},    {40, 0, 0},   {80, 0, 0},  {100, 0, 0},
                       {100, 20, 0}, {100, 50, 0}, {100, 99, 0}};
  EXPECT_EQ(arcs(route, 60).message, "1 of 1 corners are arcs of 60 m");
}

TEST(Arc, OddRoutesAndNoRadius) {
  const Vec3 p(3, 4, 5);
  EXPECT_EQ(arcs({p, p, p}, 5).route, Route(3, p));
  EXPECT_EQ(arcs({p, {9, 9, 9}}, 5).route.size(), 2u);
  const Route back = {{0, 0, 0}, {50, 0, 0}, {20, 0, 0}};
  EXPECT_EQ(arcs(back, 5).route, back);
  EXPECT_GT(arcs({{0, 0, 0}, {50, 0, 0}, {50, 0, 0}, {50, 50, 0}}, 5).route.size(), 8u);
  EXPECT_GT(arcs({{0, 0, 0}, {0, 0, 50}, {50, 0, 50}}, 5).route.size(), 8u) << "straight up first";

  const Route bent = {{0, 0, 0}, {50, 0, 0}, {50, 50, 0}};
  const PlanResult none = make_smoother("arc")->smooth(bent, open_request(bent));
  EXPECT_EQ(none.status, Status::invalid_problem);
  EXPECT_NE(none.message.find("radius_m"), std::string::npos);
  // The parameter may only tighten the limit.
  Request request = open_request(bent);
  request.limits.min_turn_radius = 30;
  const PlanResult limited = make_smoother("arc", "{radius_m: 10}")->smooth(bent, request);
  EXPECT_NEAR(*measure(limited.route, request).min_radius_m, 30, 1e-6);
  request.budget.max_iterations = 0;
  const PlanResult spent = make_smoother("arc")->smooth(bent, request);
  EXPECT_EQ(spent.route, bent);
  EXPECT_TRUE(spent.budget_hit);
  EXPECT_NE(testing::parameter_problems("smoother", "arc", "{radius_m: 0}"), "");
  EXPECT_NE(testing::parameter_problems("smoother", "arc", "{sag_m: 0}"), "");
}
}  // namespace
}  // namespace altiplan
