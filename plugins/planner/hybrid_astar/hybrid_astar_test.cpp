// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "reference/wing_problems.hpp"

namespace altiplan::hybrid_astar_test {
namespace {

using testing::between;
using testing::make_planner;

TEST(HybridAstar, InTheOpenItIsTheDubinsPath) {
  testing::expect_the_dubins_path_in_the_open("hybrid_astar");
}

TEST(HybridAstar, RoutesAmongTowersAreValidInCalmAndWind) {
  testing::expect_valid_routes_among_towers("hybrid_astar", "{}", 0.8, 20'000);
}

TEST(HybridAstar, JoinsLegsTangentiallyInLayersOfWind) {
  testing::expect_no_corners_in_layers("hybrid_astar", "{}", 20'000);
}

TEST(HybridAstar, LeavesAndJoinsLoiterCirclesTangentially) {
  testing::expect_loiter_circles_left_and_joined("hybrid_astar", 0.8, 20'000);
}

TEST(NightlyHybridAstar, IsHeldToMore) {
  testing::expect_valid_routes_among_towers("hybrid_astar", "{}", 0.8, 20'000, 40);
  testing::expect_no_corners_in_layers("hybrid_astar", "{}", 20'000, 24);
  testing::expect_loiter_circles_left_and_joined("hybrid_astar", 0.8, 20'000, 30);
}

TEST(HybridAstar, BetweenLoiterCirclesInTheOpenItIsNoLongerThanTheTangent) {
  testing::expect_the_shortest_between_loiter_circles("hybrid_astar");
}

TEST(HybridAstar, ClimbsInCirclesWhereThereIsNoRoom) {
  const Pose from{{0, 0, 10}, 0};
  const Pose to{{300, 0, 390}, 0};
  const Request request = between(from, to);
  const PlanResult result = make_planner("hybrid_astar")->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_GE(length(result.route), 380 / std::sin(radians(8)) * (1 - 1e-9));
}

TEST(HybridAstar, ReportsAWindThatItCannotFlyIn) {
  testing::expect_a_wind_too_strong_reported("hybrid_astar");
}

TEST(HybridAstar, SaysSoonThatAGoalsHeadingCannotBeMet) {
  // Ten metres inside the western border, heading east.
  const Request request = between({{0, 0, 100}, 0}, {{-1990, 500, 200}, 0});
  const PlanResult result = make_planner("hybrid_astar")->plan(request);
  EXPECT_EQ(result.status, PlanStatus::no_route);
  EXPECT_NE(result.message.find("the goal can be reached: 1: check its heading"), std::string::npos)
      << result.message;
  EXPECT_LT(testing::counter(result, "expanded"), 10'000);
}

World ring_around(const Vec3& p) {
  std::vector<Shape> towers;
  for (int n = 0; n < 30; ++n) {
    const Vec3 at = p + 300 * unit_heading(2 * kPi * n / 30);
    towers.push_back(Cylinder{at.x(), at.y(), 60, 0, 600});
  }
  return testing::world_of(towers);
}

TEST(HybridAstar, NamesWhatShutsAnEndIn) {
  for (const bool is_start : {true, false}) {
    const Pose inside{{1200, 0, 100}, 0};
    const Pose outside{{-1500, 0, 100}, 0};
    Request request = is_start ? between(inside, outside, ring_around(inside.position))
                               : between(outside, inside, ring_around(inside.position));
    const PlanResult result = make_planner("hybrid_astar")->plan(request);
    EXPECT_EQ(result.status, PlanStatus::no_route);
    const std::string who = is_start ? "the start" : "the goal";
    EXPECT_NE(result.message.find("no route: " + who + " is shut in on "), std::string::npos)
        << result.message;
    EXPECT_NE(result.message.find("around which are refused 'shapes' ("), std::string::npos)
        << result.message;
  }
}

TEST(HybridAstar, DoesNotClimbForNothingWhereNothingLimitsClimbs) {
  // A wall with a gap: around its corners it is 3,386 m.
  const World wall =
      testing::world_of({Prism{{{2000, -5000}, {2040, -5000}, {2040, -50}, {2000, -50}}},
                         Prism{{{2000, 50}, {2040, 50}, {2040, 5000}, {2000, 5000}}}});
  Request request = testing::request_in(wall, {400, 600, 150}, {3600, 600, 150},
                                        {{0, -1000, 0}, {4000, 1000, 400}});
  request.limits.min_turn_radius = 60;
  const PlanResult result = make_planner("hybrid_astar")->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_LT(length(result.route), 1.2 * 3386);
}

TEST(HybridAstar, EqualRequestsGiveEqualRoutes) {
  RandomStream random(9);
  Request request =
      between({{-1500, -1500, 100}, 0}, {{1500, 1500, 200}, 1}, testing::random_towers(random, 30));
  request.budget.max_iterations = 5000;
  const auto planner = make_planner("hybrid_astar");
  EXPECT_EQ(planner->plan(request).route, planner->plan(request).route);
}
}  // namespace
}  // namespace altiplan::hybrid_astar_test
