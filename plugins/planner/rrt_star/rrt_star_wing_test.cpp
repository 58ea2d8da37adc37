// SPDX-License-Identifier: Apache-2.0
#include "reference/wing_problems.hpp"

namespace altiplan {
namespace {

using testing::make_planner;

TEST(RrtStarWing, InTheOpenItIsTheDubinsPath) {
  testing::expect_the_dubins_path_in_the_open("rrt_star");
}

TEST(RrtStarWing, RoutesAmongTowersAreValidInCalmAndWind) {
  testing::expect_valid_routes_among_towers("rrt_star", "{}", 0.8, 5'000);
}

TEST(RrtStarWing, MoreIterationsNeverGiveALongerRoute) {
  RandomStream random(7);
  int improved = 0;
  for (int n = 0; n < 10; ++n) {
    Request request = testing::among_towers(random, 0);
    double before = kInfinity;
    for (const std::uint64_t iterations : {1'000, 4'000, 16'000}) {
      request.budget.max_iterations = iterations;
      const PlanResult result = make_planner("rrt_star", "{max_iterations: 100000}")->plan(request);
      const double now = result.status == PlanStatus::solved ? length(result.route) : kInfinity;
      EXPECT_LE(now, before * (1 + 1e-12)) << n;
      improved += now < before;
      before = now;
    }
  }
  EXPECT_GT(improved, 9);
}

TEST(RrtStarWing, ReportsAWindThatItCannotFlyIn) {
  testing::expect_a_wind_too_strong_reported("rrt_star");
}

TEST(RrtStarWing, LeavesAndJoinsLoiterCirclesTangentially) {
  testing::expect_loiter_circles_left_and_joined("rrt_star", 0.8, 3'000);
}

TEST(RrtStarWing, BetweenLoiterCirclesInTheOpenItIsNoLongerThanTheTangent) {
  testing::expect_the_shortest_between_loiter_circles("rrt_star");
}

TEST(RrtStarWing, StraightLegsLeaveNoLoiterCircle) {
  Request request = testing::between({{-900, 0, 200}, 0}, {{900, 300, 200}, 0});
  request.start.loiter = Loiter{100, 1};
  EXPECT_EQ(make_planner("rrt_star", "{steering: straight}")->plan(request).status,
            PlanStatus::invalid_problem);
  request.vehicle.wing.reset();
  const PlanResult result = make_planner("rrt_star")->plan(request);
  EXPECT_EQ(result.status, PlanStatus::invalid_problem);
  EXPECT_NE(result.message.find("wing"), std::string::npos) << result.message;
}

TEST(RrtStarWing, WithoutAHeadingAtTheEndsTheBestIsChosen) {
  Request request = testing::between({{-900, 0, 200}, 1}, {{900, 0, 200}, 2});
  request.start.velocity.setZero();
  request.goal.heading.reset();
  const PlanResult result = make_planner("rrt_star")->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_NEAR(length(result.route), 1800, 1e-3);
}

TEST(RrtStarWing, SteeringStraightGivesAPolyline) {
  const Request request = testing::between({{-900, 0, 200}, 0}, {{900, 300, 200}, 0});
  const PlanResult result = make_planner("rrt_star", "{steering: straight}")->plan(request);
  EXPECT_TRUE(result.route.is_straight());
}
}  // namespace
}  // namespace altiplan
