// SPDX-License-Identifier: Apache-2.0
// Legs across a border of layers of wind: their climb, and the joints of paths that cross it.
#include <gtest/gtest.h>

#include "altiplan/check.hpp"
#include "altiplan/kit/dubins/steering.hpp"
#include "altiplan/measures.hpp"
#include "support/support.hpp"

namespace altiplan::wind_layers_test {
namespace {

constexpr double kSpeed = 20;

/// A wind eastward below the border, and one westward above.
Request across(const Vec3& from, const Vec3& to) {
  Request request = testing::request_in(World(), from, to, {{-5e3, -5e3, 0}, {5e3, 5e3, 1e3}});
  request.vehicle.speed_mps = kSpeed;
  request.wind.layers = {{0, {10, 0, 0}}, {200, {-10, 0, 0}}};
  return request;
}

bool climbs(const Route& route, double limit) {
  Request request = across(route.front(), route.back());
  request.limits.max_climb = limit;
  return !check(route, request).ok();
}

TEST(WindLayers, TheClimbOfALegIsThatOfItsSteepestLayer) {
  const Vec3 low(0, 0, 150);
  const Vec3 high(540, 0, 250);
  // Below it flies 270 m at 30 m/s, which are 180 m through the air, and above 540 m.
  const double below = std::atan2(50.0, 180);
  for (const Route& route : {Route{low, high}, Route{low, {270, 0, 200}, high}}) {
    EXPECT_FALSE(climbs(route, below + 1e-6));
    EXPECT_TRUE(climbs(route, below - 1e-6));
  }
  // Downwards with the winds of a flight to the west: 540 m above, in a wind that helps 180 m.
  EXPECT_FALSE(climbs(Route{high, low}, below + 1e-6));
  EXPECT_TRUE(climbs(Route{high, low}, below - 1e-6));
  // Crosswind: both layers alike, so the mean is right.
  const double across = std::atan2(100.0, 540 / std::sqrt(300.0) * kSpeed);
  const Route north{low, {0, 540, 250}};
  EXPECT_FALSE(climbs(north, across + 1e-6));
  EXPECT_TRUE(climbs(north, across - 1e-6));
}

TEST(WindLayers, ALegThatEndsOnABorderClimbsInOneLayer) {
  const double above = std::atan2(50.0, 540);
  for (const double off : {0.0, 1e-12, 1e-7, -1e-7}) {
    EXPECT_FALSE(climbs(Route{{0, 0, 200 + off}, {270, 0, 250}}, above + 1e-6)) << off;
    EXPECT_FALSE(climbs(Route{{270, 0, 250}, {0, 0, 200 + off}}, std::atan2(50.0, 180) + 1e-6));
  }
}

TEST(WindLayers, AClimbOnTheSpotIsUpright) {
  EXPECT_TRUE(climbs(Route{{0, 0, 150}, {0, 0, 250}}, radians(89.9)));
}

TEST(WindLayers, APathKeepsTheCoursesOfPosesInOtherLayers) {
  RandomStream random(3);
  Request request = across({0, 0, 100}, {0, 0, 300});
  request.limits.max_climb = radians(20);
  const kit::Steering steering(request, 80);
  int found = 0;
  for (int n = 0; n < 200; ++n) {
    const Box box{{-2e3, -2e3, 100}, {2e3, 2e3, 300}};
    const Pose from{random.in(box), random.uniform(-kPi, kPi)};
    const Pose to{random.in(box), random.uniform(-kPi, kPi)};
    const auto path = steering.path(from, to);
    if (!path) {
      continue;
    }
    ++found;
    const Vec3 leaves = path->legs.front().rate(0);
    const Vec3 arrives = path->legs.back().rate(1);
    EXPECT_LT(turn_angle_horizontal(leaves, request.ground_velocity(from)), 1e-6) << n;
    EXPECT_LT(turn_angle_horizontal(arrives, request.ground_velocity(to)), 1e-6) << n;
    EXPECT_NEAR(steering.length(from, to), path->length, 1e-6);
    EXPECT_LE(steering.min_length(from, to), path->length * (1 + 1e-9));
    // From anywhere on the path the same course goes on.
    const Pose middle = steering.pose_at(from, *path, random.uniform(0, path->length));
    double corner = kPi;
    for (const Leg& leg : path->legs) {
      for (int k = 0; k <= 1000; ++k) {
        if ((leg.at(k / 1000.0) - middle.position).norm() < leg.length() / 1000) {
          corner = std::min(
              corner, turn_angle_horizontal(leg.rate(k / 1000.0), request.ground_velocity(middle)));
        }
      }
    }
    EXPECT_LT(corner, 0.02) << n;
  }
  EXPECT_GT(found, 150);
}

TEST(WindLayers, WhatRoundingLeavesOfAPathHasNoLeg) {
  Request request = across({0, 0, 100}, {0, 0, 300});
  const kit::Steering steering(request, 80);
  RandomStream random(4);
  for (int n = 0; n < 200; ++n) {
    const Pose from{random.in({{-2e3, -2e3, 100}, {2e3, 2e3, 100}}), random.uniform(-kPi, kPi)};
    const Leg ahead = steering.piece(from, random.uniform(50, 500), 0, 0);
    const Leg turn = steering.piece({ahead.to, from.heading}, random.uniform(50, 200), 1, 0);
    for (const Pose& to : {Pose{ahead.to, from.heading}, Pose{turn.to, from.heading + 1},
                           Pose{from.position + Vec3(6e-14, 3e-14, 0), from.heading}}) {
      const auto path = steering.path(from, to);
      ASSERT_TRUE(path) << n;
      for (const Leg& leg : path->legs) {
        EXPECT_GT(leg.length(), 5e-7) << n;
      }
    }
  }
}

// Flown in ArduPilot's simulation: 22 copters in 1.5 to 4.3 m/s of wind take the time of still air.
TEST(LegDuration, OfACopterIsAtItsSpeedOverTheGround) {
  RandomStream random(7);
  for (int n = 0; n < 200; ++n) {
    const Vec3 from = random.in({{-100, -100, 20}, {100, 100, 180}});
    const Vec3 to = random.in({{-100, -100, 20}, {100, 100, 180}});
    Request request = across(from, to);
    const Vec3 wind(random.uniform(-15, 15), random.uniform(-10, 10), 0);
    request.wind.layers = {{0, wind}};
    const double seconds = leg_duration(Leg::straight(from, to), request);
    EXPECT_NEAR(seconds, (to - from).norm() / kSpeed, 1e-9);
  }
}
}  // namespace
}  // namespace altiplan::wind_layers_test
