// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/measures.hpp"
#include "support/support.hpp"

namespace altiplan {
namespace {

using testing::make_smoother;

const Box kSpace = {{-100, -100, -100}, {200, 200, 200}};

TEST(BSpline, RoundsACornerWithinItsReach) {
  const Request request = testing::request_in(World(), {0, 0, 0}, {100, 100, 0}, kSpace);
  const Route route = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}};
  const PlanResult result =
      make_smoother("bspline", "{reach_m: 20, samples: 8}")->smooth(route, request);
  ASSERT_EQ(result.status, Status::solved);
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
  // Where the middle of the widest curve would pass.
  const Vec3 beside(100 - 25.0 / 6, 25.0 / 6, 0);
  const Route route = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}};
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

TEST(BSpline, KeepsEveryRuleOfRandomRoutes) {
  SplitMix64 random(21);
  int rounded = 0;
  for (int world = 0; world < 200; ++world) {
    std::vector<Shape> shapes;
    const auto anywhere = [&] {
      return Vec3(random.uniform() * 100, random.uniform() * 100, random.uniform() * 100);
    };
    for (int i = 0; i < 10; ++i) {
      shapes.push_back(Sphere{anywhere(), 10});
    }
    Request request =
        testing::request_in(testing::world_of(std::move(shapes)), {0, 0, 0}, {0, 0, 0}, kSpace);
    request.limits.min_clearance = 2;
    request.limits.max_turn_space = radians(120);
    request.limits.max_climb = world % 2 == 0 ? radians(50) : kPi / 2;
    request.limits.min_leg = world % 5 == 0 ? 4 : 0;
    Route route;
    for (int attempt = 0; attempt < 400 && route.size() < 8; ++attempt) {
      const Vec3 p = anywhere();
      const auto before = route.size() > 1 ? std::optional(route[route.size() - 2]) : std::nullopt;
      if (route.empty() ? point_problem(p, request).empty()
                        : leg_ok(before, route.back(), p, request)) {
        route.push_back(p);
      }
    }
    if (route.size() < 3) {
      continue;
    }
    request.start.position = route.front();
    request.goal.position = route.back();
    ASSERT_TRUE(check(route, request).ok());
    const PlanResult result = make_smoother("bspline", "{samples: 3}")->smooth(route, request);
    ASSERT_EQ(result.status, Status::solved) << result.message;
    const CheckResult judged = check(result.route, request);
    ASSERT_TRUE(judged.ok()) << judged.violations.front().message;
    EXPECT_LE(length(result.route), length(route) + 1e-9);
    rounded += result.route.size() > route.size();
  }
  EXPECT_GT(rounded, 100);
}

TEST(BSpline, StraightRoutesAndBudgets) {
  Request request = testing::request_in(World(), {0, 0, 0}, {90, 0, 0}, kSpace);
  const Route straight = {{0, 0, 0}, {30, 0, 0}, {90, 0, 0}};
  EXPECT_EQ(make_smoother("bspline")->smooth(straight, request).route, straight);
  const Route bent = {{0, 0, 0}, {30, 30, 0}, {90, 0, 0}};
  request.budget.max_iterations = 0;
  const PlanResult result = make_smoother("bspline")->smooth(bent, request);
  EXPECT_EQ(result.route, bent);
  EXPECT_TRUE(result.budget_hit);
  EXPECT_NE(testing::parameter_problems("smoother", "bspline", "{reach_m: 0}"), "");
}
}  // namespace
}  // namespace altiplan
