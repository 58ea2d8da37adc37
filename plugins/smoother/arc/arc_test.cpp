// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/measures.hpp"
#include "support/support.hpp"
#include "support/walks.hpp"

namespace altiplan::arc_test {
namespace {

using testing::counter;
using testing::make_smoother;
using testing::open_request;

/// The route with turns of this radius at its corners, without obstacles.
PlanResult arcs(const Polyline& route, double radius) {
  Request request = open_request(route);
  request.limits.min_turn_radius = radius;
  return make_smoother("arc")->smooth(route, request);
}

TEST(Arc, IsTheFilletOfTheCorner) {
  const Polyline route = {{0, 0, 0}, {1000, 0, 0}, {1000, 1000, 50}};
  const PlanResult result = arcs(route, 200);
  ASSERT_EQ(result.status, PlanStatus::solved);
  EXPECT_EQ(result.message, "1 of 1 corners are turns of 200 m");
  EXPECT_EQ(counter(result, "filleted"), 1);
  ASSERT_EQ(result.route.leg_count(), 3u);
  const Leg turn = result.route.leg(1);
  EXPECT_EQ(turn.kind(), Leg::Kind::arc);
  EXPECT_NEAR(turn.turn, kPi / 2, 1e-12);
  EXPECT_EQ(turn.radius, 200);
  EXPECT_LT((turn.from - Vec3(800, 0, 0)).norm(), 1e-9);
  EXPECT_LT((turn.to - Vec3(1000, 200, 10)).norm(), 1e-9);
}

TEST(Arc, InWindTurnsDriftAndJoinBothLegs) {
  RandomStream random(3);
  for (int n = 0; n < 200; ++n) {
    Polyline route = {{0, 0, 300}};
    double course = random.uniform(-kPi, kPi);
    for (int i = 0; i < 4; ++i) {
      route.push_back(route.back() + random.uniform(1500, 3000) * unit_heading(course));
      course += random.uniform(-2, 2);
    }
    Request request = open_request(route);
    request.vehicle.speed_mps = 20;
    request.wind.layers = {{0, random.uniform(1, 12) * unit_heading(random.uniform(-kPi, kPi))}};
    request.limits.min_turn_radius = 100;
    const PlanResult result = make_smoother("arc")->smooth(route, request);
    ASSERT_EQ(counter(result, "filleted"), 3) << result.message;
    EXPECT_EQ(result.route.leg(1).kind(), Leg::Kind::trochoid);
    EXPECT_TRUE(check(result.route, request).ok()) << n;
  }
}

TEST(Arc, EveryCornerTurnsWhoseLegsAreLongEnough) {
  int whole = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    RandomStream random(seed);
    Polyline route = {{0, 0, 0}};
    while (route.size() < 7) {
      route.push_back(route.back() + random.in({Vec3(-3000, -3000, -300), Vec3(3000, 3000, 300)}));
    }
    // The largest radius whose turns fit on the legs.
    double radius = kInfinity;
    std::vector<double> tangents = {0};
    for (std::size_t i = 1; i + 1 < route.size(); ++i) {
      tangents.push_back(
          std::tan(turn_angle_horizontal(route[i] - route[i - 1], route[i + 1] - route[i]) / 2));
    }
    tangents.push_back(0);
    for (std::size_t i = 0; i + 1 < route.size(); ++i) {
      radius = std::min(
          radius, (route[i + 1] - route[i]).head<2>().norm() / (tangents[i] + tangents[i + 1]));
    }
    for (const double share : {0.4, 0.7, 0.95, 1.00001}) {
      const PlanResult result = arcs(route, share * radius);
      const bool all = counter(result, "filleted") == 5;
      EXPECT_EQ(share < 1, all) << seed << ": " << result.message;
      Request request = open_request(route);
      request.limits.min_turn_radius = share * radius;
      EXPECT_TRUE(!all || check(result.route, request).ok()) << seed;
      EXPECT_EQ(testing::grown_excess(route, result.route, request), "") << seed;
      EXPECT_LE(length(result.route), length(route) + 1e-9);
      whole += all;
    }
  }
  EXPECT_EQ(whole, 1200);
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
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
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
  // Half of each leg allows 500 m; a turn may use more of them.
  const Polyline route = {{0, 0, 0}, {1000, 0, 0}, {1000, 1000, 0}};
  Request request = open_request(route);
  request.limits.min_turn_radius = 800;
  EXPECT_FALSE(check(route, request).ok());
  EXPECT_TRUE(check(arcs(route, 800).route, request).ok());
}

TEST(Arc, LeavesShortLegsAndObstacles) {
  const Polyline route = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {130, 100, 0}};
  const PlanResult tight =
      make_smoother("arc", "{radius_m: 40}")->smooth(route, open_request(route));
  EXPECT_EQ(tight.message, "1 of 2 corners are turns of 40 m; the legs of 1 are too short for it");
  EXPECT_EQ(tight.route.back(), route.back());
  Request request = open_request(route);
  // The point where the middle of the first arc would pass.
  const Vec3 middle = Vec3(60, 40, 0) + 40.3 * std::sqrt(0.5) * Vec3(1, -1, 0);
  request.world = std::make_shared<const World>(testing::world_of({Shape{Sphere{middle, 3}}}));
  const PlanResult refused = make_smoother("arc", "{radius_m: 40}")->smooth(route, request);
  EXPECT_EQ(refused.route, route);
  EXPECT_EQ(refused.message,
            "0 of 2 corners are turns of 40 m; the legs of 1 are too short for it; 1 would violate "
            "a constraint");
}

