// SPDX-License-Identifier: Apache-2.0
// Routes among moving obstacles that are known beforehand: what the judge refuses, and when.
#include <gtest/gtest.h>

#include <memory>

#include "altiplan/check.hpp"
#include "altiplan/measures.hpp"
#include "altiplan/smoother.hpp"
#include "support/support.hpp"

namespace altiplan {
namespace {

/// A ball of 10 m that crosses the line from (0, 0, 50) to (200, 0, 50) in its middle, from the
/// south, 10 s after the start; the vehicle flies 10 m/s, and is a ball of 2 m.
MovingObstacle crossing(bool planned) {
  return {"barge", Sphere{{100, -50, 50}, 10}, {0, 5, 0}, 0, true, planned};
}

Request among(std::vector<MovingObstacle> moving) {
  Request request = testing::request_in(World().with_moving(std::move(moving)), {0, 0, 50},
                                        {200, 0, 50}, {{-100, -100, 0}, {300, 100, 100}});
  request.vehicle.speed_mps = 10;
  request.limits.min_clearance = request.vehicle.radius_m = 2;
  return request;
}

TEST(MovingRoutes, BesideAMoverIsRefusedWithItsNameTimeAndDistance) {
  const Route straight{{0, 0, 50}, {200, 0, 50}};
  const CheckResult met = check(straight, among({crossing(true)}));
  ASSERT_EQ(met.violations.size(), 1U);
  const Violation& violation = met.violations.front();
  EXPECT_EQ(violation.constraint, "moving");
  EXPECT_EQ(violation.at, 0U);
  EXPECT_EQ(violation.value, 0);
  EXPECT_EQ(violation.limit, 2);
  EXPECT_NE(violation.message.find("'barge'"), std::string::npos) << violation.message;
  EXPECT_NE(violation.message.find(" s after the start"), std::string::npos) << violation.message;
  // Where it is not planned against, it is left to the flight.
  EXPECT_TRUE(check(straight, among({crossing(false)})).ok());
}

TEST(MovingRoutes, TheTimeAndDistanceAreThoseOfTheNearestPlace) {
  // Head on at 2 · 10 m/s, 13 m beside: nearest after 100 / 20 s, with 13 - 10 m between.
  const MovingObstacle opposite{"tram", Sphere{{100, 13, 50}, 10}, {-10, 0, 0}, 0, true, true};
  Request request = among({opposite});
  request.limits.min_clearance = 3.5;
  const Route straight{{0, 0, 50}, {200, 0, 50}};
  const CheckResult met = check(straight, request);
  ASSERT_EQ(met.violations.size(), 1U);
  EXPECT_NEAR(met.violations.front().value, 3, 1e-9);
  EXPECT_NE(met.violations.front().message.find("5.00 s after the start at (50.00, 0.00, 50.00)"),
            std::string::npos)
      << met.violations.front().message;
  request.limits.min_clearance = 3;  // touching is free
  EXPECT_TRUE(check(straight, request).ok());
}

TEST(MovingRoutes, EveryLegHasItsOwnTime) {
  // The detour of 40 m lets the ball, which takes 4.8 s to leave, pass; a later start too.
  const Request request = among({crossing(true)});
  EXPECT_FALSE(check({{0, 0, 50}, {100, 0, 50}, {200, 0, 50}}, request).ok());
  EXPECT_TRUE(check({{0, 0, 50}, {0, 0, 70}, {0, 0, 50}, {200, 0, 50}}, request).ok());
  Request later = request;
  later.start.time_s = 4;
  EXPECT_TRUE(check({{0, 0, 50}, {200, 0, 50}}, later).ok());
}

TEST(MovingRoutes, AWaitLetsAMoverPass) {
  const Request request = among({crossing(true)});
  Route waits{{0, 0, 50}, {50, 0, 50}};
  waits.push_back(Leg::hold({50, 0, 50}, 4));
  waits.push_back(Vec3(200, 0, 50));
  EXPECT_TRUE(check(waits, request).ok());
  EXPECT_DOUBLE_EQ(*measure(waits, request).duration_s, 24);
  EXPECT_EQ(without_repeats(waits), waits);
  Route too_short{{0, 0, 50}, {50, 0, 50}};
  too_short.push_back(Leg::hold({50, 0, 50}, 1));
  too_short.push_back(Vec3(200, 0, 50));
  EXPECT_FALSE(check(too_short, request).ok());
  // Where the mover comes to the vehicle that waits.
  Route in_the_way{{0, 0, 50}, {100, 0, 50}};
  in_the_way.push_back(Leg::hold({100, 0, 50}, 3));
  in_the_way.push_back(Vec3(200, 0, 50));
  const MovingObstacle late{"late", Sphere{{100, -65, 50}, 10}, {0, 5, 0}, 0, true, true};
  const CheckResult met = check(in_the_way, among({late}));
  ASSERT_FALSE(met.ok());
  EXPECT_EQ(met.violations.front().at, 1U);
}

TEST(MovingRoutes, WhatCannotHoverCannotWait) {
  Route waits{{0, 0, 50}, {100, 0, 50}};
  waits.push_back(Leg::hold({100, 0, 50}, 4));
  waits.push_back(Vec3(200, 0, 50));
  Request request = among({});
  EXPECT_TRUE(check(waits, request).ok());
  request.wind.layers = {{-kInfinity, {11, 0, 0}}};
  EXPECT_FALSE(check(waits, request).ok());
  request.wind.layers.clear();
  request.vehicle.wing = Wing{};
  const CheckResult refused = check(waits, request);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.violations.front().message, "an aeroplane cannot wait in one place");
  Route moves{{0, 0, 50}, {100, 0, 50}};
  Leg leg = Leg::straight({100, 0, 50}, {200, 0, 50});
  leg.hold_s = 4;
  moves.push_back(leg);
  EXPECT_FALSE(check(moves, among({})).ok());
}

TEST(MovingRoutes, TurnsAreDecidedWherePointsOfThemWould) {
  // A circle of 30 m around a ball that stays: exactly at, and just below, the required distance.
  Request request = among({{"buoy", Sphere{{100, 0, 50}, 10}, {0, 0, 0}, 0, true, true}});
  request.start.position = request.goal.position = {130, 0, 50};
  Route circle;
  circle.push_back(Leg::turning({{130, 0, 50}, kPi / 2}, 2 * kPi, 30, 0));
  request.goal.tolerance_m = 1e-3;
  request.limits.min_clearance = 20;
  EXPECT_TRUE(check(circle, request).ok());
  request.limits.min_clearance = 20 + 1e-5;
  EXPECT_FALSE(check(circle, request).ok());
  // One that crosses the circle's far side, 10 pi m / 10 m/s after the start, and one too late.
  const double half = 30 * kPi / 10;
  request.limits.min_clearance = 2;
  for (const double late : {0.0, 8.0}) {
    const Vec3 at_0 = Vec3(70, 0, 50) - (half + late) * Vec3(0, 0, 3);
    request.world = std::make_shared<World>(
        World().with_moving({{"lift", Sphere{at_0, 10}, {0, 0, 3}, 0, true, true}}));
    EXPECT_EQ(check(circle, request).ok(), late > 0) << late;
  }
}

TEST(MovingRoutes, WindMovesTheTimes) {
  // With a tail wind of 10 m/s an aeroplane is beyond the crossing before the ball is there.
  Request request = among({crossing(true)});
  const Route route{{0, 0, 50}, {200, 0, 50}};
  request.wind.layers = {{-kInfinity, {10, 0, 0}}};
  EXPECT_FALSE(check(route, request).ok()) << "a copter keeps its speed over the ground";
  Wing wing;
  wing.airspeed_mps = 10;
  request.vehicle.wing = wing;
  EXPECT_TRUE(check(route, request).ok());
  request.wind = {};
  EXPECT_FALSE(check(route, request).ok());
}

/// Cuts to its ends.
class Straight final : public Smoother {
  PlanResult do_smooth(const Polyline& route, const Request&) const override {
    PlanResult result;
    result.status = PlanStatus::solved;
    result.route = {route.front(), route.back()};
    return result;
  }
};

TEST(MovingRoutes, SmoothersNeverLeadAValidRouteIntoAMover) {
  const Request request = among({crossing(true)});
  const Route around{{0, 0, 50}, {0, 0, 70}, {0, 0, 50}, {200, 0, 50}};
  EXPECT_EQ(Straight().smooth(around, request).route, around);
  EXPECT_EQ(Straight().smooth(around, among({})).route.size(), 2U);
  Route waits{{0, 0, 50}};
  waits.push_back(Leg::hold({0, 0, 50}, 4));
  waits.push_back(Vec3(200, 0, 50));
  EXPECT_EQ(Straight().smooth(waits, among({})).route, waits);
}
}  // namespace
}  // namespace altiplan
