// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan::waypoint_reduction_test {
namespace {

using testing::counter;
using testing::make_smoother;

const Box kVolume{{-100, -100, 0}, {100, 100, 0}};

Request past(std::vector<Shape> shapes, const Polyline& route) {
  Request request = testing::request_in(testing::world_of(std::move(shapes)), route.front(),
                                        route.back(), kVolume);
  request.level_m = 0;
  return request;
}

const Polyline kOver{{0, 0, 0}, {2, 3, 0}, {5, 4.2, 0}, {8, 4, 0}, {10, 0, 0}};
const Cylinder kBelow{5, 0, 3};

TEST(WaypointReduction, FarthestPointThatIsSeen) {
  // Over a disc: the start sees the top, and the top sees the end.
  const PlanResult result =
      make_smoother("waypoint_reduction")->smooth(kOver, past({kBelow}, kOver));
  EXPECT_EQ(result.route, (Polyline{kOver[0], kOver[2], kOver[4]}));
  EXPECT_EQ(result.message, "3 of 5 waypoints kept");
}

TEST(WaypointReduction, TurnsByAtMostNinetyDegrees) {
  // Around the end of a wall; from behind it the last point is visible, but straight back.
  const Polyline route{{0, 0, 0}, {10, 0, 0}, {12, 1, 0}, {12, 5, 0}, {5, 5.5, 0}};
  const Request request = past({BoxShape{{{-5, 1, -1}, {8, 2, 1}}}}, route);
  const PlanResult result = make_smoother("waypoint_reduction")->smooth(route, request);
  EXPECT_EQ(result.route, (Polyline{route[0], route[2], route[3], route[4]}));
  EXPECT_EQ(counter(result, "points_without_end"), 0);
  const PlanResult sharp =
      make_smoother("waypoint_reduction", "{max_turn_deg: 180}")->smooth(route, request);
  EXPECT_EQ(sharp.route, (Polyline{route[0], route[2], route[4]}));
}

TEST(WaypointReduction, TurnsFromTheHeadingAtTheStart) {
  // The host passes this after a via point: the heading of the leg that leads to it.
  const Polyline route{{0, 0, 0}, {0, 5, 0}, {5, 8, 0}, {10, 8, 0}};
  Request request = past({}, route);
  const auto reduced = [&](const char* parameters) {
    return make_smoother("waypoint_reduction", parameters)->smooth(route, request);
  };
  EXPECT_EQ(reduced("{}").route, (Polyline{route[0], route[3]}));
  request.start.velocity = {-10, 0, 0};
  EXPECT_EQ(reduced("{}").route, (Polyline{route[0], route[1], route[3]}));
  EXPECT_EQ(counter(reduced("{}"), "points_without_end"), 0);
  EXPECT_EQ(reduced("{max_turn_deg: 60}").route, route);
  EXPECT_EQ(counter(reduced("{max_turn_deg: 60}"), "points_without_end"), 1);
}

TEST(WaypointReduction, KeepsTheNextPointWhereNoEndIsAdmissible) {
  // No later point is within 60 degrees of the leg along the wall.
  const Polyline route{{0, 0, 0}, {10, 0, 0}, {9, 4, 0}, {6, 8, 0}};
  const PlanResult result = make_smoother("waypoint_reduction", "{max_turn_deg: 60}")
                                ->smooth(route, past({BoxShape{{{-5, 1, -1}, {8, 2, 1}}}}, route));
  EXPECT_EQ(result.route, route);
  EXPECT_EQ(counter(result, "points_without_end"), 1);
  EXPECT_EQ(result.message,
            "4 of 4 waypoints kept; from 1 point no leg to a later one is admissible, so the next "
            "one is kept");
}

TEST(WaypointReduction, IsTheDefinitionOnRandomRoutes) {
  RandomStream random(31);
  const auto reduction = make_smoother("waypoint_reduction");
  int shorter = 0;
  for (int n = 0; n < 200; ++n) {
    std::vector<Shape> discs;
    for (int i = 0; i < 8; ++i) {
      discs.push_back(Cylinder{random.uniform(0, 100), random.uniform(0, 100), 8});
    }
    Polyline route;
    for (int tries = 0; tries < 400 && route.size() < 12; ++tries) {
      const Vec3 p(random.uniform(0, 100), random.uniform(0, 100), 0);
      if (!testing::world_of(discs).blocked(route.empty() ? p : route.back(), p, 0)) {
        route.push_back(p);
      }
    }
    const Request request = past(discs, route);
    Polyline expected{route[0]};
    for (std::size_t begin = 0; begin + 1 < route.size();) {
      std::size_t end = route.size() - 1;
      const auto turns = [&] {
        return expected.size() > 1 &&
               (route[begin] - expected[expected.size() - 2])
                       .normalized()
                       .dot((route[end] - route[begin]).normalized()) < -1e-9;
      };
      while (end > begin + 1 && (turns() || request.world->blocked(route[begin], route[end], 0))) {
        --end;
      }
      begin = end;
      expected.push_back(route[begin]);
    }
    const PlanResult result = reduction->smooth(route, request);
    EXPECT_EQ(result.route, expected) << n;
    shorter += result.route.size() < route.size();
  }
  EXPECT_GT(shorter, 100);
}

TEST(WaypointReduction, KeepsTheTurnLimitOfTheRequest) {
  Request request = past({kBelow}, kOver);
  request.limits.max_turn_horizontal = radians(65);  // 3 points would turn by 80 degrees
  ASSERT_TRUE(check(kOver, request).ok());
  const Route reduced = make_smoother("waypoint_reduction")->smooth(kOver, request).route;
  EXPECT_EQ(reduced.size(), 4U);
  EXPECT_TRUE(check(reduced, request).ok());
}

TEST(WaypointReduction, LeavesTheRouteWhereARuleWouldBreak) {
  // Half around a disc in turns of 20 degrees: after a long leg every other one turns by 25 or
  // more.
  Polyline route;
  for (int degree = 180; degree >= 0; degree -= 20) {
    route.emplace_back(40 * std::cos(radians(degree)), 40 * std::sin(radians(degree)), 0);
  }
  Request request = past({Cylinder{0, 0, 19.9}}, route);
  EXPECT_LT(make_smoother("waypoint_reduction")->smooth(route, request).route.size(), 5U);
  request.limits.max_turn_horizontal = radians(25);
  const PlanResult result = make_smoother("waypoint_reduction")->smooth(route, request);
  EXPECT_EQ(result.route, route);
  EXPECT_EQ(
      result.message,
      "the reduced route would violate a constraint, or violate it more: the route is unchanged");
}

TEST(WaypointReduction, LeavesTheRouteWhereTheBudgetEnds) {
  Request request = past({kBelow}, kOver);
  request.budget.max_iterations = 3;
  const PlanResult result = make_smoother("waypoint_reduction")->smooth(kOver, request);
  EXPECT_TRUE(result.budget_hit);
  EXPECT_EQ(result.route, kOver);
}

TEST(WaypointReduction, RefusesWrongParameters) {
  EXPECT_NE(testing::parameter_problems("smoother", "waypoint_reduction", "{max_turn_deg: 181}"),
            "");
  EXPECT_NE(testing::parameter_problems("smoother", "waypoint_reduction", "{max_turn: 90}"), "");
}
}  // namespace
}  // namespace altiplan::waypoint_reduction_test
