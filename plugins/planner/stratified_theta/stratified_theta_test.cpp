// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "reference/any_angle_planners.hpp"
#include "reference/paper_cities.hpp"

namespace altiplan::stratified_theta_test {
namespace {

using testing::expect_sound;
using testing::in_city;
using testing::make_planner;

/// Number of the first cities that have a route; each route is judged.
int solved_of(int cities, bool complex, bool limits, const std::string& yaml) {
  const auto planner = make_planner("stratified_theta", yaml);
  int solved = 0;
  for (int seed = 0; seed < cities; ++seed) {
    Request request = in_city(complex, std::uint64_t(seed));
    if (limits) {
      request = testing::with_paper_limits(std::move(request));
    }
    const PlanResult result = planner->plan(request);
    solved += result.status == PlanStatus::solved;
    if (result.status == PlanStatus::solved) {
      expect_sound(result, request);
      EXPECT_EQ(result.route.back(), request.goal.position);
    }
  }
  return solved;
}

TEST(StratifiedTheta, RouteConsistentAnglesLeadToMostGoals) {
  EXPECT_EQ(solved_of(20, false, true, "{}"), 20);
  EXPECT_GE(solved_of(60, true, true, "{}"), 51);
}
TEST(StratifiedTheta, CompleteAnglesLeadToEveryGoal) {
  EXPECT_EQ(solved_of(25, true, true, "{angle_rule: complete}"), 25);
}
TEST(StratifiedTheta, WithoutLimitsLevelsAndCorridorsLeadToEveryGoal) {
  EXPECT_EQ(solved_of(25, true, false, "{}"), 25);
  EXPECT_EQ(solved_of(25, true, false, "{refine: corridor}"), 25);
}
TEST(StratifiedTheta, KeepsTurnAndClimbLimitsInOpenSpace) {
  testing::expect_limits_kept("stratified_theta");
}
TEST(StratifiedTheta, KeepsALimitOnLength) {
  testing::expect_a_limit_on_length_kept("stratified_theta");
}
TEST(StratifiedTheta, JoinsTheEndsWhereverTheyAre) {
  testing::expect_the_ends_joined_wherever_they_are("stratified_theta");
}

TEST(StratifiedTheta, MoreStartingLevelsAreNeverLonger) {
  const auto one = make_planner("stratified_theta");
  const auto three = make_planner("stratified_theta", "{start_levels: 3}");
  for (std::uint64_t seed = 0; seed < 15; ++seed) {
    const Request request = in_city(true, seed);
    EXPECT_LE(length(three->plan(request).route), length(one->plan(request).route)) << seed;
  }
}

TEST(StratifiedTheta, ANearGoalIsTriedStraight) {
  Request request = in_city(false, 0);
  request.goal.position = request.start.position + Vec3(0, 0, 130);
  const PlanResult near = make_planner("stratified_theta")->plan(request);
  ASSERT_EQ(near.status, PlanStatus::solved);
  EXPECT_EQ(near.route.size(), 2u);
  EXPECT_EQ(near.counters.front().value, 0);
  const PlanResult limited = make_planner("stratified_theta", "{d_limit_m: 100}")->plan(request);
  EXPECT_GT(limited.counters.front().value, 0);
}

TEST(StratifiedTheta, ACorridorLeadsToAGoalWhoseBlockIsClosed) {
  // The goal is free, but next to a house whose cells fill its block.
  Request request =
      testing::request_in(testing::world_of({BoxShape{{{405, 105, -1}, {795, 495, 395}}}}),
                          {5, 305, 105}, {403, 305, 105}, {{0, 0, 0}, {1000, 600, 400}});
  const auto planner =
      make_planner("stratified_theta", "{cell_m: [10, 10, 10], refine: corridor, d_limit_m: 0}");
  const PlanResult result = planner->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_EQ(result.route.size(), 2u);
  expect_sound(result, request);
}

TEST(StratifiedTheta, ACorridorThatLeadsNowhereLeavesTheTolerance) {
  // A wall thicker than a block; the goal is behind it, ends within the tolerance are not.
  Request request =
      testing::request_in(testing::world_of({BoxShape{{{200, -1, -1}, {400, 101, 101}}}}),
                          {5, 55, 55}, {455, 55, 55}, {{0, 0, 0}, {600, 100, 100}});
  const auto planner = make_planner("stratified_theta", "{cell_m: [10, 10, 10], refine: corridor}");
  const PlanResult none = planner->plan(request);
  EXPECT_EQ(none.status, PlanStatus::no_route);
  EXPECT_GT(none.counters.front().value, 0) << none.message;
  request.goal.tolerance_m = 300;
  const PlanResult near = planner->plan(request);
  ASSERT_EQ(near.status, PlanStatus::solved) << near.message;
  expect_sound(near, request);
}

TEST(StratifiedTheta, BudgetsAreKept) {
  const auto planner = make_planner("stratified_theta");
  Request request = in_city(true, 2);
  request.budget.max_iterations = 1;
  const PlanResult cut = planner->plan(request);
  EXPECT_EQ(cut.status, PlanStatus::timed_out);
  EXPECT_TRUE(cut.budget_hit);
  // Levels are no longer examined.
  request.budget.max_iterations = 0;
  const PlanResult none = planner->plan(request);
  EXPECT_EQ(none.status, PlanStatus::timed_out);
  EXPECT_EQ(none.counters.front().value, 0);
  std::stop_source stop;
  stop.request_stop();
  request.budget = {};
  request.budget.stop = stop.get_token();
  EXPECT_EQ(planner->plan(request).status, PlanStatus::cancelled);
  // Once a level has a route, the remaining budget refines it.
  request.budget = {};
  const PlanResult whole = planner->plan(request);
  request.budget.max_iterations = std::uint64_t(whole.counters.front().value) - 1;
  const PlanResult rough = planner->plan(request);
  ASSERT_EQ(rough.status, PlanStatus::solved) << rough.message;
  EXPECT_TRUE(rough.budget_hit);
  EXPECT_LE(rough.counters.front().value, whole.counters.front().value);
  expect_sound(rough, request);
}

TEST(StratifiedTheta, AStartLevelThatTheBudgetEndsIsTold) {
  const auto planner = make_planner("stratified_theta", "{start_levels: 3}");
  Request request = in_city(true, 2);
  const PlanResult whole = planner->plan(request);
  EXPECT_FALSE(whole.budget_hit);
  request.budget.max_iterations = std::uint64_t(whole.counters.front().value) - 1;
  const PlanResult cut = planner->plan(request);
  ASSERT_EQ(cut.status, PlanStatus::solved) << cut.message;
  EXPECT_TRUE(cut.budget_hit);
}

TEST(NightlyStratifiedTheta, SharesOfGoalsReachedUnderThePapersLimits) {
  EXPECT_EQ(solved_of(400, false, true, "{}"), 400);
  EXPECT_GE(solved_of(400, true, true, "{}"), 340);
  EXPECT_GE(solved_of(400, true, true, "{angle_rule: complete}"), 398);
  EXPECT_EQ(solved_of(400, true, false, "{}"), 400);
  EXPECT_EQ(solved_of(400, true, false, "{refine: corridor}"), 400);
}
}  // namespace
}  // namespace altiplan::stratified_theta_test
