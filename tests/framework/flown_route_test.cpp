// SPDX-License-Identifier: Apache-2.0
#include "altiplan/flown_route.hpp"

#include <gtest/gtest.h>

#include "altiplan/energy.hpp"
#include "altiplan/measures.hpp"
#include "support/support.hpp"

namespace altiplan::flown_route_test {
namespace {

/// 100 W, 10 W for each m/s of airspeed and 20 W for each m/s of climb.
struct SimplePower final : Power {
  double watts(const SteadyFlight& flight) const override {
    return 100 + 10 * flight.airspeed_mps + 20 * std::max(0.0, flight.climb_mps);
  }
};

Request request_at(double speed_mps) {
  Request request =
      testing::request_in({}, {0, 0, 100}, {1000, 0, 100}, {{0, 0, 0}, {1000, 1000, 400}});
  request.vehicle.speed_mps = speed_mps;
  return request;
}

TEST(FlownRoute, StopsAtEachPoint) {
  Request request = request_at(3);
  request.vehicle.acceleration.mps2 = 1;
  // A triangle of 4 m, a trapezoid of 12 m, and a point passed straight on.
  const Route route{{0, 0, 100}, {4, 0, 100}, {4, 12, 100}, {4, 16, 100}};
  EXPECT_DOUBLE_EQ(flown_time(route, request), 4 + 7 + 4);
  EXPECT_DOUBLE_EQ(*measure(route, request).time_s, 15);
  EXPECT_DOUBLE_EQ(*measure(route, request).duration_s, 20 / 3.0);
  EXPECT_FALSE(measure(route, request).energy_wh);
  request.vehicle.acceleration.mps2 = kInfinity;
  EXPECT_DOUBLE_EQ(flown_time(route, request), 20 / 3.0);
}

TEST(FlownRoute, LegsMayBeAsShortAsTheyLike) {
  Request request = request_at(300);
  request.vehicle.acceleration = {.mps2 = 0.01, .corner_radius_m = 5};
  for (const double jerk : {kInfinity, 0.5}) {
    request.vehicle.acceleration.jerk_mps3 = jerk;
    Polyline points{{0, 0, 100}, {2e6, 0, 100}};  // where it still speeds up
    for (int n = 1; n < 50; ++n) {
      points.push_back(points.back() + Vec3(n % 2 == 0 ? 2e-6 : 0.04, 0, 0));
    }
    points.push_back({1e7 + 1, 0, 100});
    const double whole = flown_time({points.front(), points.back()}, request);
    EXPECT_NEAR(flown_time(points, request) / whole, 1, 1e-6);
  }
}

TEST(FlownRoute, WaitsBetweenStops) {
  Request request = request_at(3);
  request.vehicle.acceleration.mps2 = 1;
  request.vehicle.acceleration.corner_radius_m = 2;
  Route route{{0, 0, 100}, {12, 0, 100}};
  route.push_back(Leg::hold({12, 0, 100}, 5));
  route.push_back(Vec3(24, 0, 100));
  EXPECT_DOUBLE_EQ(flown_time(route, request), 7 + 5 + 7);
}

TEST(FlownRoute, PassesCornersWithinTheirRadius) {
  Request request = request_at(10);
  request.vehicle.acceleration = {.mps2 = 2, .corner_radius_m = 4};
  const Route straight{{0, 0, 100}, {100, 0, 100}, {200, 0, 100}};
  const Route whole{{0, 0, 100}, {200, 0, 100}};
  EXPECT_DOUBLE_EQ(flown_time(straight, request), flown_time(whole, request));
  // A right angle: the arc has the radius 4 m, so that it is passed at sqrt(8) m/s.
  const Route bent{{0, 0, 100}, {100, 0, 100}, {100, 100, 100}};
  const double corner = std::sqrt(8);
  EXPECT_DOUBLE_EQ(flown_time(bent, request),
                   2 * sprint(100, 0, corner, 10, request.vehicle.acceleration)->seconds());
  // And at most to the middle of a leg: here 1 m.
  const Route near{{0, 0, 100}, {2, 0, 100}, {2, 100, 100}};
  double passes = 0;
  double along = 0;
  fly(near, request, [&](const FlownPhase& phase) {
    along += (phase.to - phase.from).norm();
    passes = along < 2 + 1e-9 ? phase.to_mps : passes;
  });
  EXPECT_DOUBLE_EQ(passes, std::sqrt(2));
}

TEST(FlownRoute, IsSlowWhereItClimbsAndSinks) {
  Request request = request_at(10);
  request.vehicle.climb_mps = 2.5;
  request.vehicle.sink_mps = 1.5;
  const Route up{{0, 0, 100}, {0, 30, 140}};
  EXPECT_DOUBLE_EQ(flown_time(up, request), 40 / 2.5);
  EXPECT_DOUBLE_EQ(*measure(up, request).duration_s, 40 / 2.5);
  EXPECT_DOUBLE_EQ(flown_time({{0, 30, 140}, {0, 0, 100}}, request), 40 / 1.5);
  EXPECT_DOUBLE_EQ(flown_time({{0, 0, 100}, {0, 100, 101}}, request), 100 / 10.0);
  request.vehicle.speed_near = {{20, 5}};
  request.world = std::make_shared<const World>(testing::world_of({Sphere{{0, 15, 160}, 5}}));
  EXPECT_NEAR(flown_time(up, request), 40 / 2.5, 1e-9) << "slower than near the obstacle";
  request.wind.layers = {{-kInfinity, {1, 0, 0}}, {120, {2, 0, 0}}};
  EXPECT_NEAR(flown_time(up, request), 40 / 2.5, 1e-9);
}

TEST(FlownRoute, ItsEnergyIsThatOfEachMoment) {
  Request request = request_at(10);
  const SimplePower power;
  const Route route{{0, 0, 100}, {100, 0, 100}};
  EXPECT_DOUBLE_EQ(flown_energy(route, request, power), 200 * 10 / 3600.0);
  request.vehicle.acceleration.mps2 = 2;  // 5 s to 10 m/s and 25 m, twice
  EXPECT_DOUBLE_EQ(flown_energy(route, request, power), (150 * 10 + 200 * 5) / 3600.0);
  request.wind.layers = {{-kInfinity, {4, 0, 0}}};  // behind: 6 m/s through the air
  request.vehicle.acceleration.mps2 = kInfinity;
  EXPECT_NEAR(flown_energy(route, request, power), 160 * 10 / 3600.0, 1e-12);
  Route waits{{0, 0, 100}};
  waits.push_back(Leg::hold({0, 0, 100}, 36));
  EXPECT_NEAR(flown_energy(waits, request, power), 140 * 36 / 3600.0, 1e-12) << "in the wind";
  request.wind = {};
  request.vehicle.climb_mps = 3;
  EXPECT_NEAR(flown_energy({{0, 0, 100}, {0, 0, 130}}, request, power), 160 * 10 / 3600.0, 1e-12);
}

TEST(FlownRoute, AgainstAStrongerWindItsEnergyIsInfinite) {
  Request request = request_at(10);
  const Route route{{1000, 0, 100}, {0, 0, 160}};
  request.vehicle.wing = Wing{.airspeed_mps = 10};
  request.wind.layers = {{-kInfinity, {3, 0, 0}}, {110, {11, 0, 0}}, {150, {12, 0, 0}}};
  EXPECT_EQ(flown_energy(route, request, SimplePower()), kInfinity);
  EXPECT_EQ(leg_energy(route.leg(0), 0, request, SimplePower()), kInfinity);
  EXPECT_EQ(flown_time(route, request), kInfinity);
}

TEST(FlownRoute, NoRouteTakesMoreThanTheBatteryGives) {
  Request request = request_at(10);
  const Route route{{0, 0, 100}, {1000, 0, 100}};
  const double needs = 200 * 100 / 3600.0;
  const auto judged = [&](double capacity_wh) {
    request.vehicle.energy =
        std::make_shared<Energy>(Energy{std::make_shared<SimplePower>(), capacity_wh, 0.8, 0.25});
    return check(route, request);
  };
  EXPECT_TRUE(judged(needs / 0.6 * (1 + 1e-9)).ok());
  const CheckResult refused = judged(needs / 0.6 * (1 - 1e-6));
  ASSERT_EQ(refused.violations.size(), 1u);
  EXPECT_EQ(refused.violations.front().constraint, "energy");
  EXPECT_DOUBLE_EQ(refused.violations.front().value, needs);
  EXPECT_EQ(refused.violations.front().unit, "Wh");
  EXPECT_TRUE(judged(kInfinity).ok()) << "no capacity is known";
}
}  // namespace
}  // namespace altiplan::flown_route_test
