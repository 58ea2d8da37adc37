// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/measures.hpp"
#include "support/support.hpp"
#include "support/walks.hpp"

namespace altiplan::bspline_test {
namespace {

using testing::make_smoother;

const Box kSpace = {{-100, -100, -100}, {200, 200, 200}};

TEST(BSpline, RoundsACornerWithinItsReach) {
  const Request request = testing::request_in(World(), {0, 0, 0}, {100, 100, 0}, kSpace);
  const Polyline route = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}};
  const PlanResult result =
      make_smoother("bspline", "{reach_m: 20, samples: 8}")->smooth(route, request);
  ASSERT_EQ(result.status, PlanStatus::solved);
  EXPECT_EQ(result.route.size(), 2u + 33u);
  EXPECT_EQ(result.route[1], Vec3(80, 0, 0));
  EXPECT_NEAR((result.route[33] - Vec3(100, 20, 0)).norm(), 0, 1e-9);
  // At its middle the curve is (P1 + 4 C + P3) / 6 of the control points around C.
  EXPECT_NEAR((result.route[17] - Vec3(590.0 / 6, 10.0 / 6, 0)).norm(), 0, 1e-9);
  EXPECT_LT(length(result.route), length(route));
  EXPECT_LT(*measure(result.route, request).max_turn_deg, 15);
  EXPECT_TRUE(check(result.route, request).ok());
}

TEST(BSpline, ComesNearerWhereTheCurveWouldHitAndElseLeaves) {
  // The point where the middle of the widest curve would pass.
  const Vec3 beside(100 - 25.0 / 6, 25.0 / 6, 0);
  const Polyline route = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}};
  Request request = testing::request_in(testing::world_of({Shape{Sphere{beside, 1.5}}}), {0, 0, 0},
                                        {100, 100, 0}, kSpace);
  ASSERT_TRUE(check(route, request).ok());
  const PlanResult nearer = make_smoother("bspline")->smooth(route, request);
  EXPECT_TRUE(check(nearer.route, request).ok());
  EXPECT_GT(nearer.route.size(), route.size());
  EXPECT_GT(nearer.route[1].x(), 60);  // half a leg would have been 50
  const PlanResult left = make_smoother("bspline", "{tries: 1}")->smooth(route, request);
  EXPECT_EQ(left.route, route);
}

void some_limits(Limits& limits, std::uint64_t seed) {
  limits.min_clearance = seed % 3 == 0 ? 2 : 0;
  limits.min_turn_radius = seed % 2 == 0 ? double(seed % 40) : 0;
  limits.max_turn_space = seed % 5 == 0 ? radians(120) : kPi;
  limits.max_climb = seed % 7 == 0 ? radians(50) : kPi / 2;
  limits.min_leg = seed % 11 == 0 ? 4 : 0;
}

TEST(BSpline, NoRuleOfRandomRoutesGetsWorse) {
  int rounded = 0;
  int rounded_unsound = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    const bool sound = seed % 4 != 0;
    const auto [request, route] = testing::random_walk(
        RandomStream(seed), 8, sound, [&](Limits& limits) { some_limits(limits, seed); });
    if (route.size() < 3) {
      continue;
    }
    const PlanResult result = make_smoother("bspline", "{samples: 3}")->smooth(route, request);
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    ASSERT_EQ(testing::grown_excess(route, result.route, request), "") << seed;
    ASSERT_TRUE(!sound || check(result.route, request).ok()) << seed;
    EXPECT_LE(length(result.route), length(route) + 1e-9);
    (sound ? rounded : rounded_unsound) += result.route != route;
  }
  EXPECT_GT(rounded, 300);
  EXPECT_GT(rounded_unsound, 20);
}

/// A route of one corner in empty space with this reach.
Polyline rounded_at(const Polyline& route, double reach, int samples) {
  Request request = testing::open_request(route);
  const std::string yaml = "{tries: 1, reach_m: " + std::to_string(reach) +
                           ", samples: " + std::to_string(samples) + "}";
  return make_smoother("bspline", yaml)->smooth(route, request).route.waypoints();
}

