// SPDX-License-Identifier: Apache-2.0
#include "reference/wing_problems.hpp"

namespace altiplan::rrt_connect_wing_test {
namespace {

using testing::make_planner;

TEST(RrtConnectWing, InTheOpenItIsTheDubinsPath) {
  testing::expect_the_dubins_path_in_the_open("rrt_connect");
}

TEST(RrtConnectWing, RoutesAmongTowersAreValidInCalmAndWind) {
  testing::expect_valid_routes_among_towers("rrt_connect", "{}", 0.9, 8'000);
}

TEST(RrtConnectWing, JoinsLegsTangentiallyInLayersOfWind) {
  testing::expect_no_corners_in_layers("rrt_connect", "{}", 8'000);
}

TEST(RrtConnectWing, ReportsAWindThatItCannotFlyIn) {
  testing::expect_a_wind_too_strong_reported("rrt_connect");
}

TEST(RrtConnectWing, LeavesAndJoinsLoiterCirclesTangentially) {
  testing::expect_loiter_circles_left_and_joined("rrt_connect", 0.9, 5'000);
}

TEST(NightlyRrtConnectWing, IsHeldToMore) {
  testing::expect_valid_routes_among_towers("rrt_connect", "{}", 0.9, 8'000, 40);
  testing::expect_no_corners_in_layers("rrt_connect", "{}", 8'000, 24);
  testing::expect_loiter_circles_left_and_joined("rrt_connect", 0.9, 5'000, 30);
}

TEST(RrtConnectWing, BetweenLoiterCirclesInTheOpenItIsNoLongerThanTheTangent) {
  testing::expect_the_shortest_between_loiter_circles("rrt_connect");
}

TEST(RrtConnectWing, EndsWithinTheRouteLength) {
  RandomStream random(8);
  int solved = 0;
  for (int n = 0; n < 20; ++n) {
    Request request = testing::among_towers(random, n);
    request.limits.max_route_length = 1.5 * (request.goal.position - request.start.position).norm();
    const PlanResult result = make_planner("rrt_connect", "{max_iterations: 3000}")->plan(request);
    if (result.status == PlanStatus::solved) {
      ++solved;
      EXPECT_TRUE(check(result.route, request).ok());
    }
  }
  EXPECT_GT(solved, 3);
}

TEST(RrtConnectWing, ClimbsInCirclesWhereThereIsNoRoom) {
  const Request request = testing::between({{0, 0, 10}, 0}, {{300, 0, 390}, 0});
  const PlanResult result = make_planner("rrt_connect")->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_GE(length(result.route), 380 / std::sin(radians(8)) * (1 - 1e-9));
}
}  // namespace
}  // namespace altiplan::rrt_connect_wing_test
