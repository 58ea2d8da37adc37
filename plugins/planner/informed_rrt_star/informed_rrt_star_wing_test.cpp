// SPDX-License-Identifier: Apache-2.0
#include "reference/wing_star_planners.hpp"

namespace altiplan::informed_rrt_star_wing_test {
namespace {

constexpr const char* kPlanner = "informed_rrt_star";

TEST(InformedRrtStarWing, InTheOpenItIsTheDubinsPath) {
  testing::expect_the_dubins_path_in_the_open(kPlanner);
}
TEST(InformedRrtStarWing, RoutesAmongTowersAreValidInCalmAndWind) {
  testing::expect_valid_routes_among_towers(kPlanner, "{}", 0.8, 3'000);
}

TEST(InformedRrtStarWing, JoinsLegsTangentiallyInLayersOfWind) {
  testing::expect_no_corners_in_layers(kPlanner, "{}", 3'000);
}
TEST(InformedRrtStarWing, MoreIterationsNeverGiveALongerRoute) {
  testing::expect_no_longer_with_more_iterations(kPlanner, {1'000, 2'000, 4'000});
}
TEST(InformedRrtStarWing, ReportsAWindThatItCannotFlyIn) {
  testing::expect_a_wind_too_strong_reported(kPlanner);
}
TEST(InformedRrtStarWing, LeavesAndJoinsLoiterCirclesTangentially) {
  testing::expect_loiter_circles_left_and_joined(kPlanner, 0.8, 3'000);
}

TEST(NightlyInformedRrtStarWing, IsHeldToMore) {
  testing::expect_valid_routes_among_towers(kPlanner, "{}", 0.8, 3'000, 40);
  testing::expect_no_corners_in_layers(kPlanner, "{}", 3'000, 24);
  testing::expect_loiter_circles_left_and_joined(kPlanner, 0.8, 3'000, 30);
}
TEST(InformedRrtStarWing, BetweenLoiterCirclesInTheOpenItIsNoLongerThanTheTangent) {
  testing::expect_the_shortest_between_loiter_circles(kPlanner);
}
TEST(InformedRrtStarWing, StraightLegsLeaveNoLoiterCircle) {
  testing::expect_straight_legs_leave_no_loiter_circle(kPlanner);
}
TEST(InformedRrtStarWing, WithoutAHeadingAtTheEndsTheBestIsChosen) {
  testing::expect_the_best_of_free_headings(kPlanner);
}
TEST(InformedRrtStarWing, SteeringStraightGivesAPolyline) {
  testing::expect_a_polyline_if_steered_straight(kPlanner);
}
}  // namespace
}  // namespace altiplan::informed_rrt_star_wing_test
