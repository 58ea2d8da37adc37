// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>

#include "reference/colonies.hpp"
#include "region_colony.hpp"

namespace altiplan::improved_ant_colony_test {
namespace {

using improved_ant_colony::candidates;
using improved_ant_colony::ring;
using testing::counter;
using testing::flat_world;
using testing::plan_of;

const std::string kName = "improved_ant_colony";
const std::string kCells = "cell_m: [5, 5, 10], ants: 30, iterations: 20, reach_cells: 5";

TEST(ImprovedAntColony, CandidatesOfThePaper) {
  EXPECT_EQ(candidates(8, 2), 24);
  EXPECT_EQ(candidates(8, 3), 16);
  EXPECT_EQ(candidates(8, 8), 8);
  EXPECT_EQ(candidates(1, 0), 8);
}

TEST(ImprovedAntColony, CandidatesLieOnTheBorderSymmetrically) {
  for (int reach = 1; reach <= 12; ++reach) {
    for (int spacing = 0; spacing <= 13; ++spacing) {
      std::set<std::array<int, 2>> all;
      for (const auto& [x, y] : ring(reach, spacing)) {
        EXPECT_EQ(std::max(std::abs(x), std::abs(y)), reach);
        all.insert({x, y});
      }
      EXPECT_EQ(std::int64_t(all.size()), candidates(reach, spacing));
      for (const auto& [x, y] : all) {
        EXPECT_TRUE(all.count({-x, y}) == 1 && all.count({y, x}) == 1);
      }
      EXPECT_TRUE(all.count({reach, 0}) == 1 && all.count({reach, reach}) == 1);
    }
  }
}

TEST(ImprovedAntColony, FindsAWayAroundABlock) {
  const Request request = flat_world();
  const PlanResult result = plan_of(kName, kCells, request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_EQ(counter(result, "alive"), 30);
  // The shortest route, around the corners (150, 320) and (250, 320), is 437.8 m long.
  EXPECT_GE(length(result.route), 437.8);
  EXPECT_LE(length(result.route), 1.05 * 437.8);
}

TEST(ImprovedAntColony, HowLegsAreTestedDoesNotMatter) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Request request = flat_world();
    request.random = RandomStream(seed);
    const PlanResult remembered = plan_of(kName, kCells, request);
    for (const std::string test : {"guard_zone", "always"}) {
      EXPECT_TRUE(
          testing::equal(remembered, plan_of(kName, kCells + ", leg_test: " + test, request)));
    }
  }
}

TEST(ImprovedAntColony, TrimmedRoutesAreShorter) {
  const Request request = flat_world();
  const double trimmed = length(plan_of(kName, kCells, request).route);
  const double as_walked = length(plan_of(kName, kCells + ", trim: false", request).route);
  EXPECT_LT(trimmed, as_walked);
}

TEST(ImprovedAntColony, LeastStepsSetTheReach) {
  const Request request = flat_world();
  // 350 m in cells of 5 m, eq. (6): ceil(70 / 14) = 5.
  EXPECT_TRUE(testing::equal(plan_of(kName, kCells, request),
                             plan_of(kName, kCells + ", min_steps: 14", request)));
  EXPECT_NE(testing::parameter_problems("planner", kName, "{reach_cells: 9, spacing_cells: 0}"),
            "");
}

TEST(ImprovedAntColony, OnNarrowLevelsStepsAreNoLongerThanTheReach) {
  Request request =
      testing::request_in(World(), {5, 5, 50}, {15, 975, 50}, {{0, 0, 50}, {30, 1000, 50}});
  request.level_m = 50;
  const PlanResult result = plan_of(
      kName, "cell_m: [10, 10, 10], reach_cells: 4, spacing_cells: 0, trim: false, ants: 20",
      request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  for (std::size_t n = 1; n < result.route.size(); ++n) {
    EXPECT_LE((result.route[n] - result.route[n - 1]).cwiseAbs().maxCoeff(), 40 + 1e-9);
  }
}

TEST(ImprovedAntColony, GeodesicDistancesLeadOutOfADeadEnd) {
  // A cup that opens away from the goal.
  Request request =
      testing::request_in(testing::world_of({Shape{BoxShape{{{300, 50, 0}, {320, 350, 100}}}},
                                             Shape{BoxShape{{{60, 50, 0}, {320, 70, 100}}}},
                                             Shape{BoxShape{{{60, 330, 0}, {320, 350, 100}}}}}),
                          {252.5, 202.5, 50}, {377.5, 202.5, 50}, {{0, 0, 50}, {400, 400, 50}});
  request.level_m = 50;
  const std::string few = "cell_m: [5, 5, 10], ants: 10, iterations: 3";
  EXPECT_EQ(plan_of(kName, few, request).status, PlanStatus::no_route);
  const PlanResult around = plan_of(kName, few + ", heuristic: geodesic", request);
  ASSERT_EQ(around.status, PlanStatus::solved) << around.message;
  EXPECT_EQ(counter(around, "alive"), 10);
  EXPECT_TRUE(check(around.route, request).ok());
}

TEST(ImprovedAntColony, AGoalBehindAWallIsNoRouteWithAnyHeuristic) {
  Request request = flat_world();
  request.world = std::make_shared<const World>(
      testing::world_of({Shape{BoxShape{{{190, -10, 0}, {210, 410, 100}}}}}));
  for (const std::string heuristic : {"euclidean", "geodesic"}) {
    const PlanResult result = plan_of(kName, kCells + ", heuristic: " + heuristic, request);
    EXPECT_EQ(result.status, PlanStatus::no_route) << heuristic;
    EXPECT_EQ(counter(result, "alive"), 0);
  }
}

TEST(ImprovedAntColony, OneResultForAnyNumberOfThreads) {
  testing::expect_one_result_for_any_threads(kName, kCells);
  testing::expect_one_result_for_any_threads(kName, kCells + ", heuristic: geodesic, trim: false");
}

TEST(ImprovedAntColony, MoreBudgetNeverGivesALongerRoute) {
  testing::expect_anytime(kName, kCells);
}

TEST(ImprovedAntColony, BudgetsOfStepsAreKeptToTheStep) {
  testing::expect_step_budgets_kept(kName, kCells);
}

TEST(ImprovedAntColony, AntsBeyondTheBudgetDoNotWalk) {
  testing::expect_no_work_beyond_the_budget(kName, "cell_m: [5, 5, 10], reach_cells: 5");
}

TEST(ImprovedAntColony, TheTraceTellsOfEveryIteration) {
  testing::expect_iterations_traced(kName, kCells);
}

TEST(ImprovedAntColony, MinimisesAnObjective) {
  testing::expect_objective_minimised(kName, kCells);
}

TEST(ImprovedAntColony, LimitsHold) { testing::expect_limits_hold(kName, kCells); }

TEST(ImprovedAntColony, CoursesHoldInStrongWind) { testing::expect_strong_wind_obeyed(kName); }

TEST(ImprovedAntColony, EndsOffTheCentresOfCells) { testing::expect_ends_joined(kName, kCells); }

TEST(ImprovedAntColony, RoulettesStayNumbersForHundredsOfIterations) {
  const std::string many = "cell_m: [5, 5, 10], ants: 10, iterations: 400, reach_cells: 5";
  testing::expect_roulettes_sound(kName, many);
  testing::expect_roulettes_sound(kName, many + ", deposit: cells, region_radius: 4");
}
}  // namespace
}  // namespace altiplan::improved_ant_colony_test
