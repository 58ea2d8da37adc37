// SPDX-License-Identifier: Apache-2.0
#include "support/populations.hpp"

namespace altiplan::grey_wolf_planner_test {
namespace {

TEST(GreyWolfPlanner, FindsARouteAroundAColumn) {
  testing::expect_route_around_a_column("grey_wolf");
}

TEST(GreyWolfPlanner, OneResultForAnyNumberOfThreads) {
  testing::expect_one_result_for_any_number_of_threads("grey_wolf");
}

TEST(GreyWolfPlanner, AnEvaluationIsAnIterationOfTheBudget) {
  testing::expect_budget_of_evaluations("grey_wolf");
}
}  // namespace
}  // namespace altiplan::grey_wolf_planner_test
