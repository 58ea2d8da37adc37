// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "reference/any_angle_planners.hpp"

namespace altiplan::theta_star_test {
namespace {

TEST(ThetaStar, IsNeverLongerThanTheGrid) {
  testing::expect_never_longer_than_the_grid("theta_star", 400);
}
TEST(ThetaStar, KeepsTurnAndClimbLimits) { testing::expect_limits_kept("theta_star"); }
TEST(ThetaStar, TheRuleAsPrintedProvesNothing) {
  testing::expect_no_proof_by_the_printed_rule("theta_star");
}
TEST(ThetaStar, KeepsALimitOnLength) { testing::expect_a_limit_on_length_kept("theta_star"); }
TEST(ThetaStar, JoinsTheEndsWhereverTheyAre) {
  testing::expect_the_ends_joined_wherever_they_are("theta_star");
}
TEST(ThetaStar, BudgetAndRefusalsAreTold) {
  testing::expect_budget_and_refusals_told("theta_star");
}
TEST(ThetaStar, WaysFarLongerThanTheMapIsWide) { testing::expect_long_ways_found("theta_star"); }
}  // namespace
}  // namespace altiplan::theta_star_test
