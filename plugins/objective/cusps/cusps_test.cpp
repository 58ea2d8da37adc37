// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan::cusps_objective_test {
namespace {

double of(const char* params, const Route& route) {
  const Request request =
      testing::request_in({}, {0, 0, 100}, {1000, 0, 100}, {{-2000, -2000, 0}, {2000, 2000, 900}});
  return testing::make_objective("cusps", params)->cost(route, request);
}

TEST(CuspsObjective, AreCornersAboveTheAngle) {
  // Turns of 90°, 45° and 180°.
  const Route route{{0, 0, 100}, {100, 0, 100}, {100, 100, 100}, {0, 200, 100}, {100, 100, 100}};
  EXPECT_EQ(of("{}", route), 2);
  EXPECT_EQ(of("{above_deg: 45}", route), 2);
  EXPECT_EQ(of("{above_deg: 44}", route), 3);
  EXPECT_EQ(of("{above_deg: 90}", route), 1);
  EXPECT_EQ(of("{above_deg: 180}", route), 0);
}

TEST(CuspsObjective, NothingHidesACornerAndTurnsHaveNone) {
  EXPECT_EQ(of("{}", {{0, 0, 0}, {9, 0, 0}, {9, 0, 0}, {9, 0, 50}, {9, 9, 50}}), 1);
  Route route;
  route.push_back(Vec3(0, 0, 100));
  route.push_back(Vec3(300, 0, 100));
  route.push_back(Leg::turning({{300, 0, 100}, 0}, kPi / 2, 80, 0));
  EXPECT_EQ(of("{}", route), 0);
  EXPECT_EQ(of("{}", {}), 0);
}
}  // namespace
}  // namespace altiplan::cusps_objective_test