TEST(BSpline, ACornerThatCanBeRoundedIs) {
  int possible = 0;
  int impossible = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto [request, route] =
        testing::random_walk(RandomStream(seed).sub("corner"), 3, true, [&](Limits& limits) {
          limits.min_turn_radius = 0.5 + double(seed % 8);
          limits.min_clearance = 1;
        });
    if (route.size() < 3) {
      continue;
    }
    const double maximum = std::min((route[1] - route[0]).norm(), (route[2] - route[1]).norm()) / 2;
    bool any = false;
    for (int n = 1; n <= 60; ++n) {
      any = any || check(rounded_at(route.waypoints(), maximum * n / 60, 4), request).ok();
    }
    const PlanResult result = make_smoother("bspline", "{tries: 12}")->smooth(route, request);
    EXPECT_TRUE(!any || result.route != route) << seed;
    EXPECT_TRUE(check(result.route, request).ok());
    ++(any ? possible : impossible);
  }
  EXPECT_GT(possible, 50);
  EXPECT_GT(impossible, 10);
}

TEST(BSpline, FindsTheReachBetweenTheBallAndTheRadius) {
  // A reach of 50 m or 25 m hits a ball inside the corner; 12.5 m would turn with a radius of 2.5
  // m.
  const Polyline route = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}};
  Request request = testing::open_request(route);
  request.limits.min_turn_radius = 4;
  const auto smoothed_beside_ball = [&](double radius) {
    const Shape ball{Sphere{Vec3(100, 0, 0) + std::sqrt(0.5) * 4.5 * Vec3(-1, 1, 0), radius}};
    request.world = std::make_shared<const World>(testing::world_of({ball}));
    const Route smoothed = make_smoother("bspline")->smooth(route, request).route;
    EXPECT_TRUE(check(smoothed, request).ok());
    return smoothed;
  };
  const double radius = *measure(smoothed_beside_ball(1.75), request).min_radius_m;
  EXPECT_GE(radius, 4);
  EXPECT_LE(radius, 4.25) << "the margin for an autopilot's digits";
  EXPECT_EQ(smoothed_beside_ball(2.6), route);
}

TEST(BSpline, TakesMoreThanHalfALegForTheRadius) {
  const Polyline route = {{0, 0, 0}, {30, 0, 0}, {30, 30, 0}};
  Request request = testing::open_request(route);
  request.limits.min_turn_radius = 5;  // of curves with a reach of 24.6 m
  const PlanResult result = make_smoother("bspline")->smooth(route, request);
  EXPECT_GT(result.route.size(), 3u);
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_EQ(make_smoother("bspline", "{reach_m: 20}")->smooth(route, request).route, route);
}

TEST(BSpline, OddRoutes) {
  const auto smoothed = [](const Polyline& route) {
    Request request = testing::open_request(route);
    request.limits.min_turn_radius = 1;
    const PlanResult result = make_smoother("bspline")->smooth(route, request);
    EXPECT_EQ(result.status, PlanStatus::solved);
    EXPECT_EQ(testing::grown_excess(route, result.route, request), "");
    return result.route;
  };
  const Vec3 p(3, 4, 5);
  EXPECT_EQ(smoothed({p, p, p}), Polyline(3, p));
  EXPECT_EQ(smoothed({p, {9, 9, 9}}).size(), 2u);
  const Polyline back = {{0, 0, 0}, {50, 0, 0}, {20, 0, 0}};
  EXPECT_EQ(smoothed(back), back);
  // A repeated point hides no corner.
  EXPECT_GT(smoothed({{0, 0, 0}, {50, 0, 0}, {50, 0, 0}, {50, 50, 0}}).size(), 10u);
}

TEST(BSpline, StraightRoutesAndBudgets) {
  Request request = testing::request_in(World(), {0, 0, 0}, {90, 0, 0}, kSpace);
  const Polyline straight = {{0, 0, 0}, {30, 0, 0}, {90, 0, 0}};
  EXPECT_EQ(make_smoother("bspline")->smooth(straight, request).route, straight);
  const Polyline bent = {{0, 0, 0}, {30, 30, 0}, {90, 0, 0}};
  request.budget.max_iterations = 0;
  const PlanResult result = make_smoother("bspline")->smooth(bent, request);
  EXPECT_EQ(result.route, bent);
  EXPECT_TRUE(result.budget_hit);
  EXPECT_NE(testing::parameter_problems("smoother", "bspline", "{reach_m: 0}"), "");
}
}  // namespace
}  // namespace altiplan::bspline_test
