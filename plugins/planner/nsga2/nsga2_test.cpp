// SPDX-License-Identifier: Apache-2.0
#include "support/populations.hpp"

namespace altiplan::nsga2_planner_test {
namespace {

TEST(Nsga2Planner, FindsARouteAroundAColumn) { testing::expect_route_around_a_column("nsga2"); }

TEST(Nsga2Planner, OneResultForAnyNumberOfThreads) {
  testing::expect_one_result_for_any_number_of_threads("nsga2");
}

TEST(Nsga2Planner, AnEvaluationIsAnIterationOfTheBudget) {
  testing::expect_budget_of_evaluations("nsga2");
}

/// The terms of an objective pull apart; of the compromises the run takes the one that costs least.
TEST(Nsga2Planner, TakesTheLeastSumOfTheTerms) {
  Request request = testing::around_a_column();
  request.objective = testing::make_objective("nmopso", "{}", *request.world);
  const PlanResult result = testing::population_planner("nsga2")->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_EQ(request.objective->costs(result.route, request).size(), 4U);
  EXPECT_LT(cost_of(result.route, request), 1);
}
}  // namespace
}  // namespace altiplan::nsga2_planner_test
