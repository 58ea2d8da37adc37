// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan::testing::turn_angle_test {
namespace {

/// A problem from west to east under the constraint, in a world with nothing else.
Request problem(const std::string& yaml, AppliesTo to = AppliesTo::route) {
  Request request =
      request_in(World(), {0, 0, 100}, {1000, 0, 100}, {{-500, -500, 0}, {1500, 500, 1000}});
  apply_constraints(request, {{"turn_angle", make_constraint("turn_angle", yaml)}}, to);
  return request;
}

TEST(TurnAngle, RefusesWrongParameters) {
  EXPECT_EQ(parameter_problems("constraint", "turn_angle", "{max_deg: 55, plane: spatial}"), "");
  EXPECT_NE(parameter_problems("constraint", "turn_angle", "{}"), "");
  EXPECT_NE(parameter_problems("constraint", "turn_angle", "{max_deg: -1}"), "");
  EXPECT_NE(parameter_problems("constraint", "turn_angle", "{max_deg: 181}"), "");
  EXPECT_NE(parameter_problems("constraint", "turn_angle", "{max_deg: 9, plane: up}"), "");
}

TEST(TurnAngle, OnlyTightens) {
  Limits limits;
  const Request request = problem("{max_deg: 180}");
  make_constraint("turn_angle", "{max_deg: 55}")->tighten(limits, request);
  make_constraint("turn_angle", "{max_deg: 90}")->tighten(limits, request);
  EXPECT_DOUBLE_EQ(limits.max_turn_horizontal, radians(55));
  EXPECT_EQ(limits.max_turn_space, kPi);
  make_constraint("turn_angle", "{max_deg: 60, plane: spatial}")->tighten(limits, request);
  make_constraint("turn_angle", "{max_deg: 70, plane: spatial}")->tighten(limits, request);
  EXPECT_DOUBLE_EQ(limits.max_turn_space, radians(60));
  EXPECT_DOUBLE_EQ(limits.max_turn_horizontal, radians(55));
}

TEST(TurnAngle, TheJudgeMeasuresInItsPlane) {
  // Straight on as seen from above, 90 degrees in 3-D.
  const Route hump{{0, 0, 100}, {500, 0, 600}, {1000, 0, 100}};
  EXPECT_TRUE(check(hump, problem("{max_deg: 1}")).ok());
  EXPECT_TRUE(check(hump, problem("{max_deg: 90, plane: spatial}")).ok());
  const CheckResult result = check(hump, problem("{max_deg: 89, plane: spatial}"));
  ASSERT_EQ(result.violations.size(), 1u);
  EXPECT_EQ(result.violations[0].constraint, "turn_angle");
  EXPECT_EQ(result.violations[0].at, 1u);
  EXPECT_NEAR(result.violations[0].value, 90, 1e-6);
  EXPECT_NEAR(result.violations[0].limit, 89, 1e-6);
}

TEST(TurnAngle, LeavesTracksAlone) {
  EXPECT_EQ(problem("{max_deg: 20}", AppliesTo::track).limits.max_turn_horizontal, kPi);
}

}  // namespace
}  // namespace altiplan::testing::turn_angle_test
