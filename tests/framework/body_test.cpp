// SPDX-License-Identifier: Apache-2.0
// How a body is held along a route: where it fits, and where it just does not.
#include <gtest/gtest.h>

#include "altiplan/body.hpp"
#include "altiplan/check.hpp"
#include "altiplan/error.hpp"
#include "support/support.hpp"

namespace altiplan::body_test {
namespace {

using testing::request_in;
using testing::world_of;

const Box kVolume{{-1000, -1000, -1000}, {1000, 1000, 1000}};

Request with_body(std::vector<Shape> shapes, BodyPart part) {
  Request request = request_in(world_of(std::move(shapes)), {0, 0, 0}, {10, 0, 0}, kVolume);
  auto body = std::make_shared<Body>();
  body->parts.push_back(std::move(part));
  request.vehicle.radius_m = request.limits.min_clearance = body->inner_m();
  request.vehicle.body = std::move(body);
  return request;
}

/// 1 m long, 3 m wide, 0.4 m high.
const BodyPart kFlat = box_part({1, 3, 0.4}, {0, 0, 0});

/// A wall across x with a hole that is `width` wide and `height` high about the x axis.
std::vector<Shape> letterbox(double width, double height) {
  const auto box = [](double y0, double y1, double z0, double z1) {
    return BoxShape{{{5, y0, z0}, {5.5, y1, z1}}};
  };
  return {box(-50, -width / 2, -50, 50), box(width / 2, 50, -50, 50),
          box(-width / 2, width / 2, -50, -height / 2), box(-width / 2, width / 2, height / 2, 50)};
}

TEST(Body, AFlatWingPassesASlotOfItsShapeAndNoOther) {
  const Vec3 from(0, 0, 0);
  const Vec3 to(10, 0, 0);
  EXPECT_TRUE(leg_ok(std::nullopt, from, to, with_body(letterbox(5, 1), kFlat)));
  EXPECT_FALSE(leg_ok(std::nullopt, from, to, with_body(letterbox(1, 5), kFlat)));
  // To a millimetre.
  EXPECT_TRUE(leg_ok(std::nullopt, from, to, with_body(letterbox(3.002, 0.402), kFlat)));
  EXPECT_FALSE(leg_ok(std::nullopt, from, to, with_body(letterbox(2.998, 1), kFlat)));
  EXPECT_FALSE(leg_ok(std::nullopt, from, to, with_body(letterbox(5, 0.398), kFlat)));
}

TEST(Body, TheViolationNamesTheLayer) {
  const auto found =
      leg_violations(std::nullopt, {0, 0, 0}, {10, 0, 0}, with_body(letterbox(1, 5), kFlat), 3);
  ASSERT_EQ(found.size(), 1);
  EXPECT_EQ(found[0].constraint, "body");
  EXPECT_EQ(found[0].at, 3);
  EXPECT_NE(found[0].message.find("meets 'shapes'"), std::string::npos) << found[0].message;
}

TEST(Body, ClimbingItStaysLevelOrPitches) {
  // 20 m long, up a slope of 45 degrees through a shaft of that slope.
  const BodyPart pole = box_part({20, 0.2, 0.2}, {0, 0, 0});
  const auto shaft = [](double side) {
    return std::vector<Shape>{
        Prism{{{side, -50}, {side + 1, -50}, {side + 1, 50}, {side, 50}}, {}, side, 100}};
  };
  Request request = with_body(shaft(2), pole);
  const Vec3 below(-30, 0, -30);
  const Vec3 above(-20, 0, -20);
  EXPECT_TRUE(leg_ok(std::nullopt, below, above, request));
  // Level, the nose reaches x = 2 where it is still below the wall; climbing on it meets it.
  EXPECT_TRUE(leg_ok(std::nullopt, below, {-9, 0, -9}, request));
  EXPECT_FALSE(leg_ok(std::nullopt, below, {-7.5, 0, 2.5}, request));
  auto pitching = std::make_shared<Body>(*request.vehicle.body);
  pitching->pitches = true;
  request.vehicle.body = pitching;
  EXPECT_TRUE(leg_ok(std::nullopt, {-17.5, 0, -7.5}, {-7.5, 0, 2.5}, request));
}

TEST(Body, TurningAtAWaypointNeedsRoom) {
  // A post beside both legs, in the way of the turn between them.
  const auto beside = [](double x, double y) {
    return with_body({Sphere{{x, y, 0}, 0.1}}, box_part({3, 0.2, 0.2}, {0, 0, 0}));
  };
  const Vec3 west(-10, 0, 0);
  const Vec3 here(0, 0, 0);
  const Vec3 north(0, 10, 0);
  const Vec3 south(0, -10, 0);
  const Request request = beside(0.9, 0.9);
  EXPECT_TRUE(leg_ok(std::nullopt, west, here, request));
  EXPECT_TRUE(leg_ok(std::nullopt, here, north, request));
  EXPECT_FALSE(leg_ok(Approach(west), here, north, request));
  // Turning the other way its tail passes elsewhere.
  EXPECT_TRUE(leg_ok(Approach(west), here, south, request));
  EXPECT_FALSE(leg_ok(Approach(west), here, south, beside(-0.9, 0.9)));
  EXPECT_TRUE(leg_ok(Approach(west), here, north, beside(-0.9, 0.9)));
  // A reversal may go either way round.
  EXPECT_FALSE(leg_ok(Approach(west), here, west, request));
  EXPECT_FALSE(leg_ok(Approach(west), here, west, beside(0.9, -0.9)));
}

TEST(Body, AnUnknownHeadingMustFitAtAny) {
  const BodyPart pole = box_part({3, 0.2, 0.2}, {0, 0, 0});
  const std::vector<Shape> wall{BoxShape{{{1, -20, 0}, {2, 20, 5}}}};
  Request request = with_body(wall, pole);
  const Vec3 up(0, 0, 3);
  EXPECT_FALSE(leg_ok(std::nullopt, {0, 0, 0}, up, request));
  EXPECT_FALSE(leg_ok(Approach({-1, 0, 0}), {0, 0, 0}, up, request));  // towards the wall
  EXPECT_TRUE(leg_ok(Approach({0, -1, 0}), {0, 0, 0}, up, request));   // along it
  auto fixed = std::make_shared<Body>(*request.vehicle.body);
  fixed->yaw = kPi / 2;
  request.vehicle.body = fixed;
  EXPECT_TRUE(leg_ok(std::nullopt, {0, 0, 0}, up, request));
  EXPECT_TRUE(leg_ok(Approach({-1, 0, 0}), {0, 0, 0}, up, request));
}

TEST(Body, BankLowersTheInnerWing) {
  // 60 m of span on a circle of 100 m at 30 m/s: banked by 42.5 degrees, its tip is 20 m lower.
  const BodyPart wing = box_part({2, 60, 0.5}, {0, 0, 0});
  const Leg turn = Leg::turning({{0, 0, 0}, 0}, kPi / 2, 100, 0);
  const auto floor_at = [&](double z) {
    Request request = with_body({BoxShape{{{-300, -300, -50}, {300, 300, z}}}}, wing);
    request.vehicle.speed_mps = 30;
    return request;
  };
  const double tip = 30 * std::sin(std::atan(900 / (9.80665 * 100))) +
                     0.25 * std::cos(std::atan(900 / (9.80665 * 100)));
  EXPECT_TRUE(leg_ok(std::nullopt, turn, floor_at(-tip - 0.05)));
  EXPECT_FALSE(leg_ok(std::nullopt, turn, floor_at(-tip + 0.05)));
  EXPECT_TRUE(leg_ok(std::nullopt, {0, 0, 0}, {50, 0, 0}, floor_at(-1)));
}

TEST(Body, AnAeroplaneCrabsIntoTheWind) {
  // Across a wind of half its airspeed it flies with its nose 30 degrees off its course.
  const BodyPart pole = box_part({10, 0.2, 0.2}, {0, 0, 0});
  const std::vector<Shape> lane{BoxShape{{{-50, 1, -5}, {50, 2, 5}}},
                                BoxShape{{{-50, -2, -5}, {50, -1, 5}}}};
  Request request = with_body(lane, pole);
  request.vehicle.wing = Wing{20};
  EXPECT_TRUE(leg_ok(std::nullopt, {-20, 0, 0}, {20, 0, 0}, request));
  request.wind.layers.push_back({-kInfinity, {0, 10, 0}});
  EXPECT_FALSE(leg_ok(std::nullopt, {-20, 0, 0}, {20, 0, 0}, request));
}

TEST(Body, HullsOfPoints) {
  // Points inside do not count; a flat set and one with too many corners are refused.
  std::vector<Vec3> points = kFlat.corners;
  for (int n = 0; n < 1000; ++n) {
    points.push_back(0.9 * std::sin(n) * points[std::size_t(n) % 8]);
  }
  EXPECT_EQ(hull_part(points).corners.size(), 8);
  EXPECT_THROW(hull_part({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.0005}}), Error);
  EXPECT_THROW(hull_part({}), Error);
  std::vector<Vec3> ball;
  for (int n = 0; n < 20'000; ++n) {
    ball.push_back(Vec3(std::sin(n), std::sin(1.7 * n + 1), std::cos(2.3 * n)).normalized());
  }
  EXPECT_THROW(hull_part(ball), Error);
}

TEST(Body, RadiiAboutTheReferencePoint) {
  Body body;
  body.parts = {box_part({1, 3, 0.4}, {0, 0, 0}), capsule_part(0.25, 2, {0, 0, -3})};
  EXPECT_NEAR(body.inner_m(), 0.2, 1e-12);
  EXPECT_NEAR(body.outer_m(), std::hypot(0.75, 3) + 0.25, 1e-12);
  EXPECT_NEAR(cylinder_part(2, 6, {0.5, 0, 1}).inner_m, 1.5, 1e-12);
  EXPECT_THROW(capsule_part(1, 1.5, {0, 0, 0}), Error);
}
}  // namespace
}  // namespace altiplan::body_test