TEST(Arc, StraightStretchesAreOneLeg) {
  const Polyline route = {{0, 0, 0},    {40, 0, 0},   {80, 0, 0},  {100, 0, 0},
                          {100, 20, 0}, {100, 50, 0}, {100, 99, 0}};
  EXPECT_EQ(arcs(route, 60).message, "1 of 1 corners are turns of 60 m");
}

TEST(Arc, OddRoutesAndNoRadius) {
  const Vec3 p(3, 4, 5);
  EXPECT_EQ(arcs({p, p, p}, 5).route, Polyline(3, p));
  EXPECT_EQ(arcs({p, {9, 9, 9}}, 5).route.size(), 2u);
  const Polyline back = {{0, 0, 0}, {50, 0, 0}, {20, 0, 0}};
  EXPECT_EQ(arcs(back, 5).route, back);
  EXPECT_EQ(arcs({{0, 0, 0}, {50, 0, 0}, {50, 0, 0}, {50, 50, 0}}, 5).route.leg_count(), 3u);
  const Polyline up = {{0, 0, 0}, {0, 0, 50}, {50, 0, 50}};
  EXPECT_EQ(arcs(up, 5).route, up) << "straight up first";

  const Polyline bent = {{0, 0, 0}, {50, 0, 0}, {50, 50, 0}};
  const PlanResult none = make_smoother("arc")->smooth(bent, open_request(bent));
  EXPECT_EQ(none.status, PlanStatus::invalid_problem);
  EXPECT_NE(none.message.find("radius_m"), std::string::npos);
  // The parameter may only tighten the limit.
  Request request = open_request(bent);
  request.limits.min_turn_radius = 30;
  const PlanResult limited = make_smoother("arc", "{radius_m: 10}")->smooth(bent, request);
  EXPECT_EQ(limited.route.leg(1).radius, 30);
  request.budget.max_iterations = 0;
  const PlanResult spent = make_smoother("arc")->smooth(bent, request);
  EXPECT_EQ(spent.route, bent);
  EXPECT_TRUE(spent.budget_hit);
  EXPECT_NE(testing::parameter_problems("smoother", "arc", "{radius_m: 0}"), "");
}
}  // namespace
}  // namespace altiplan::arc_test
