// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan::testing::clearance_test {
namespace {

/// Past a ball of 50 m radius, 100 m south of the straight line.
Request problem(const std::string& yaml, AppliesTo to = AppliesTo::route) {
  Request request = request_in(world_of({Sphere{{500, -150, 100}, 50}}), {0, 0, 100},
                               {1000, 0, 100}, {{-500, -500, 0}, {1500, 500, 1000}});
  apply_constraints(request, {{"clearance", make_constraint("clearance", yaml)}}, to);
  return request;
}

TEST(Clearance, RefusesWrongParameters) {
  EXPECT_EQ(parameter_problems("constraint", "clearance", "{min_m: 0}"), "");
  EXPECT_NE(parameter_problems("constraint", "clearance", "{}"), "");
  EXPECT_NE(parameter_problems("constraint", "clearance", "{min_m: -1}"), "");
}

TEST(Clearance, OnlyTightens) {
  Limits limits;
  limits.min_clearance = 2;
  const Request request = problem("{min_m: 0}");
  make_constraint("clearance", "{min_m: 50}")->tighten(limits, request);
  EXPECT_EQ(limits.min_clearance, 50);
  make_constraint("clearance", "{min_m: 1}")->tighten(limits, request);
  EXPECT_EQ(limits.min_clearance, 50);
}

TEST(Clearance, TheJudgeAllowsTouchingAndNoMore) {
  const Route straight{{0, 0, 100}, {1000, 0, 100}};
  EXPECT_TRUE(check(straight, problem("{min_m: 100}")).ok());
  const CheckResult result = check(straight, problem("{min_m: 100.01}"));
  ASSERT_FALSE(result.ok());
  EXPECT_NEAR(result.violations[0].value, 100, 1e-2);
  EXPECT_NEAR(result.violations[0].limit, 100.01, 1e-6);
}

TEST(Clearance, HoldsForTracksToo) {
  EXPECT_EQ(problem("{min_m: 61}", AppliesTo::track).limits.min_clearance, 61);
}

TEST(Clearance, MayHoldForRoutesAlone) {
  const std::string yaml = "{min_m: 61, applies_to: route}";
  EXPECT_EQ(problem(yaml).limits.min_clearance, 61);
  EXPECT_EQ(problem(yaml, AppliesTo::track).limits.min_clearance, 0);
  EXPECT_EQ(problem("{min_m: 61, applies_to: track}").limits.min_clearance, 0);
}

}  // namespace
}  // namespace altiplan::testing::clearance_test
