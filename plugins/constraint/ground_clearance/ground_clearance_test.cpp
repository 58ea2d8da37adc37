// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "support/support.hpp"

namespace altiplan::testing::ground_clearance_test {
namespace {

/// Ground at sea level everywhere, and nothing else.
class Plain final : public Environment, public Ground {
  Box do_bounds() const override { return {{-500, -500, -kInfinity}, {1500, 500, 0}}; }
  double do_clearance(const Vec3& p) const override { return p.z(); }
  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double, double) const override { return 0; }
  double do_gap(const Vec3& a, const Vec3& b, double) const override {
    return std::min(a.z(), b.z());
  }
};

Request problem(const std::string& yaml, AppliesTo to = AppliesTo::route) {
  Request request = request_in(world_of(std::make_shared<Plain>()), {0, 0, 100}, {1000, 0, 100},
                               {{-500, -500, 0}, {1500, 500, 1000}});
  apply_constraints(request, {{"ground_clearance", make_constraint("ground_clearance", yaml)}}, to);
  return request;
}

TEST(GroundClearance, RefusesWrongParameters) {
  EXPECT_EQ(parameter_problems("constraint", "ground_clearance", "{min_m: 0}"), "");
  EXPECT_NE(parameter_problems("constraint", "ground_clearance", "{}"), "");
  EXPECT_NE(parameter_problems("constraint", "ground_clearance", "{min_m: -1}"), "");
}

TEST(GroundClearance, OnlyTightens) {
  Limits limits;
  const Request request = problem("{min_m: 0}");
  make_constraint("ground_clearance", "{min_m: 50}")->tighten(limits, request);
  EXPECT_EQ(limits.min_ground_clearance, 50);
  make_constraint("ground_clearance", "{min_m: 20}")->tighten(limits, request);
  EXPECT_EQ(limits.min_ground_clearance, 50);
}

TEST(GroundClearance, TheJudgeFindsALowLeg) {
  const Route dips{{0, 0, 100}, {500, 0, 60}, {1000, 0, 100}};
  EXPECT_TRUE(check(dips, problem("{min_m: 60}")).ok());
  const CheckResult result = check(dips, problem("{min_m: 61}"));
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.violations[0].constraint, "ground_clearance");
  EXPECT_NEAR(result.violations[0].value, 60, 1e-6);
  EXPECT_NEAR(result.violations[0].limit, 61, 1e-6);
}

TEST(GroundClearance, HoldsForTracksToo) {
  EXPECT_EQ(problem("{min_m: 61}", AppliesTo::track).limits.min_ground_clearance, 61);
}

TEST(GroundClearance, MayHoldForRoutesAlone) {
  const std::string yaml = "{min_m: 61, applies_to: route}";
  EXPECT_EQ(problem(yaml).limits.min_ground_clearance, 61);
  EXPECT_FALSE(problem(yaml, AppliesTo::track).limits.min_ground_clearance);
}

}  // namespace
}  // namespace altiplan::testing::ground_clearance_test
