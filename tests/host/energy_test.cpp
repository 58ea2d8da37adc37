// SPDX-License-Identifier: Apache-2.0
// Against values of an independent program: energy/*.csv of ALTIPLAN_TEST_DATA.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <sstream>

#include "host/energy/flight_power.hpp"
#include "host/energy/flight_time.hpp"
#include "support/support.hpp"

namespace altiplan::host::energy_test {
namespace {

/// Calls with the words of each line but the first.
int each_line(const std::filesystem::path& file,
              const std::function<void(const std::vector<std::string>&)>& check) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  int count = 0;
  for (; std::getline(in, line); ++count) {
    std::vector<std::string> words;
    std::erase(line, '\r');
    std::istringstream text(line);
    for (std::string word; std::getline(text, word, ',');) {
      words.push_back(word);
    }
    check(words);
  }
  return count;
}

double number(const std::string& word) { return std::stod(word); }

void expect_same(double found, double expected, double relative) {
  EXPECT_NEAR(found, expected, relative * std::max(1.0, std::abs(expected)));
}

TEST(Energy, Liu) {
  ALTIPLAN_DATA_OR_SKIP(file, "energy/liu2017.csv");
  EXPECT_GT(each_line(file,
                      [](const auto& w) {
                        const LiuPower power;
                        expect_same(w[0] == "vertical" ? power.vertical(number(w[1]), number(w[2]))
                                                       : power.level(number(w[1]), number(w[2])),
                                    number(w[3]), 1e-9);
                      }),
            5);
}

TEST(Energy, MomentumTheory) {
  ALTIPLAN_DATA_OR_SKIP(file, "energy/momentum_theory.csv");
  const MomentumPower power{.mass_kg = 3, .disc_m2 = 0.385, .drag_m2 = 0.02};
  EXPECT_GT(
      each_line(file,
                [&](const auto& w) { expect_same(power.at(number(w[0])), number(w[4]), 1e-9); }),
      2);
  EXPECT_DOUBLE_EQ(power.at(0, -2), power.at(0));
  EXPECT_GT(power.at(0, 2), power.at(0));
}

TEST(Energy, Polar) {
  ALTIPLAN_DATA_OR_SKIP(file, "energy/fixed_wing.csv");
  const PolarPower talon{2.45, 0.314, 0.0398, 0.0544, 0.108, 0.5};
  EXPECT_GT(each_line(file,
                      [&](const auto& w) {
                        expect_same(
                            talon.at(number(w[0]), radians(number(w[1])), radians(number(w[2]))),
                            std::max(0.0, number(w[6])), 1e-9);
                      }),
            4);
}

TEST(Energy, LegTime) {
  ALTIPLAN_DATA_OR_SKIP(file, "energy/trapezoid.csv");
  EXPECT_GT(each_line(file,
                      [](const auto& w) {
                        const auto time = leg_time(number(w[0]), number(w[1]), number(w[2]),
                                                   number(w[3]), number(w[4]));
                        ASSERT_EQ(time.has_value(), w[5] != "infeasible");
                        if (time) {
                          expect_same(*time, number(w[5]), 1e-9);
                        }
                      }),
            20);
}

TEST(Energy, Px4Speeds) {
  ALTIPLAN_DATA_OR_SKIP(file, "energy/px4_speed_rules.csv");
  EXPECT_GT(each_line(file,
                      [](const auto& w) {
                        const double found =
                            w[0] == "corner_speed"
                                ? px4_corner_speed(radians(number(w[1])), number(w[2]),
                                                   number(w[3]), number(w[4]))
                                : px4_speed_before(number(w[6]), number(w[7]), number(w[3]),
                                                   number(w[5]));
                        expect_same(found, number(w[8]), 1e-9);
                      }),
            10);
}

TEST(Energy, Px4Return) {
  ALTIPLAN_DATA_OR_SKIP(file, "energy/px4_rtl_time.csv");
  EXPECT_GT(each_line(file,
                      [](const auto& w) {
                        const double found = px4_return_time(
                            {number(w[1]), number(w[2])}, number(w[3]),
                            {number(w[4]), number(w[5])}, number(w[6]), number(w[7]));
                        if (w[8] == "inf") {
                          EXPECT_EQ(found, kInfinity);
                        } else {
                          expect_same(found, number(w[8]), 1e-5);
                        }
                      }),
            4);
}

TEST(Energy, StandardAtmosphere) {
  EXPECT_NEAR(air_density(0), kSeaLevelDensity, 1e-5);
  EXPECT_NEAR(air_density(1000), 1.1116, 1e-4);
}
}  // namespace
}  // namespace altiplan::host::energy_test
