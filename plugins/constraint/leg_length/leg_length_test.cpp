// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan::testing::leg_length_test {
namespace {

/// A problem from west to east under the constraint, in a world with nothing else.
Request problem(const std::string& yaml, AppliesTo to = AppliesTo::route) {
  Request request =
      request_in(World(), {0, 0, 100}, {1000, 0, 100}, {{-500, -500, 0}, {1500, 500, 1000}});
  apply_constraints(request, {{"leg_length", make_constraint("leg_length", yaml)}}, to);
  return request;
}

TEST(LegLength, RefusesWrongParameters) {
  EXPECT_EQ(parameter_problems("constraint", "leg_length", "{min_m: 100}"), "");
  EXPECT_NE(parameter_problems("constraint", "leg_length", "{}"), "");
  EXPECT_NE(parameter_problems("constraint", "leg_length", "{min_m: -1}"), "");
  EXPECT_NE(parameter_problems("constraint", "leg_length", "{max_m: 0}"), "");
  EXPECT_NE(parameter_problems("constraint", "leg_length", "{min_m: 3, max_m: 2}"), "");
}

TEST(LegLength, OnlyTightens) {
  Limits limits;
  const Request request = problem("{min_m: 0}");
  make_constraint("leg_length", "{min_m: 100, max_m: 500}")->tighten(limits, request);
  make_constraint("leg_length", "{min_m: 50}")->tighten(limits, request);
  make_constraint("leg_length", "{max_m: 800}")->tighten(limits, request);
  EXPECT_EQ(limits.min_leg, 100);
  EXPECT_EQ(limits.max_leg, 500);
}

TEST(LegLength, TheJudgeMeasuresEachLeg) {
  const Route route{{0, 0, 100}, {300, 0, 100}, {1000, 0, 100}};
  EXPECT_TRUE(check(route, problem("{min_m: 300, max_m: 700}")).ok());
  const CheckResult result = check(route, problem("{min_m: 301, max_m: 699}"));
  ASSERT_EQ(result.violations.size(), 2u);
  EXPECT_EQ(result.violations[0].constraint, "leg_length");
  EXPECT_NEAR(result.violations[0].value, 300, 1e-6);
  EXPECT_NEAR(result.violations[0].limit, 301, 1e-6);
  EXPECT_EQ(result.violations[1].at, 1u);
  EXPECT_NEAR(result.violations[1].limit, 699, 1e-6);
}

TEST(LegLength, LeavesTracksAlone) {
  EXPECT_EQ(problem("{min_m: 20}", AppliesTo::track).limits.min_leg, 0);
}

}  // namespace
}  // namespace altiplan::testing::leg_length_test
