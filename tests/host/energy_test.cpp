// SPDX-License-Identifier: Apache-2.0
// Against values of an independent program: energy/*.csv of ALTIPLAN_TEST_DATA.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <sstream>

#include "altiplan/flown_route.hpp"
#include "host/energy/flight_power.hpp"
#include "host/energy/way_home.hpp"
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
                        LiuPower power;
                        power.mass_kg = number(w[1]);
                        const bool is_vertical = w[0] == "vertical";
                        const double speed = number(w[2]);
                        expect_same(is_vertical ? power.vertical(speed) : power.level(speed),
                                    number(w[3]), 1e-9);
                        const SteadyFlight flight =
                            is_vertical ? SteadyFlight{0, speed} : SteadyFlight{speed, 0};
                        if (is_vertical || speed > 0) {  // hovering is a vertical flight
                          expect_same(power.watts(flight), number(w[3]), 1e-9);
                        }
                      }),
            5);
}

TEST(Energy, MomentumTheory) {
  ALTIPLAN_DATA_OR_SKIP(file, "energy/momentum_theory.csv");
  MomentumPower power;
  power.mass_kg = 3;
  power.disc_m2 = 0.385;
  power.drag_m2 = 0.02;
  EXPECT_GT(
      each_line(file,
                [&](const auto& w) { expect_same(power.at(number(w[0])), number(w[4]), 1e-9); }),
      2);
  EXPECT_DOUBLE_EQ(power.at(0, -2), power.at(0)) << "in its own wake";
  EXPECT_DOUBLE_EQ(power.at(10, -2), power.at(0));
  EXPECT_GT(power.at(0, 2), power.at(0));
}

TEST(Energy, Polar) {
  ALTIPLAN_DATA_OR_SKIP(file, "energy/fixed_wing.csv");
  PolarPower talon;
  talon.mass_kg = 2.45;
  talon.wing_m2 = 0.314;
  talon.cd0 = 0.0398;
  talon.k = 0.0544;
  talon.cl_of_min_drag = 0.108;
  talon.efficiency = 0.5;
  EXPECT_GT(each_line(file,
                      [&](const auto& w) {
                        expect_same(
                            talon.at(number(w[0]), radians(number(w[1])), radians(number(w[2]))),
                            std::max(0.0, number(w[6])), 1e-9);
                      }),
            4);
  talon.cl_max = 1.2;
  EXPECT_EQ(talon.at(9), kInfinity) << "it stalls";
}

TEST(Energy, MeasuredIsKnownBetweenItsSpeeds) {
  MeasuredPower power;
  power.level = {{0, 180}, {10, 150}, {15, 240}};
  power.mass_kg = 2;
  power.efficiency = 0.5;
  EXPECT_DOUBLE_EQ(power.watts({0, 0}), 180);
  EXPECT_DOUBLE_EQ(power.watts({5, 0}), 165);
  EXPECT_DOUBLE_EQ(power.watts({15, 0}), 240);
  EXPECT_DOUBLE_EQ(power.watts({5, -3}), 165) << "a descent saves nothing";
  EXPECT_DOUBLE_EQ(power.watts({5, 3}), 165 + 2 * 9.80665 * 3 / 0.5);
  EXPECT_EQ(power.watts({15.1, 0}), kInfinity);
}

TEST(Energy, Sprint) {
  ALTIPLAN_DATA_OR_SKIP(file, "energy/trapezoid.csv");
  EXPECT_GT(each_line(file,
                      [](const auto& w) {
                        const auto flown = sprint(number(w[0]), number(w[1]), number(w[2]),
                                                  number(w[3]), {.mps2 = number(w[4])});
                        ASSERT_EQ(flown.has_value(), w[5] != "infeasible");
                        if (flown) {
                          expect_same(flown->seconds(), number(w[5]), 1e-9);
                        }
                      }),
            20);
}

TEST(Energy, ArduCoptersLeg) {
  ALTIPLAN_DATA_OR_SKIP(file, "energy/arducopter_leg.csv");
  EXPECT_GT(each_line(file,
                      [](const auto& w) {
                        const Acceleration its{number(w[2]), number(w[3]), number(w[4])};
                        const auto flown = sprint(number(w[0]), 0, 0, number(w[1]), its);
                        ASSERT_TRUE(flown);
                        expect_same(flown->seconds(), number(w[5]), 1e-9);
                        expect_same(flown->top_mps, number(w[6]), 1e-9);
                      }),
            15);
}

TEST(Energy, Px4sCorners) {
  ALTIPLAN_DATA_OR_SKIP(file, "energy/px4_speed_rules.csv");
  int corners = 0;
  each_line(file, [&](const auto& w) {
    if (w[0] == "corner_speed") {
      ++corners;
      expect_same(corner_speed(radians(number(w[1])), number(w[4]) * number(w[2]), number(w[3])),
                  number(w[8]), 1e-9);
    }
  });
  EXPECT_GT(corners, 8);
}

TEST(Energy, Px4sWayHome) {
  ALTIPLAN_DATA_OR_SKIP(file, "energy/px4_rtl_time.csv");
  EXPECT_GT(each_line(file,
                      [](const auto& w) {
                        const double found =
                            time_home({number(w[1]), number(w[2])}, number(w[3]),
                                      {number(w[4]), number(w[5])}, number(w[6]), number(w[7]));
                        if (w[8] == "inf") {
                          EXPECT_EQ(found, kInfinity);
                        } else {
                          expect_same(found, number(w[8]), 1e-5);
                        }
                      }),
            4);
}

TEST(Energy, ThePointOfNoReturnLeavesEnoughForTheStraightWayBack) {
  Request request;
  request.world = std::make_shared<const World>();
  request.vehicle.speed_mps = 10;
  const auto lasts = [&](double capacity_wh) {
    auto power = std::make_shared<MeanPower>();
    power->mean_w = 360;  // 0.1 Wh a second
    request.vehicle.energy = std::make_shared<Energy>(Energy{power, capacity_wh, 1, 0.2});
    return point_of_no_return({{0, 0, 50}, {1000, 0, 50}}, request);
  };
  EXPECT_FALSE(point_of_no_return({{0, 0, 50}, {1000, 0, 50}}, request)) << "no battery";
  EXPECT_NEAR(*lasts(12.5), 50, 1) << "10 Wh are 100 s, half of them for the way back";
  EXPECT_DOUBLE_EQ(*lasts(25.1), 100) << "the end of the flight";
  request.vehicle.sink_mps = 1;
  EXPECT_NEAR(*lasts(12.5), 50, 1) << "the start is as high";
  request.wind.layers = {{-kInfinity, {-5, 0, 0}}};  // behind, it counts for nothing
  EXPECT_NEAR(*lasts(12.5), 50, 1);
  request.wind.layers = {{-kInfinity, {5, 0, 0}}};  // 10 m/s out, 5 m/s back
  EXPECT_NEAR(*lasts(12.5), 100 / 3.0, 1);
}

TEST(Energy, StandardAtmosphere) {
  EXPECT_NEAR(air_density(0), kSeaLevelDensity, 1e-5);
  EXPECT_NEAR(air_density(1000), 1.1116, 1e-4);
}
}  // namespace
}  // namespace altiplan::host::energy_test
