// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan::testing::climb_angle_test {
namespace {

/// A problem from west to east under the constraint, in a world with nothing else.
Request problem(const std::string& yaml, AppliesTo to = AppliesTo::route) {
  Request request =
      request_in(World(), {0, 0, 100}, {1000, 0, 100}, {{-500, -500, 0}, {1500, 500, 1000}});
  apply_constraints(request, {{"climb_angle", make_constraint("climb_angle", yaml)}}, to);
  return request;
}

TEST(ClimbAngle, RefusesWrongParameters) {
  EXPECT_EQ(parameter_problems("constraint", "climb_angle", "{max_deg: 15}"), "");
  EXPECT_NE(parameter_problems("constraint", "climb_angle", "{}"), "");
  EXPECT_NE(parameter_problems("constraint", "climb_angle", "{max_deg: -1}"), "");
  EXPECT_NE(parameter_problems("constraint", "climb_angle", "{max_deg: 91}"), "");
}

TEST(ClimbAngle, OnlyTightens) {
  Limits limits;
  const Request request = problem("{max_deg: 90}");
  make_constraint("climb_angle", "{max_deg: 15}")->tighten(limits, request);
  EXPECT_DOUBLE_EQ(limits.max_climb, radians(15));
  make_constraint("climb_angle", "{max_deg: 30}")->tighten(limits, request);
  EXPECT_DOUBLE_EQ(limits.max_climb, radians(15));
}

TEST(ClimbAngle, TheJudgeMeasuresClimbAndDescent) {
  // 45 degrees up, then 500 m down over 500 m: the same angle.
  const Route route{{0, 0, 100}, {500, 0, 600}, {1000, 0, 100}};
  EXPECT_TRUE(check(route, problem("{max_deg: 45}")).ok());
  const CheckResult result = check(route, problem("{max_deg: 44}"));
  ASSERT_EQ(result.violations.size(), 2u);
  EXPECT_EQ(result.violations[0].constraint, "climb_angle");
  EXPECT_NEAR(result.violations[0].value, 45, 1e-6);
  EXPECT_NEAR(result.violations[0].limit, 44, 1e-6);
  EXPECT_EQ(result.violations[1].at, 1u);
}

TEST(ClimbAngle, LimitsDescentsByThemselves) {
  const Route route{{0, 0, 100}, {500, 0, 600}, {1000, 0, 100}};  // 45 degrees up and down
  const CheckResult result = check(route, problem("{max_deg: 50, max_sink_deg: 40}"));
  ASSERT_EQ(result.violations.size(), 1u);
  EXPECT_EQ(result.violations[0].at, 1u);
  EXPECT_NE(result.violations[0].message.find("descent"), std::string::npos);
  EXPECT_TRUE(check(route, problem("{max_deg: 46, max_sink_deg: 50}")).ok());
}

TEST(ClimbAngle, HoldsForTracksToo) {
  EXPECT_DOUBLE_EQ(problem("{max_deg: 20}", AppliesTo::track).limits.max_climb, radians(20));
}

}  // namespace
}  // namespace altiplan::testing::climb_angle_test
