// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/kit/colony/colony.hpp"

namespace altiplan::kit::colony_test {
namespace {

TEST(Power, IsThatOfTheLibrary) {
  RandomStream random(3);
  for (const double exponent : {0.0, 1.0, 2.0, 3.0, 6.0, 13.0, 20.0, 0.5, 2.7}) {
    const Power power(exponent);
    for (int n = 0; n < 200; ++n) {
      const double x = random.uniform(1e-3, 30);
      EXPECT_NEAR(power(x) / std::pow(x, exponent), 1, 1e-13);
    }
  }
}

/// Every place evaporated in every iteration, eqs. (2) to (4).
struct PlainPheromone {
  std::vector<double> tau;
  double rho;

  void evaporate() {
    for (double& amount : tau) {
      amount *= 1 - rho;
    }
  }
  void lay(std::size_t place, double amount) { tau[place] += amount; }
};

TEST(Pheromone, KeepsTheRatiosOfAPlainOne) {
  for (const double rho : {0.0, 0.02, 0.6, 0.95}) {
    RandomStream random(5);
    constexpr std::size_t kPlaces = 50;
    Pheromone pheromone;
    pheromone.reset(kPlaces, rho, 6);
    PlainPheromone plain{std::vector<double>(kPlaces, 1.0), rho};
    int rescaled = 0;
    for (int iteration = 0; iteration < 300; ++iteration) {
      pheromone.evaporate();
      plain.evaporate();
      for (int n = 0; n < 20; ++n) {
        const auto place = std::size_t(random.integer(0, kPlaces - 2));  // never the last
        const double amount = random.uniform(0.1, 2);
        pheromone.lay(place, amount);
        plain.lay(place, amount);
      }
      rescaled += pheromone.settle() ? 1 : 0;
      for (std::size_t place = 1; place + 1 < kPlaces; ++place) {
        const double ratio = plain.tau[place] / plain.tau[0];
        if (ratio > 1e-10 && ratio < 1e10) {
          EXPECT_NEAR(pheromone[place] / pheromone[0] / ratio, 1, 1e-9);
        }
      }
      // The power of what never gets any more is small beside the others', and not 0.
      EXPECT_GT(std::pow(pheromone[kPlaces - 1], 6), 0);
      EXPECT_LE(pheromone[kPlaces - 1], pheromone[0] * (1 + 1e-12));
    }
    EXPECT_EQ(rescaled > 0, rho > 0.5) << rho;
  }
}

TEST(Pheromone, KeepsTheRatiosOfSmallAmounts) {
  Pheromone pheromone;
  pheromone.reset(2, 0.6, 1);
  PlainPheromone plain{{1, 1}, 0.6};
  for (int iteration = 0; iteration < 700; ++iteration) {
    pheromone.evaporate();
    plain.evaporate();
    for (const std::size_t place : {std::size_t(iteration % 2), std::size_t{1}}) {
      pheromone.lay(place, 1e-4);
      plain.lay(place, 1e-4);
    }
    pheromone.settle();
    EXPECT_NEAR(pheromone[1] / pheromone[0] / (plain.tau[1] / plain.tau[0]), 1, 1e-9);
  }
}

TEST(Pheromone, TellsWhenAllIsAnother) {
  Pheromone pheromone;
  pheromone.reset(2, 1, 2);
  pheromone.evaporate();
  pheromone.lay(0, 3);
  EXPECT_TRUE(pheromone.settle());
  // Nothing is laid: the places are alike.
  pheromone.evaporate();
  EXPECT_TRUE(pheromone.settle());
  EXPECT_EQ(pheromone[0], pheromone[1]);
  pheromone.evaporate();
  pheromone.lay(1, 1e-20);
  EXPECT_TRUE(pheromone.settle());
  EXPECT_GT(pheromone[1], 1e10 * pheromone[0]);
}

TEST(Pheromone, WhereAllEvaporatesOnlyTheNewCounts) {
  Pheromone pheromone;
  pheromone.reset(3, 1, 6);
  pheromone.evaporate();
  pheromone.lay(0, 4);
  pheromone.settle();
  EXPECT_GT(pheromone[0], 1e10 * pheromone[1]);
  pheromone.evaporate();
  pheromone.lay(1, 2);
  pheromone.settle();
  EXPECT_GT(pheromone[1], 1e10 * pheromone[0]);
  EXPECT_EQ(pheromone[0], pheromone[2]);
}

TEST(CellBits, AroundACellAreItsEightNeighbours) {
  RandomStream random(9);
  for (int trial = 0; trial < 300; ++trial) {
    const int columns = int(random.integer(3, 40));
    const int rows = int(random.integer(3, 20));
    CellBits bits;
    bits.reset(columns, std::size_t(columns * rows));
    std::vector<bool> plain(std::size_t(columns * rows));
    for (int n = 0; n < columns * rows / 2; ++n) {
      const auto cell = std::uint32_t(random.integer(0, columns * rows - 1));
      const bool set = random.uniform() < 0.7;
      set ? bits.set(cell) : bits.clear(cell);
      plain[cell] = set;
    }
    for (std::uint32_t cell = 0; cell < plain.size(); ++cell) {
      EXPECT_EQ(bits.test(cell), plain[cell]);
    }
    const int x = int(random.integer(1, columns - 2));
    const int y = int(random.integer(1, rows - 2));
    const unsigned around = bits.around(std::uint32_t(y * columns + x));
    int k = 0;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (dx != 0 || dy != 0) {
          EXPECT_EQ((around >> k++ & 1) != 0, plain[std::size_t((y + dy) * columns + x + dx)]);
        }
      }
    }
  }
}
}  // namespace
}  // namespace altiplan::kit::colony_test
