// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/measures.hpp"
#include "support/support.hpp"

namespace altiplan::curvature_objective_test {
namespace {

Request empty_request() {
  return testing::request_in({}, {0, 0, 100}, {1000, 0, 100},
                             {{-2000, -2000, 0}, {2000, 2000, 900}});
}
double of(const char* params, const Route& route) {
  return testing::make_objective("curvature", params)->cost(route, empty_request());
}

TEST(CurvatureObjective, OfACornerIsThatOfItsLargestCircle) {
  // A right angle between legs of 200 m and 130 m: the circle touches 65 m from the corner.
  const Route route{{0, 0, 100}, {200, 0, 100}, {200, 120, 150}};
  EXPECT_DOUBLE_EQ(of("{}", route), 1 / 65.0);
  EXPECT_DOUBLE_EQ(of("{}", route), 1 / measure(route, empty_request()).min_radius_m.value());
  EXPECT_DOUBLE_EQ(of("{of: mean}", route), kPi / 2 / 330);
  const Route gentle{{0, 0, 100}, {200, 0, 100}, {300, 100 / std::sqrt(3.0), 100}};
  EXPECT_NEAR(of("{}", gentle), 2 * std::tan(kPi / 12) / std::hypot(100, 100 / std::sqrt(3.0)),
              1e-12);
}

TEST(CurvatureObjective, OfATurnIsThatOfItsRadius) {
  Route route;
  route.push_back(Vec3(0, 0, 100));
  route.push_back(Vec3(300, 0, 100));
  const Leg turn = Leg::turning({{300, 0, 100}, 0}, kPi / 2, 80, 0);
  route.push_back(turn);
  EXPECT_NEAR(of("{}", route), 1 / 80.0, 1e-12);
  EXPECT_NEAR(of("{of: mean}", route), kPi / 2 / (300 + 80 * kPi / 2), 1e-12);
  Route helix;
  helix.push_back(Leg::turning({{300, 0, 100}, 0}, 4 * kPi, 80, 200));
  EXPECT_NEAR(of("{of: mean}", helix), 1 / 80.0 / (1 + std::pow(200 / (4 * kPi * 80), 2)), 1e-9);
}

TEST(CurvatureObjective, WhatDoesNotTurnHasNone) {
  for (const char* params : {"{}", "{of: mean}"}) {
    EXPECT_EQ(of(params, {}), 0);
    EXPECT_EQ(of(params, {{0, 0, 0}, {100, 0, 50}, {100, 0, 50}, {200, 0, 100}}), 0);
    EXPECT_EQ(of(params, {{0, 0, 0}, {0, 0, 500}}), 0);
  }
  EXPECT_TRUE(std::isinf(of("{}", {{0, 0, 0}, {100, 0, 0}, {0, 0, 0}})));
  EXPECT_DOUBLE_EQ(of("{of: mean}", {{0, 0, 0}, {100, 0, 0}, {0, 0, 0}}), kPi / 200);
}
}  // namespace
}  // namespace altiplan::curvature_objective_test
