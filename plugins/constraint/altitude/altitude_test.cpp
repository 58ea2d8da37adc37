// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan::testing::altitude_test {
namespace {

/// A problem from west to east under the constraint, in a world with nothing else.
Request problem(const std::string& yaml, AppliesTo to = AppliesTo::route) {
  Request request =
      request_in(World(), {0, 0, 100}, {1000, 0, 100}, {{-500, -500, 0}, {1500, 500, 1000}});
  apply_constraints(request, {{"altitude", make_constraint("altitude", yaml)}}, to);
  return request;
}

TEST(Altitude, RefusesWrongParameters) {
  EXPECT_EQ(parameter_problems("constraint", "altitude", "{min_m: 10, max_m: 10}"), "");
  EXPECT_NE(parameter_problems("constraint", "altitude", "{}"), "");
  EXPECT_NE(parameter_problems("constraint", "altitude", "{min_m: 20, max_m: 10}"), "");
  EXPECT_NE(parameter_problems("constraint", "altitude", "{min_m: 200000}"), "");
  EXPECT_NE(parameter_problems("constraint", "altitude", "{min_m: 1, datum: moon}"), "");
}

TEST(Altitude, AddsABandAndKeepsTheOthers) {
  Limits limits;
  limits.altitude.push_back({AltitudeBand::Datum::sea, 0, 500});
  const Request request = problem("{max_m: 200}");
  make_constraint("altitude", "{min_m: -10, max_m: 50, datum: start}")->tighten(limits, request);
  make_constraint("altitude", "{max_m: 120, datum: ground}")->tighten(limits, request);
  ASSERT_EQ(limits.altitude.size(), 3u);
  EXPECT_EQ(limits.altitude[0].max, 500);
  EXPECT_EQ(limits.altitude[1].datum, AltitudeBand::Datum::sea);
  EXPECT_EQ(limits.altitude[1].min, 90);
  EXPECT_EQ(limits.altitude[1].max, 150);
  EXPECT_EQ(limits.altitude[2].datum, AltitudeBand::Datum::ground);
  EXPECT_EQ(limits.altitude[2].min, -kInfinity);
  EXPECT_EQ(limits.altitude[2].max, 120);
}

TEST(Altitude, TheJudgeMeasuresAgainstTheDatum) {
  const Route climbs{{0, 0, 100}, {500, 0, 160}, {1000, 0, 100}};
  EXPECT_TRUE(check(climbs, problem("{max_m: 160}")).ok());
  EXPECT_TRUE(check(climbs, problem("{max_m: 60, datum: start}")).ok());
  const CheckResult result = check(climbs, problem("{max_m: 59, datum: start}"));
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.violations[0].constraint, "altitude");
  EXPECT_NEAR(result.violations[0].value, 160, 1e-6);
  EXPECT_NEAR(result.violations[0].limit, 159, 1e-6);
}

TEST(Altitude, HoldsForTracksToo) {
  EXPECT_EQ(problem("{max_m: 160}", AppliesTo::track).limits.altitude.size(), 1u);
  EXPECT_TRUE(problem("{max_m: 160, applies_to: route}", AppliesTo::track).limits.altitude.empty());
}

}  // namespace
}  // namespace altiplan::testing::altitude_test
