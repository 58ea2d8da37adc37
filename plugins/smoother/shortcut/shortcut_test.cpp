// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan::shortcut_test {
namespace {

using testing::counter;
using testing::make_smoother;

Request beside_a_ball() {
  Request request = testing::request_in(testing::world_of({Shape{Sphere{{50, 0, 0}, 20}}}),
                                        {0, 0, 0}, {100, 0, 0}, {{-9, -99, -99}, {109, 99, 99}});
  request.limits.min_clearance = request.vehicle.radius_m = 1;
  request.random = RandomStream(3);
  return request;
}
const Route kDetour = {{0, 0, 0}, {10, 60, 0}, {50, 70, 0}, {80, 65, 8}, {95, 40, 0}, {100, 0, 0}};

TEST(Shortcut, InTheOpenNothingButTheStraightLegIsLeft) {
  const Request request =
      testing::request_in(World(), {0, 0, 0}, {100, 0, 0}, {{-9, -99, -99}, {109, 99, 99}});
  const PlanResult result = make_smoother("shortcut")->smooth(kDetour, request);
  EXPECT_EQ(result.route, (Route{{0, 0, 0}, {100, 0, 0}}));
  EXPECT_LT(counter(result, "expanded"), 200);
}

TEST(Shortcut, ComesNearToTheShortestWayAroundABall) {
  const Request request = beside_a_ball();
  const PlanResult result =
      make_smoother("shortcut", "{iterations: 20000, failures: 2000}")->smooth(kDetour, request);
  EXPECT_TRUE(check(result.route, request).ok());
  // Two tangents and the arc between them, around a ball of 21 m.
  const double tangent = std::sqrt(50 * 50 - 21 * 21);
  const double shortest = 2 * tangent + 21 * 2 * std::asin(21.0 / 50);
  EXPECT_GE(length(result.route), shortest - 1e-3);
  EXPECT_LE(length(result.route), 1.01 * shortest);
}

TEST(Shortcut, AtWaypointsAloneItOnlyLeavesSomeOut) {
  const Request request = beside_a_ball();
  const PlanResult result =
      make_smoother("shortcut", "{waypoint_share: 1}")->smooth(kDetour, request);
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_LT(result.route.size(), kDetour.size());
  for (const Vec3& p : result.route) {
    EXPECT_EQ(std::count(kDetour.begin(), kDetour.end(), p), 1);
  }
}

TEST(Shortcut, HoldsTurnsLegsAndTheHeading) {
  int shorter = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Request request = beside_a_ball();
    request.random = RandomStream(seed);
    request.start.velocity = {0, 1, 0};
    request.limits.max_turn_space = radians(75);
    request.limits.min_leg = 8;
    ASSERT_TRUE(check(kDetour, request).ok());
    const PlanResult result = make_smoother("shortcut")->smooth(kDetour, request);
    EXPECT_TRUE(check(result.route, request).ok());
    EXPECT_LE(length(result.route), length(kDetour));
    shorter += length(result.route) < 0.95 * length(kDetour);
  }
  EXPECT_GT(shorter, 30);
}

TEST(Shortcut, LeavesARouteThatIsAlreadyStraightAlone) {
  const Request request =
      testing::request_in(World(), {0, 0, 0}, {9, 0, 0}, {{-9, -9, -9}, {9, 9, 9}});
  const Route straight = {{0, 0, 0}, {3, 0, 0}, {6, 0, 0}, {9, 0, 0}};
  EXPECT_EQ(make_smoother("shortcut")->smooth(straight, request).route, straight);
}

TEST(Shortcut, MendsNoUnsoundLegAndBreaksNone) {
  Request request = beside_a_ball();
  const Route through = {{0, 0, 0}, {20, 30, 0}, {50, 0, 0}, {80, 30, 0}, {100, 0, 0}};
  const PlanResult result = make_smoother("shortcut")->smooth(through, request);
  EXPECT_LE(check(result.route, request).violations.size(),
            check(through, request).violations.size());
}

TEST(Shortcut, EndsAfterSoManyInVainAndWithTheBudget) {
  Request request = beside_a_ball();
  const Route tight = {{0, 0, 0}, {50, 21.5, 0}, {100, 0, 0}};
  const PlanResult vain =
      make_smoother("shortcut", "{waypoint_share: 1, failures: 7}")->smooth(tight, request);
  EXPECT_EQ(vain.route, tight);
  EXPECT_EQ(counter(vain, "expanded"), 7);
  EXPECT_FALSE(vain.budget_hit);
  request.budget.max_iterations = 5;
  const PlanResult cut = make_smoother("shortcut")->smooth(kDetour, request);
  EXPECT_TRUE(cut.budget_hit);
  EXPECT_EQ(counter(cut, "expanded"), 5);
  EXPECT_TRUE(check(cut.route, request).ok());
}

TEST(Shortcut, TheSeedDecides) {
  Request request = beside_a_ball();
  const auto shortcut = make_smoother("shortcut");
  const Route first = shortcut->smooth(kDetour, request).route;
  EXPECT_EQ(shortcut->smooth(kDetour, request).route, first);
  request.random = RandomStream(4);
  EXPECT_NE(shortcut->smooth(kDetour, request).route, first);
}
}  // namespace
}  // namespace altiplan::shortcut_test
