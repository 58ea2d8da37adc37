// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "reference/any_angle_planners.hpp"

namespace altiplan::lazy_theta_star_test {
namespace {

TEST(LazyThetaStar, IsNeverLongerThanTheGrid) {
  testing::expect_never_longer_than_the_grid("lazy_theta_star", 400);
}
TEST(LazyThetaStar, IsNearlyTheShortestOfAll) {
  testing::expect_nearly_the_shortest("lazy_theta_star", 5);
}
TEST(NightlyLazyThetaStar, IsNearlyTheShortestOfAll) {
  testing::expect_nearly_the_shortest("lazy_theta_star", 20);
}
TEST(LazyThetaStar, KeepsTurnAndClimbLimits) { testing::expect_limits_kept("lazy_theta_star"); }
TEST(LazyThetaStar, TheRuleAsPrintedProvesNothing) {
  testing::expect_no_proof_by_the_printed_rule("lazy_theta_star");
}
TEST(LazyThetaStar, KeepsALimitOnLength) {
  testing::expect_a_limit_on_length_kept("lazy_theta_star");
}
TEST(LazyThetaStar, JoinsTheEndsWhereverTheyAre) {
  testing::expect_the_ends_joined_wherever_they_are("lazy_theta_star");
}
TEST(LazyThetaStar, BudgetAndRefusalsAreTold) {
  testing::expect_budget_and_refusals_told("lazy_theta_star");
}
TEST(LazyThetaStar, WaysFarLongerThanTheMapIsWide) {
  testing::expect_long_ways_found("lazy_theta_star");
}

/// A cell that got a longer path than the one it was queued for must not be popped in an older
/// position of the queue.
TEST(LazyThetaStar, ACellWhoseLegIsRefusedWaitsForTheLengthItHas) {
  const testing::Drawn drawn =
      testing::draw({"....\n....\n....\n....\n..S.\n#.##", "...#\n....\n.#..\n....\n.#..\n#...",
                     "....\n..#.\n....\n.#..\n.##.\n....", "....\n....\n....\n....\n..#.\n....",
                     "....\n....\n..#.\n..#.\n#...\n....", "..#.\n....\n.G..\n....\n..#.\n....",
                     "....\n...#\n....\n.#..\n..#.\n...."});
  const auto length_by = [&](const char* planner, const char* parameters) {
    return length(testing::make_planner(planner, parameters)->plan(drawn.request).route);
  };
  const double on_the_grid = length_by("astar", "{corner: free_box}");
  EXPECT_NEAR(on_the_grid, 2 + 3 * std::sqrt(2.0), 1e-9);
  EXPECT_LE(length_by("lazy_theta_star", "{}"), on_the_grid * (1 + 1e-9));
}

TEST(NightlyLazyThetaStar, IsNeverLongerThanTheGridInThePapersCities) {
  const auto grid = testing::make_planner("astar", "{corner: free_box}");
  const auto any_angle = testing::make_planner("lazy_theta_star");
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const Request request = testing::in_city(seed % 2 == 0, seed);
    const PlanResult result = any_angle->plan(request);
    ASSERT_EQ(result.status, PlanStatus::solved) << seed;
    testing::expect_sound(result, request);
    EXPECT_LE(length(result.route), length(grid->plan(request).route) * (1 + 1e-9)) << seed;
  }
}
}  // namespace
}  // namespace altiplan::lazy_theta_star_test
