// SPDX-License-Identifier: Apache-2.0
#include "support/populations.hpp"

namespace altiplan::spso_planner_test {
namespace {

TEST(SpsoPlanner, FindsARouteAroundAColumn) { testing::expect_route_around_a_column("spso"); }

TEST(SpsoPlanner, OneResultForAnyNumberOfThreads) {
  testing::expect_one_result_for_any_number_of_threads("spso");
}

TEST(SpsoPlanner, AnEvaluationIsAnIterationOfTheBudget) {
  testing::expect_budget_of_evaluations("spso");
}
}  // namespace
}  // namespace altiplan::spso_planner_test
