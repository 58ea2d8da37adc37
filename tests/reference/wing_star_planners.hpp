// SPDX-License-Identifier: Apache-2.0
// What rrt_star and informed_rrt_star, one search, are both held to for a wing.
#pragma once

#include "reference/wing_problems.hpp"

namespace altiplan::testing {

inline void expect_no_longer_with_more_iterations(const std::string& planner,
                                                  const std::vector<std::uint64_t>& budgets) {
  RandomStream random(7);
  int improved = 0;
  for (int n = 0; n < 10; ++n) {
    Request request = among_towers(random, 0);
    double before = kInfinity;
    for (const std::uint64_t iterations : budgets) {
      request.budget.max_iterations = iterations;
      const PlanResult result = make_planner(planner, "{max_iterations: 100000}")->plan(request);
      const double now = result.status == PlanStatus::solved ? length(result.route) : kInfinity;
      EXPECT_LE(now, before * (1 + 1e-12)) << n;
      improved += now < before;
      before = now;
    }
  }
  EXPECT_GT(improved, 9);
}

inline void expect_straight_legs_leave_no_loiter_circle(const std::string& planner) {
  Request request = between({{-900, 0, 200}, 0}, {{900, 300, 200}, 0});
  request.start.loiter = Loiter{100, 1};
  EXPECT_EQ(make_planner(planner, "{steering: straight}")->plan(request).status,
            PlanStatus::invalid_problem);
  request.vehicle.wing.reset();
  const PlanResult result = make_planner(planner)->plan(request);
  EXPECT_EQ(result.status, PlanStatus::invalid_problem);
  EXPECT_NE(result.message.find("wing"), std::string::npos) << result.message;
}

inline void expect_the_best_of_free_headings(const std::string& planner) {
  Request request = between({{-900, 0, 200}, 1}, {{900, 0, 200}, 2});
  request.start.velocity.setZero();
  request.goal.heading.reset();
  const PlanResult result = make_planner(planner)->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_NEAR(length(result.route), 1800, 1e-3);
}

inline void expect_a_polyline_if_steered_straight(const std::string& planner) {
  const Request request = between({{-900, 0, 200}, 0}, {{900, 300, 200}, 0});
  const PlanResult result = make_planner(planner, "{steering: straight}")->plan(request);
  EXPECT_TRUE(result.route.is_straight());
}
}  // namespace altiplan::testing
