// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan::altitude_objective_test {
namespace {

Request empty_request() {
  return testing::request_in({}, {0, 0, 100}, {1000, 0, 100}, {{0, 0, 50}, {1000, 1000, 400}});
}

TEST(AltitudeObjective, IsTheIntegralOfTheHeight) {
  const auto altitude = testing::make_objective("altitude");
  const Request request = empty_request();
  const auto cost = [&](const Vec3& a, const Vec3& b) {
    return altitude->cost(Leg::straight(a, b), 0, request);
  };
  EXPECT_DOUBLE_EQ(cost({0, 0, 100}, {300, 400, 100}), 500 * 100);
  EXPECT_DOUBLE_EQ(cost({0, 0, 100}, {0, 0, 300}), 200 * 200);
  // Below sea level it is 0: the leg is above it along its last three quarters.
  EXPECT_DOUBLE_EQ(cost({0, 0, -100}, {0, 0, 300}), 300 * 150);
  EXPECT_DOUBLE_EQ(cost({0, 0, -100}, {50, 0, -10}), 0);
  EXPECT_EQ(altitude->unit(), "m²");
}

TEST(AltitudeObjective, ATurnCostsWhatItsFineChordsDo) {
  const auto altitude = testing::make_objective("altitude");
  const Request request = empty_request();
  const Leg turn = Leg::turning({{500, 500, 100}, 0.3}, 2, 80, 60);
  double sum = 0;
  constexpr int kPieces = 100'000;
  for (int n = 0; n < kPieces; ++n) {
    const Vec3 from = turn.at(double(n) / kPieces);
    const Vec3 to = turn.at(double(n + 1) / kPieces);
    sum += (to - from).norm() * (from.z() + to.z()) / 2;
  }
  EXPECT_NEAR(altitude->cost(turn, 0, request) / sum, 1, 1e-6);
}

TEST(AltitudeObjective, TheBoundKnowsTheFloorAndTheClimb) {
  const auto altitude = testing::make_objective("altitude");
  const Request request = empty_request();
  EXPECT_DOUBLE_EQ(altitude->bound({0, 0, 100}, {1000, 0, 100}, request), 50 * 1000);
  EXPECT_DOUBLE_EQ(altitude->bound({0, 0, 100}, {0, 0, 300}, request), 200 * 200);
  EXPECT_EQ(altitude->bound({0, 0, 100}, {0, 0, 100}, request), 0);
}
}  // namespace
}  // namespace altiplan::altitude_objective_test
