// SPDX-License-Identifier: Apache-2.0
// Wind by the cells of a grid: how legs are timed, priced and judged in it.
#include <gtest/gtest.h>

#include <cmath>

#include "altiplan/check.hpp"
#include "altiplan/flown_route.hpp"
#include "altiplan/measures.hpp"
#include "support/drag_power.hpp"
#include "support/support.hpp"

namespace altiplan::wind_grid_test {
namespace {

constexpr double kSpeed = 20;
const Box kVolume{{0, 0, 0}, {600, 400, 200}};

/// 6 x 4 cells of 100 m with these winds.
Wind wind_of(std::vector<std::array<float, 2>> velocities) {
  Wind wind;
  wind.layers = {{-kInfinity,
                  {0, 0, 0},
                  std::make_shared<WindGrid>(std::array{0.0, 0.0}, std::array{100.0, 100.0},
                                             std::array{6, 4}, std::move(velocities))}};
  return wind;
}

Wind random_wind(RandomStream& random, double strongest) {
  std::vector<std::array<float, 2>> velocities;
  for (int n = 0; n < 24; ++n) {
    const Vec3 velocity = strongest * random.uniform() * unit_heading(random.uniform(-kPi, kPi));
    velocities.push_back({float(velocity.x()), float(velocity.y())});
  }
  return wind_of(velocities);
}

Request request_in(Wind wind) {
  Request request = testing::request_in(World(), {10, 10, 50}, {590, 390, 50}, kVolume);
  request.vehicle.speed_mps = kSpeed;
  request.vehicle.wing = Wing{kSpeed, radians(30), radians(20), radians(20)};
  request.wind = std::move(wind);
  return request;
}

TEST(WindGrid, IsThatOfTheCell) {
  std::vector<std::array<float, 2>> velocities(24);
  velocities[6 * 1 + 2] = {3, -4};
  const Wind wind = wind_of(velocities);
  EXPECT_EQ(wind.at({250, 150, 10}), Vec3(3, -4, 0));
  EXPECT_EQ(wind.at({199, 150, 10}), Vec3(0, 0, 0));
  EXPECT_EQ(wind.max_speed(), 5);
  EXPECT_FALSE(wind.is_calm());
  EXPECT_TRUE(wind.is_uniform({{210, 110, 0}, {290, 190, 500}}));
  EXPECT_TRUE(wind.is_uniform({{200, 100, 0}, {300, 200, 500}}));
  EXPECT_FALSE(wind.is_uniform({{199, 110, 0}, {290, 190, 500}}));
  EXPECT_FALSE(wind.is_uniform({{210, 110, 0}, {290, 201, 500}}));
  const std::vector<double> crossings = wind.crossings({50, 50, 0}, {250, 150, 0});
  ASSERT_EQ(crossings.size(), 3u);
  EXPECT_DOUBLE_EQ(crossings[0], 0.25);
  EXPECT_DOUBLE_EQ(crossings[1], 0.5);
  EXPECT_DOUBLE_EQ(crossings[2], 0.75);
}

TEST(WindGrid, FlightTimesEqualFineSampling) {
  RandomStream random(1);
  for (int n = 0; n < 200; ++n) {
    const Wind wind = random_wind(random, 15);
    const Vec3 from = random.in(kVolume);
    const Vec3 to = random.in(kVolume);
    constexpr int kPieces = 20'000;
    double expected = 0;
    for (int k = 0; k < kPieces; ++k) {
      const Vec3 here = from + (k + 0.5) / kPieces * (to - from);
      expected += (to - from).head<2>().norm() / kPieces /
                  ground_speed(to - from, kSpeed, wind.at(here)).value();
    }
    EXPECT_NEAR(flight_time(from, to, kSpeed, wind), expected, 1e-3 * expected);
  }
}

TEST(WindGrid, OneCellTooWindyForTheCourseRefusesTheLeg) {
  std::vector<std::array<float, 2>> velocities(24);
  velocities[6 * 1 + 3] = {0, 21};
  const Request request = request_in(wind_of(velocities));
  const auto ok = [&](const Vec3& a, const Vec3& b) { return leg_ok(std::nullopt, a, b, request); };
  EXPECT_FALSE(ok({10, 150, 50}, {590, 150, 50}));
  EXPECT_FALSE(ok({10, 199, 50}, {590, 199, 50}));
  EXPECT_TRUE(ok({10, 250, 50}, {590, 250, 50}));
  EXPECT_FALSE(ok({290, 95, 50}, {395, 110, 50}));  // through a corner of it
}

TEST(WindGrid, ATurnStaysInACell) {
  std::vector<std::array<float, 2>> velocities(24, {4, 0});
  Request request = request_in(wind_of(velocities));
  request.limits.min_turn_radius = 30;
  const double turn = kPi / 2;
  const auto ok = [&](const Vec3& from) {
    const double seconds = 30 * turn / kSpeed;
    const Leg leg = Leg::turning({from, 0}, turn, 30, 0, Vec3(4 * seconds, 0, 0));
    return leg_ok(std::nullopt, leg, request);
  };
  EXPECT_TRUE(ok({110, 110, 50}));
  EXPECT_FALSE(ok({175, 110, 50}));  // over the border, though the wind is the same
  velocities[6 * 1 + 2] = {9, 0};
  request.wind = wind_of(velocities);
  EXPECT_TRUE(ok({110, 110, 50}));
  EXPECT_FALSE(ok({210, 110, 50}));  // it drifts by another wind
}

TEST(WindGrid, TheBordersOfOtherLayersDoNotCutATurn) {
  std::vector<std::array<float, 2>> velocities(24, {4, 0});
  Request request = request_in(wind_of(velocities));
  request.limits.min_turn_radius = 30;
  request.wind.layers.push_back({60, {0, 0, 0}});
  const auto ok = [&](double z, double climb, const Vec3& wind) {
    const Vec3 drift = 30 * kPi / 2 / kSpeed * wind;
    return leg_ok(std::nullopt, Leg::turning({{175, 110, z}, 0}, kPi / 2, 30, climb, drift),
                  request);
  };
  EXPECT_TRUE(ok(70, 0, {0, 0, 0}));
  EXPECT_TRUE(ok(60, 0, {0, 0, 0}));
  EXPECT_TRUE(ok(60, 5, {0, 0, 0}));
  EXPECT_FALSE(ok(55, 5, {4, 0, 0}));  // up to the border, within the grid
  EXPECT_FALSE(ok(58, 5, {0, 0, 0}));
}

TEST(WindGrid, ATurnFromBorderToBorderHasTheWindBetween) {
  std::vector<std::array<float, 2>> velocities(24);
  velocities[6 * 1 + 2] = {0, 4};  // east of x = 200
  Request request = request_in(wind_of(velocities));
  request.limits.min_turn_radius = 20;
  const auto ok = [&](const Vec3& wind) {
    const Vec3 drift = 20 * kPi / kSpeed * wind;
    return leg_ok(std::nullopt, Leg::turning({{200, 120, 50}, kPi}, -kPi, 20, 0, drift), request);
  };
  EXPECT_TRUE(ok({0, 0, 0}));
  EXPECT_FALSE(ok({0, 4, 0}));
}

TEST(WindGrid, ALoiterCircleIsFlownInTheStrongestWind) {
  std::vector<std::array<float, 2>> velocities(24);
  Request request = request_in(wind_of(velocities));
  request.goal.loiter = Loiter{40};
  request.goal.position = {150, 150, 50};
  EXPECT_EQ(goal_problem(request), "");
  velocities[6 * 1 + 1] = {21, 0};
  request.wind = wind_of(velocities);
  EXPECT_NE(goal_problem(request), "");
  request.goal.position = {230, 150, 50};  // its centre is calm
  EXPECT_NE(goal_problem(request), "");
}

TEST(WindGrid, EnergyAddsUpAcrossBorders) {
  RandomStream random(2);
  const testing::DragPower power;
  for (int n = 0; n < 100; ++n) {
    Request request = request_in(random_wind(random, 8));
    request.vehicle.wing.reset();
    const Vec3 from = random.in(kVolume);
    const Vec3 to = random.in(kVolume);
    const double whole = leg_energy(Leg::straight(from, to), 0, request, power);
    double sum = 0;
    constexpr int kPieces = 400;
    for (int k = 0; k < kPieces; ++k) {
      const Leg piece = Leg::straight(from + double(k) / kPieces * (to - from),
                                      from + (k + 1.0) / kPieces * (to - from));
      sum += leg_energy(piece, 0, request, power);
    }
    EXPECT_NEAR(whole, sum, 1e-9 * sum);
  }
}
}  // namespace
}  // namespace altiplan::wind_grid_test
