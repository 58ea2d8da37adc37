// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "support/support.hpp"

namespace altiplan::random_threats_test {
namespace {

using testing::make_environment;

TEST(RandomThreats, AreThoseOfTheGenerator) {
  const double table[] = {1013, 4399, 4599, 8801, 2150, 2398, 8925, 6700, 5197, 1376, 4932, 4901};
  for (const std::string kind : {"A", "B", "C"}) {
    for (const int seed : {0, 1, 4711}) {
      const auto threats =
          make_environment("random_threats",
                           "{kind: " + kind + ", seed: " + std::to_string(seed) + "}")
              ->info()
              .threats;
      ASSERT_EQ(threats.size(), 80U);
      std::mt19937_64 next(std::uint64_t{0} + std::uint64_t(seed));
      const auto u = [&] { return std::ldexp(double(next() >> 11), -53); };
      for (const Threat& threat : threats) {
        EXPECT_EQ(threat.centre.x(), 90000 * u());
        EXPECT_EQ(threat.centre.y(), 90000 * u());
        const double r = u();
        EXPECT_EQ(threat.radius, kind == "A"   ? table[int(std::floor(12 * r))]
                                 : kind == "B" ? 1000 + 8000 * r
                                               : 1000 + 4000 * r);
      }
    }
  }
}

TEST(RandomThreats, FirstOfSeedOne) {
  // Compared with exact values: a changed generator would produce other maps for the same seeds.
  const Threat first =
      make_environment("random_threats", "{kind: B, seed: 1}")->info().threats.front();
  EXPECT_NEAR(first.centre.x(), 90000 * 0.13387664401253274, 1e-6);
}

TEST(RandomThreats, BlockAtEveryHeight) {
  const auto layer = make_environment("random_threats", "{kind: C, seed: 3, count: 10}");
  for (const Threat& threat : layer->info().threats) {
    for (const double z : {-1e4, 0.0, 1e4}) {
      const Vec3 at(threat.centre.x(), threat.centre.y(), z);
      EXPECT_LE(layer->clearance(at), -threat.radius + 1e-6);
    }
  }
}

TEST(RandomThreats, RefusesWrongParameters) {
  EXPECT_NE(testing::parameter_problems("environment", "random_threats", "{kind: D}"), "");
  EXPECT_NE(testing::parameter_problems("environment", "random_threats", "{count: 0}"), "");
  EXPECT_NE(testing::parameter_problems("environment", "random_threats", "{seed: -1}"), "");
}
}  // namespace
}  // namespace altiplan::random_threats_test
