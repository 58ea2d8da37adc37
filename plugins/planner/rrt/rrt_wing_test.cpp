// SPDX-License-Identifier: Apache-2.0
#include "reference/wing_problems.hpp"

namespace altiplan::rrt_wing_test {
namespace {

using testing::make_planner;

TEST(RrtWing, InTheOpenItIsTheDubinsPath) { testing::expect_the_dubins_path_in_the_open("rrt"); }

TEST(RrtWing, RoutesAmongTowersAreValidInCalmAndWind) {
  testing::expect_valid_routes_among_towers("rrt", "{}", 0.8, 20'000);
}

TEST(RrtWing, JoinsLegsTangentiallyInLayersOfWind) {
  testing::expect_no_corners_in_layers("rrt", "{}", 20'000);
}

TEST(RrtWing, LeavesAndJoinsLoiterCirclesTangentially) {
  testing::expect_loiter_circles_left_and_joined("rrt", 0.8, 20'000);
}

TEST(NightlyRrtWing, IsHeldToMore) {
  testing::expect_valid_routes_among_towers("rrt", "{}", 0.8, 20'000, 40);
  testing::expect_no_corners_in_layers("rrt", "{}", 20'000, 24);
  testing::expect_loiter_circles_left_and_joined("rrt", 0.8, 20'000, 30);
}

TEST(RrtWing, ReportsAWindThatItCannotFlyIn) { testing::expect_a_wind_too_strong_reported("rrt"); }

TEST(RrtWing, ASessionPlansFromTheNewPose) {
  RandomStream random(3);
  const Request request = testing::between({{-1500, 0, 200}, 0}, {{1500, 0, 200}, 0});
  const auto planner = make_planner("rrt");
  const auto session = planner->begin(request);
  ASSERT_EQ(session->result().status, PlanStatus::solved);
  Request later = request;
  later.start.position = {-1000, 100, 200};
  later.start.velocity = 20 * unit_heading(1);
  later.world = std::make_shared<const World>(testing::random_towers(random, 20));
  const PlanResult& result = session->update(later.start, later.goal, later.world, {}, Budget{});
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_TRUE(check(result.route, later).ok());
}
}  // namespace
}  // namespace altiplan::rrt_wing_test
