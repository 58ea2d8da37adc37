// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "reference/any_angle_planners.hpp"

namespace altiplan {
namespace {

TEST(LazyThetaStar, IsNeverLongerThanTheGrid) {
  testing::expect_never_longer_than_the_grid("lazy_theta_star", 400);
}
TEST(LazyThetaStar, KeepsTurnAndClimbLimits) { testing::expect_limits_kept("lazy_theta_star"); }
TEST(LazyThetaStar, JoinsTheEndsWhereverTheyAre) {
  testing::expect_the_ends_joined_wherever_they_are("lazy_theta_star");
}
TEST(LazyThetaStar, BudgetAndRefusalsAreTold) {
  testing::expect_budget_and_refusals_told("lazy_theta_star");
}
TEST(LazyThetaStar, WaysFarLongerThanTheMapIsWide) {
  testing::expect_long_ways_found("lazy_theta_star");
}
}  // namespace
}  // namespace altiplan
