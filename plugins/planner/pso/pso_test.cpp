// SPDX-License-Identifier: Apache-2.0
#include "support/populations.hpp"

namespace altiplan::pso_planner_test {
namespace {

TEST(PsoPlanner, FindsARouteAroundAColumn) { testing::expect_route_around_a_column("pso"); }

TEST(PsoPlanner, OneResultForAnyNumberOfThreads) {
  testing::expect_one_result_for_any_number_of_threads("pso");
}

TEST(PsoPlanner, AnEvaluationIsAnIterationOfTheBudget) {
  testing::expect_budget_of_evaluations("pso");
}
}  // namespace
}  // namespace altiplan::pso_planner_test
