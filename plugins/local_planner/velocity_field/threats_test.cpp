// SPDX-License-Identifier: Apache-2.0
#include "threats.hpp"

#include <gtest/gtest.h>

#include "altiplan/random.hpp"

namespace velocity_field::threats_test {
namespace {
using altiplan::SplitMix64;

struct Spread {
  std::size_t count;
  double side;
  double minimum;
  double maximum;
};

std::vector<Disc> drawn(const Spread& spread, std::uint64_t seed) {
  SplitMix64 random(seed);
  std::vector<Disc> discs;
  for (std::size_t i = 0; i < spread.count; ++i) {
    const double x = spread.side * (random.uniform() - 0.5);
    const double y = spread.side * (random.uniform() - 0.5);
    discs.push_back(
        {{x, y}, spread.minimum + (spread.maximum - spread.minimum) * random.uniform()});
  }
  return discs;
}

const Spread kSpreads[] = {{1, 10, 5, 5},    {12, 5e4, 1e3, 9e3}, {80, 9e4, 1e3, 9e3},
                           {300, 1e3, 1, 2}, {200, 1, 1e4, 1e4},  {400, 3e6, 10, 3e5},
                           {50, 0, 100, 200}};

std::vector<std::uint32_t> acting(const Threats& threats, const Vec2& p,
                                  std::span<const std::uint32_t> among) {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t i : among) {
    const Disc& disc = threats.all()[i];
    if ((p - disc.centre).norm() <= disc.radius + threats.reach()) {
      found.push_back(i);
    }
  }
  return found;
}

TEST(Threats, NearHoldsWhateverActs) {
  SplitMix64 random(5);
  for (const Spread& spread : kSpreads) {
    const Threats threats(drawn(spread, spread.count), 2000);
    std::vector<std::uint32_t> all(spread.count);
    for (std::uint32_t i = 0; i < spread.count; ++i) {
      all[i] = i;
    }
    const auto look = [&](const Vec2& p) {
      ASSERT_EQ(acting(threats, p, threats.near(p)), acting(threats, p, all)) << p.transpose();
    };
    for (int n = 0; n < 500; ++n) {
      const double side = 1.2 * spread.side + 30000;
      look(side * Vec2(random.uniform() - 0.5, random.uniform() - 0.5));
      // Exactly on a ring's edge, and at an extreme of it.
      const Disc& disc = threats.all()[std::size_t(n) % spread.count];
      const double angle = n % 2 == 0 ? altiplan::kPi / 2 * n : random.uniform() * 7;
      look(disc.centre +
           (disc.radius + 2000) * (1 - 1e-12) * Vec2(std::cos(angle), std::sin(angle)));
    }
    look({altiplan::kInfinity, 0});
    look({-1e300, 1e300});
  }
}

TEST(Threats, PartnersAreDiscsThatOverlap) {
  int alone = 0;
  for (const Spread& spread : kSpreads) {
    const Threats threats(drawn(spread, spread.count + 1), 2000);
    for (std::uint32_t i = 0; i < spread.count; ++i) {
      bool expected = false;
      for (std::uint32_t j = 0; j < spread.count; ++j) {
        const Disc& a = threats.all()[i];
        const Disc& b = threats.all()[j];
        const bool overlap = (a.centre - b.centre).norm() < a.radius + b.radius;
        ASSERT_EQ(threats.overlap(i, j), overlap);
        expected = expected || (i != j && overlap);
      }
      ASSERT_EQ(threats.has_partner(i), expected) << i;
      alone += !expected;
    }
  }
  EXPECT_GT(alone, 20);
}

TEST(Threats, TouchingIsNoOverlap) {
  const Threats threats({{{0, 0}, 100}, {{300, 0}, 200}, {{300, 300}, 100.001}}, 50);
  EXPECT_FALSE(threats.has_partner(0));
  EXPECT_TRUE(threats.has_partner(1));
  EXPECT_TRUE(threats.has_partner(2));
}

TEST(Threats, FewAreLookedAtHoweverManyThereAre) {
  // Ten times the threats over ten times the area.
  for (const std::size_t count : {1000U, 10000U}) {
    const double side = 3000 * std::sqrt(double(count));
    const Threats threats(drawn({count, side, 500, 1500}, 3), 2000);
    SplitMix64 random(4);
    double looked = 0;
    for (int n = 0; n < 1000; ++n) {
      looked +=
          double(threats.near(side * Vec2(random.uniform() - 0.5, random.uniform() - 0.5)).size());
    }
    EXPECT_LT(looked / 1000, 12) << count;  // about 3.2 act on average
  }
}

TEST(Threats, NoneAtAll) {
  EXPECT_TRUE(Threats({}, 100).near({0, 0}).empty());
  EXPECT_TRUE(Threats().near({0, 0}).empty());
}
}  // namespace
}  // namespace velocity_field::threats_test
