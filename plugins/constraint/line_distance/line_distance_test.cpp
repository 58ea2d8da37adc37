// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "altiplan/geometry.hpp"
#include "altiplan/random.hpp"
#include "support/support.hpp"

namespace altiplan::testing::line_distance_test {
namespace {

const Polyline kLine{{0, 0, 0}, {400, 0, 0}, {400, 300, 0}, {420, 0, 0}};
const char* const kCorners = "line_m: [[0, 0], [400, 0], [400, 300], [420, 0]], within_m: ";

std::shared_ptr<const Constraint> within(double metres) {
  char text[120];
  std::snprintf(text, sizeof text, "{%s%.17g}", kCorners, metres);
  return make_constraint("line_distance", text);
}

bool admits(double metres, const Vec3& a, const Vec3& b) {
  return within(metres)->admits({std::nullopt, a, b, nullptr});
}

double away(const Vec3& p) {
  double nearest = kInfinity;
  for (std::size_t i = 1; i < kLine.size(); ++i) {
    nearest = std::min(nearest, point_leg_distance({p.x(), p.y(), 0}, kLine[i - 1], kLine[i]));
  }
  return nearest;
}

TEST(LineDistance, RefusesWrongParameters) {
  const auto problems = [](const std::string& yaml) {
    return parameter_problems("constraint", "line_distance", yaml);
  };
  EXPECT_EQ(problems("{" + std::string(kCorners) + "5}"), "");
  EXPECT_NE(problems("{within_m: 5}"), "");
  EXPECT_NE(problems("{line_m: [[0, 0]], within_m: 5}"), "");
  EXPECT_NE(problems("{line_m: [[0, 0], [1, 0]], line_lonlat: [[0, 0], [1, 0]], within_m: 5}"), "");
  EXPECT_NE(problems("{" + std::string(kCorners) + "0}"), "");
  EXPECT_THROW(make_constraint("line_distance", "{line_m: [[5, 5], [5, 5]], within_m: 5}"), Error);
}

TEST(LineDistance, KeepsWholeLegs) {
  EXPECT_TRUE(admits(30, {0, 30, 90}, {370, 30, 500})) << "touching, at any height";
  EXPECT_FALSE(admits(30, {0, 30.001, 90}, {370, 30.001, 90}));
  EXPECT_TRUE(admits(30, {-30, 0, 0}, {0, 0, 0})) << "beyond its end";
  EXPECT_FALSE(admits(30, {-30.001, 0, 0}, {0, 0, 0}));
  // Both ends are near, and the middle of the shortcut is not.
  EXPECT_FALSE(admits(30, {200, 0, 0}, {400, 200, 0}));
  EXPECT_TRUE(admits(142, {200, 0, 0}, {400, 200, 0}));
  // Legs of the line hand over to each other.
  EXPECT_TRUE(admits(30, {395, -25, 0}, {395, 320, 0}));
  EXPECT_TRUE(admits(30, {380, 50, 0}, {440, 50, 0})) << "across two legs";
  EXPECT_TRUE(admits(30, {100, 10, 0}, {100, 10, 80})) << "a climb on the spot";
  EXPECT_FALSE(admits(30, {100, 40, 0}, {100, 40, 80}));
}

TEST(LineDistance, AgreesWithSamples) {
  RandomStream random(5);
  int kept = 0;
  int decided = 0;
  for (int n = 0; n < 4000; ++n) {
    const Vec3 a = random.in({{-50, -80, 0}, {480, 340, 100}});
    const Vec3 b = n % 2 == 0 ? random.in({{-50, -80, 0}, {480, 340, 100}})
                              : Vec3(a + random.in({{-60, -60, 0}, {60, 60, 0}}));
    double farthest = 0;
    constexpr int kSamples = 2000;
    for (int k = 0; k <= kSamples; ++k) {
      farthest = std::max(farthest, away(a + double(k) / kSamples * (b - a)));
    }
    const double step = (b - a).norm() / kSamples;
    EXPECT_FALSE(admits(farthest - 1e-5, a, b)) << n;
    EXPECT_TRUE(admits(farthest + step, a, b)) << n;
    decided += 2;
    kept += farthest < 60;
  }
  EXPECT_GT(kept, 500);
}

Request problem(const std::string& more, AppliesTo to = AppliesTo::route) {
  Request request =
      request_in({}, {0, 0, 100}, {400, 300, 100}, {{-1e3, -1e3, 0}, {1e3, 1e3, 500}});
  apply_constraints(request,
                    {{"line_distance",
                      make_constraint("line_distance", "{" + std::string(kCorners) + more + "}")}},
                    to);
  return request;
}

TEST(LineDistance, TheJudgeNamesTheDistance) {
  const Route along{{0, 0, 100}, {400, 0, 100}, {400, 300, 100}};
  EXPECT_TRUE(check(along, problem("20")).ok());
  const Route across{{0, 0, 100}, {200, 0, 100}, {400, 200, 100}, {400, 300, 100}};
  const CheckResult result = check(across, problem("20"));
  ASSERT_FALSE(result.ok());
  const Violation& last = result.violations.back();
  EXPECT_EQ(last.constraint, "line_distance");
  EXPECT_EQ(last.at, 1U);
  EXPECT_NEAR(last.value, 100, 1e-3);
  EXPECT_EQ(last.limit, 20);
  EXPECT_NE(last.message.find("m from the line; at most 20.00 m are permitted"), std::string::npos)
      << last.message;
}

TEST(LineDistance, MayHoldForRoutesAlone) {
  EXPECT_EQ(problem("9, applies_to: route").constraints.size(), 1U);
  EXPECT_TRUE(problem("9, applies_to: route", AppliesTo::track).constraints.empty());
}
}  // namespace
}  // namespace altiplan::testing::line_distance_test
