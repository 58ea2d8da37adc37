// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/check.hpp"
#include "reference/colonies.hpp"

namespace altiplan::ant_colony_test {
namespace {

using testing::counter;
using testing::flat_world;
using testing::make_planner;

const std::string kCells = "cell_m: [10, 10, 10], ants: 30, iterations: 20";

TEST(AntColony, FindsAWayAroundABlock) {
  const Request request = flat_world();
  const PlanResult result = make_planner("ant_colony", "{" + kCells + "}")->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_EQ(counter(result, "iterations"), 20);
  EXPECT_LE(counter(result, "alive"), 30);
  // A route over eight neighbours turns by multiples of 45 degrees.
  for (std::size_t n = 1; n < result.route.size(); ++n) {
    const Vec3 leg = (result.route[n] - result.route[n - 1]).cwiseAbs();
    EXPECT_LE(leg.maxCoeff(), 10 + 1e-9);
  }
}

TEST(AntColony, OneResultForAnyNumberOfThreads) {
  testing::expect_one_result_for_any_threads("ant_colony", kCells);
}

TEST(AntColony, MoreBudgetNeverGivesALongerRoute) { testing::expect_anytime("ant_colony", kCells); }

TEST(AntColony, BudgetsOfStepsAreKeptToTheStep) {
  testing::expect_step_budgets_kept("ant_colony", kCells);
}

TEST(AntColony, AntsBeyondTheBudgetDoNotWalk) {
  testing::expect_no_work_beyond_the_budget("ant_colony", "cell_m: [10, 10, 10]");
}

TEST(AntColony, TheTraceTellsOfEveryIteration) {
  testing::expect_iterations_traced("ant_colony", kCells);
}

TEST(AntColony, MinimisesAnObjective) { testing::expect_objective_minimised("ant_colony", kCells); }

TEST(AntColony, LimitsHold) { testing::expect_limits_hold("ant_colony", kCells); }

TEST(AntColony, CoursesHoldInStrongWind) { testing::expect_strong_wind_obeyed("ant_colony"); }

TEST(AntColony, EndsOffTheCentresOfCells) { testing::expect_ends_joined("ant_colony", kCells); }

TEST(AntColony, RoulettesStayNumbersForHundredsOfIterations) {
  testing::expect_roulettes_sound("ant_colony", "cell_m: [10, 10, 10], ants: 10, iterations: 400");
}

// Without a goal bias the ants wander until they are stuck.
TEST(AntColony, TheHeuristicAsPrintedLeadsNowhereOnLargeMaps) {
  Request request =
      testing::request_in(World(), {5, 5, 50}, {1995, 1995, 50}, {{0, 0, 50}, {2000, 2000, 50}});
  request.level_m = 50;
  for (const std::string heuristic : {"leg", "goal"}) {
    const PlanResult result =
        make_planner("ant_colony", "{cell_m: [10, 10, 10], ants: 20, iterations: 3, heuristic: " +
                                       heuristic + "}")
            ->plan(request);
    EXPECT_EQ(result.status, PlanStatus::no_route) << heuristic;
    EXPECT_EQ(counter(result, "alive"), 0);
    EXPECT_GT(counter(result, "stuck"), 0);
  }
  EXPECT_EQ(make_planner("ant_colony", "{cell_m: [10, 10, 10], ants: 20, iterations: 3}")
                ->plan(request)
                .status,
            PlanStatus::solved);
}

TEST(AntColony, AnAntOverTheLengthLimitDies) {
  const PlanResult result =
      make_planner("ant_colony", "{" + kCells + ", max_length_m: 300}")->plan(flat_world());
  EXPECT_EQ(result.status, PlanStatus::no_route);
  EXPECT_EQ(counter(result, "too_long") + counter(result, "stuck"), 30);
  EXPECT_GT(counter(result, "too_long"), 0);
  EXPECT_NE(result.message.find("300 m"), std::string::npos) << result.message;
}

TEST(AntColony, RefusesASpaceOfLevels) {
  Request request = flat_world();
  request.level_m.reset();
  request.volume.max.z() += 100;
  const PlanResult result = make_planner("ant_colony", "{" + kCells + "}")->plan(request);
  EXPECT_EQ(result.status, PlanStatus::invalid_problem);
  EXPECT_NE(result.message.find("level"), std::string::npos) << result.message;
}
}  // namespace
}  // namespace altiplan::ant_colony_test
