// SPDX-License-Identifier: Apache-2.0
// What rrt_star and informed_rrt_star, one search, are both held to.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "altiplan/route.hpp"
#include "support/support.hpp"

namespace altiplan::testing {

/// Cells with a wall that leaves a gap at either side, one much nearer.
inline Request around_a_wall() {
  return draw({"..........\n..........\n..........\n.########.\n....S.....\n..........\n"
               "..........",
               "..........\n....G.....\n..........\n.########.\n..........\n..........\n"
               ".........."},
              10)
      .request;
}

inline void expect_the_nearer_gap(const std::string& planner) {
  const Request request = around_a_wall();
  const PlanResult result = make_planner(planner, "{max_iterations: 8000}")->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved);
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_LT(length(result.route), 108);
  EXPECT_FALSE(result.budget_hit);
}

inline void expect_the_whole_budget_used(const std::string& planner) {
  Request request = around_a_wall();
  request.budget.max_iterations = 3000;
  const PlanResult result = make_planner(planner)->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved);
  EXPECT_TRUE(result.budget_hit);
  EXPECT_EQ(result.counters.front().value, 3000);
}
}  // namespace altiplan::testing
