// SPDX-License-Identifier: Apache-2.0
#include "support/populations.hpp"

namespace altiplan::genetic_planner_test {
namespace {

TEST(GeneticPlanner, FindsARouteAroundAColumn) { testing::expect_route_around_a_column("genetic"); }

TEST(GeneticPlanner, OneResultForAnyNumberOfThreads) {
  testing::expect_one_result_for_any_number_of_threads("genetic");
}

TEST(GeneticPlanner, AnEvaluationIsAnIterationOfTheBudget) {
  testing::expect_budget_of_evaluations("genetic");
}
}  // namespace
}  // namespace altiplan::genetic_planner_test
