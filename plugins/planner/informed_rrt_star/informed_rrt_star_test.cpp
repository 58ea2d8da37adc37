// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan {
namespace {

using testing::make_planner;

/// Cells with a wall that leaves a gap at either side, one much nearer.
Request around_a_wall() {
  return testing::draw({"..........\n..........\n..........\n.########.\n....S.....\n..........\n"
                        "..........",
                        "..........\n....G.....\n..........\n.########.\n..........\n..........\n"
                        ".........."},
                       10)
      .request;
}

TEST(InformedRrtStar, FindsTheNearerGap) {
  const Request request = around_a_wall();
  const PlanResult result =
      make_planner("informed_rrt_star", "{max_iterations: 8000}")->plan(request);
  ASSERT_EQ(result.status, Status::solved);
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_LT(length(result.route), 108);
  EXPECT_FALSE(result.budget_hit);
}

TEST(InformedRrtStar, UsesTheWholeBudget) {
  Request request = around_a_wall();
  request.budget.max_iterations = 3000;
  const PlanResult result = make_planner("informed_rrt_star")->plan(request);
  ASSERT_EQ(result.status, Status::solved);
  EXPECT_TRUE(result.budget_hit);
  EXPECT_EQ(result.counters.front().value, 3000);
}

TEST(InformedRrtStar, IsShorterThanRrtStarAfterTheSameSamples) {
  Request request = around_a_wall();
  double informed = 0;
  double plain = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    request.random = RandomStream(seed);
    informed +=
        length(make_planner("informed_rrt_star", "{max_iterations: 4000}")->plan(request).route);
    plain += length(make_planner("rrt_star", "{max_iterations: 4000}")->plan(request).route);
  }
  EXPECT_LT(informed, plain);
}
}  // namespace
}  // namespace altiplan
