// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/route_costs.hpp"

#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan::kit::route_costs_test {
namespace {

/// Two zones that count as threats, as in paper 002.
Request between_zones() {
  return testing::request_in(testing::world_of({Shape{Cylinder{48e3, 41e3, 5e3, 0, 1e4}},
                                                Shape{Cylinder{60e3, 70e3, 5e3, 0, 1e4}}}),
                             {25e3, 70e3, 2e3}, {55e3, 10e3, 2800}, {{0, 0, 0}, {1e5, 1e5, 5e3}});
}

TEST(RouteCosts, LengthAloneIsMetres) {
  const RouteCosts costs({}, between_zones(), 1000);
  EXPECT_TRUE(costs.length_alone());
  EXPECT_EQ(costs.leg({0, 0, 0}, {3, 4, 0}, 5), 5);
  EXPECT_EQ(costs.at({1, 2, 3}), 0);
  EXPECT_EQ(costs.min_per_metre(), 1);
}

TEST(RouteCosts, ValuesAtAPlaceAreThePapers) {
  CostWeights weights{0.5, 0.3, 0.2, Accumulate::none, 1000};
  const RouteCosts costs(weights, between_zones(), 1000);
  // Eqs. (13) and (14) in kilometres, the sum a thousand times that.
  const double threat = 10 / std::hypot(4, 9) + 10 / std::hypot(8, 20);
  EXPECT_NEAR(costs.at({52e3, 50e3, 2200}), 1000 * (0.3 * 2.2 + 0.2 * threat), 1e-3);
  EXPECT_EQ(costs.leg({0, 0, 0}, {3, 4, 0}, 5), 2.5);
  EXPECT_EQ(costs.min_per_metre(), 0.5);
}

TEST(RouteCosts, AlongALegTheyAreTheIntegral) {
  const CostWeights weights{0.5, 0.3, 0.2, Accumulate::length, 1000};
  const CostWeights values{0, 0.3, 0.2, Accumulate::none, 1000};
  const Request request = between_zones();
  const RouteCosts costs(weights, request, 1000);
  const RouteCosts at_places(values, request, 1000);
  SplitMix64 random(1);
  const auto place = [&] {
    return Vec3(random.uniform() * 1e5, random.uniform() * 1e5, 1000 + random.uniform() * 3000);
  };
  for (int n = 0; n < 200; ++n) {
    const Vec3 a = place();
    const Vec3 b = n % 10 == 0 ? Vec3(a + Vec3(0, 0, 200)) : Vec3(a + 0.02 * (place() - a));
    const double length = (b - a).norm();
    double sum = 0;
    constexpr int kParts = 2000;
    for (int part = 0; part < kParts; ++part) {
      sum += at_places.at(a + (part + 0.5) / kParts * (b - a)) / 1000 * length / kParts;
    }
    const double leg = costs.leg(a, b, length);
    EXPECT_NEAR(leg, 0.5 * length + sum, 1e-5 * leg);
    EXPECT_NEAR(leg, costs.leg(b, a, length), 1e-9 * leg);
    EXPECT_GE(leg, costs.min_per_metre() * length);
  }
}

TEST(RouteCosts, NoCostIsInfiniteOrNegative) {
  const CostWeights weights{0, 1, 1, Accumulate::length, 1000};
  const RouteCosts costs(weights, between_zones(), -400);
  const Vec3 centre(48e3, 41e3, -400);
  EXPECT_GT(costs.leg(centre, centre + Vec3(0, 0, 100), 100), 0);
  EXPECT_LT(costs.leg(centre - Vec3(500, 0, 0), centre + Vec3(500, 0, 0), 1000), 1e9);
  EXPECT_EQ(costs.min_per_metre(), 0);
}
}  // namespace
}  // namespace altiplan::kit::route_costs_test
