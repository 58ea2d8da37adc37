// SPDX-License-Identifier: Apache-2.0
#include "support/populations.hpp"

namespace altiplan::differential_evolution_planner_test {
namespace {

TEST(DifferentialEvolutionPlanner, FindsARouteAroundAColumn) {
  testing::expect_route_around_a_column("differential_evolution");
}

TEST(DifferentialEvolutionPlanner, OneResultForAnyNumberOfThreads) {
  testing::expect_one_result_for_any_number_of_threads("differential_evolution");
}

TEST(DifferentialEvolutionPlanner, AnEvaluationIsAnIterationOfTheBudget) {
  testing::expect_budget_of_evaluations("differential_evolution");
}
}  // namespace
}  // namespace altiplan::differential_evolution_planner_test
