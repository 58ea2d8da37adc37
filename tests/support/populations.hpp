// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "altiplan/check.hpp"
#include "support/support.hpp"

namespace altiplan::testing {

/// A column between start and goal.
inline Request around_a_column() {
  return request_in(world_of(std::vector<Shape>{Cylinder{500, 10, 120}}), {0, 0, 100},
                    {1000, 0, 100}, {{0, -400, 50}, {1000, 400, 150}});
}

/// A planner of 4,000 routes of three waypoints.
inline std::unique_ptr<Planner> population_planner(const std::string& name,
                                                   const std::string& more = "") {
  return make_planner(name, "{waypoints: 3, evaluations: 4000, encoding: cartesian" + more + "}");
}

inline void expect_route_around_a_column(const std::string& name) {
  const Request request = around_a_column();
  const PlanResult result = population_planner(name)->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_LT(length(result.route), 1700);
  EXPECT_EQ(counter(result, "expanded"), 4000);
}

inline void expect_one_result_for_any_number_of_threads(const std::string& name) {
  Request request = around_a_column();
  const PlanResult alone = population_planner(name)->plan(request);
  request.threads = 3;
  EXPECT_EQ(alone.route, population_planner(name)->plan(request).route);
}

/// An evaluation is an iteration, and more of them never give a longer route.
inline void expect_budget_of_evaluations(const std::string& name) {
  Request request = around_a_column();
  double before = kInfinity;
  for (const std::uint64_t budget : {300U, 1000U, 2777U}) {
    request.budget.max_iterations = budget;
    const PlanResult result = population_planner(name)->plan(request);
    EXPECT_EQ(counter(result, "expanded"), std::int64_t(budget));
    EXPECT_TRUE(result.budget_hit);
    const double now = result.status == PlanStatus::solved ? length(result.route) : kInfinity;
    EXPECT_LE(now, before);
    before = now;
  }
}
}  // namespace altiplan::testing
