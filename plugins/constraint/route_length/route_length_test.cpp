// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan::testing::route_length_test {
namespace {

/// A problem from west to east under the constraint, in a world with nothing else.
Request problem(const std::string& yaml, AppliesTo to = AppliesTo::route) {
  Request request =
      request_in(World(), {0, 0, 100}, {1000, 0, 100}, {{-500, -500, 0}, {1500, 500, 1000}});
  apply_constraints(request, {{"route_length", make_constraint("route_length", yaml)}}, to);
  return request;
}

TEST(RouteLength, RefusesWrongParameters) {
  EXPECT_EQ(parameter_problems("constraint", "route_length", "{max_ratio: 1}"), "");
  EXPECT_NE(parameter_problems("constraint", "route_length", "{}"), "");
  EXPECT_NE(parameter_problems("constraint", "route_length", "{max_m: 0}"), "");
  EXPECT_NE(parameter_problems("constraint", "route_length", "{max_ratio: 0.9}"), "");
  EXPECT_NE(parameter_problems("constraint", "route_length", "{max_m: 2000, max_ratio: 2}"), "");
}

TEST(RouteLength, OnlyTightens) {
  Limits limits;
  const Request request = problem("{max_ratio: 9}");
  make_constraint("route_length", "{max_ratio: 1.5}")->tighten(limits, request);
  EXPECT_DOUBLE_EQ(limits.max_route_length, 1500);
  make_constraint("route_length", "{max_m: 2000}")->tighten(limits, request);
  EXPECT_DOUBLE_EQ(limits.max_route_length, 1500);
  make_constraint("route_length", "{max_m: 1200}")->tighten(limits, request);
  EXPECT_DOUBLE_EQ(limits.max_route_length, 1200);
}

TEST(RouteLength, TheJudgeSumsTheLegs) {
  // Two sides of a rectangle whose diagonal is 1000 m: 600 m and 800 m.
  const Route route{{0, 0, 100}, {360, 480, 100}, {1000, 0, 100}};
  EXPECT_TRUE(check(route, problem("{max_m: 1400}")).ok());
  const CheckResult result = check(route, problem("{max_ratio: 1.39}"));
  ASSERT_EQ(result.violations.size(), 1u);
  EXPECT_EQ(result.violations[0].constraint, "route_length");
  EXPECT_NEAR(result.violations[0].value, 1400, 1e-6);
  EXPECT_NEAR(result.violations[0].limit, 1390, 1e-6);
}

TEST(RouteLength, HoldsForTracksToo) {
  EXPECT_EQ(problem("{max_m: 2000}", AppliesTo::track).limits.max_route_length, 2000);
}

}  // namespace
}  // namespace altiplan::testing::route_length_test
