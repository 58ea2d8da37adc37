// SPDX-License-Identifier: Apache-2.0
#include "reference/wing_star_planners.hpp"

namespace altiplan::rrt_star_wing_test {
namespace {

constexpr const char* kPlanner = "rrt_star";

TEST(RrtStarWing, InTheOpenItIsTheDubinsPath) {
  testing::expect_the_dubins_path_in_the_open(kPlanner);
}
TEST(RrtStarWing, RoutesAmongTowersAreValidInCalmAndWind) {
  testing::expect_valid_routes_among_towers(kPlanner, "{}", 0.8, 5'000);
}

TEST(RrtStarWing, JoinsLegsTangentiallyInLayersOfWind) {
  testing::expect_no_corners_in_layers(kPlanner, "{}", 5'000);
}
TEST(RrtStarWing, MoreIterationsNeverGiveALongerRoute) {
  testing::expect_no_longer_with_more_iterations(kPlanner, {1'000, 4'000, 16'000});
}
TEST(RrtStarWing, ReportsAWindThatItCannotFlyIn) {
  testing::expect_a_wind_too_strong_reported(kPlanner);
}
TEST(RrtStarWing, LeavesAndJoinsLoiterCirclesTangentially) {
  testing::expect_loiter_circles_left_and_joined(kPlanner, 0.8, 3'000);
}

TEST(NightlyRrtStarWing, IsHeldToMore) {
  testing::expect_valid_routes_among_towers(kPlanner, "{}", 0.8, 5'000, 40);
  testing::expect_no_corners_in_layers(kPlanner, "{}", 5'000, 24);
  testing::expect_loiter_circles_left_and_joined(kPlanner, 0.8, 3'000, 30);
}
TEST(RrtStarWing, BetweenLoiterCirclesInTheOpenItIsNoLongerThanTheTangent) {
  testing::expect_the_shortest_between_loiter_circles(kPlanner);
}
TEST(RrtStarWing, StraightLegsLeaveNoLoiterCircle) {
  testing::expect_straight_legs_leave_no_loiter_circle(kPlanner);
}
TEST(RrtStarWing, WithoutAHeadingAtTheEndsTheBestIsChosen) {
  testing::expect_the_best_of_free_headings(kPlanner);
}
TEST(RrtStarWing, SteeringStraightGivesAPolyline) {
  testing::expect_a_polyline_if_steered_straight(kPlanner);
}
}  // namespace
}  // namespace altiplan::rrt_star_wing_test
