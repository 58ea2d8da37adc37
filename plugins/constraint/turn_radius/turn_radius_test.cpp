// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan::testing::turn_radius_test {
namespace {

/// A problem from west to east under the constraint, in a world with nothing else.
Request problem(const std::string& yaml, AppliesTo to = AppliesTo::route) {
  Request request =
      request_in(World(), {0, 0, 100}, {1000, 0, 100}, {{-500, -500, 0}, {1500, 500, 1000}});
  apply_constraints(request, {{"turn_radius", make_constraint("turn_radius", yaml)}}, to);
  return request;
}

TEST(TurnRadius, RefusesWrongParameters) {
  EXPECT_EQ(parameter_problems("constraint", "turn_radius", "{min_m: 200}"), "");
  EXPECT_NE(parameter_problems("constraint", "turn_radius", "{}"), "");
  EXPECT_NE(parameter_problems("constraint", "turn_radius", "{min_m: -1}"), "");
}

TEST(TurnRadius, OnlyTightens) {
  Limits limits;
  const Request request = problem("{min_m: 0}");
  make_constraint("turn_radius", "{min_m: 200}")->tighten(limits, request);
  EXPECT_EQ(limits.min_turn_radius, 200);
  make_constraint("turn_radius", "{min_m: 100}")->tighten(limits, request);
  EXPECT_EQ(limits.min_turn_radius, 200);
}

TEST(TurnRadius, TheJudgeMeasuresTheFilletOfHalfOfEachLeg) {
  // A right angle between legs of 500 sqrt(2) m: the circle that touches both at their middles.
  const double radius = 250 * std::sqrt(2);
  const Route route{{0, 0, 100}, {500, 500, 100}, {1000, 0, 100}};
  EXPECT_TRUE(check(route, problem("{min_m: 353.5}")).ok());
  const CheckResult result = check(route, problem("{min_m: 354}"));
  ASSERT_EQ(result.violations.size(), 1u);
  EXPECT_EQ(result.violations[0].constraint, "turn_radius");
  EXPECT_NEAR(result.violations[0].value, radius, 1e-6);
  EXPECT_NEAR(result.violations[0].limit, 354, 1e-6);
}

TEST(TurnRadius, HoldsForTracksToo) {
  EXPECT_EQ(problem("{min_m: 61}", AppliesTo::track).limits.min_turn_radius, 61);
}

}  // namespace
}  // namespace altiplan::testing::turn_radius_test
