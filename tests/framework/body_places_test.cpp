// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/body_places.hpp"
#include "altiplan/shape.hpp"
#include "support/support.hpp"

namespace altiplan::body_places_test {
namespace {

const Vec3 kStart{0, 0, 10};
const Box kVolume{{-1e5, -1e5, -1e3}, {1e5, 1e5, 1e3}};

Request request_of(std::vector<BodyPart> parts, World world = {}) {
  Request request = testing::request_in(std::move(world), kStart, kStart, kVolume);
  request.vehicle.body = std::make_shared<Body>(Body{std::move(parts)});
  return request;
}

double yaw_deg(const Placement& place) {
  return degrees(std::atan2(place.rotation(1, 0), place.rotation(0, 0)));
}

TEST(BodyPlaces, WaypointsHaveBothAttitudes) {
  const Request request = request_of({box_part({2, 1, 0.4}, {0, 0, 0})});
  const Route route{kStart, {100, 0, 10}, {100, 50, 10}};
  const std::vector<Placement> places = body_along(route, request, 20);
  ASSERT_EQ(places.size(), 6U + 1 + 3);
  for (std::size_t n = 0; n < places.size(); ++n) {
    EXPECT_NEAR(yaw_deg(places[n]), n < 6 ? 0 : 90, 1e-9) << n;
  }
  EXPECT_EQ(places[5].at, route[1]);
  EXPECT_EQ(places[6].at, route[1]);
  EXPECT_EQ(places.back().at, route[2]);
}

TEST(BodyPlaces, TurnsAreBankedAndItRollsAtTheirEnds) {
  Request request = request_of({box_part({2, 1, 0.4}, {0, 0, 0})});
  request.vehicle.speed_mps = 15;
  Route route;
  route.push_back(Leg::turning({kStart, 0}, kPi / 2, 40, 0));
  const std::vector<Placement> places = body_along(route, request, 1e3);
  ASSERT_EQ(places.size(), 4U);
  const double bank = std::atan(15 * 15 / (9.80665 * 40));
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_NEAR(std::acos(places[n].rotation(2, 2)), n == 0 || n == 3 ? 0 : bank, 1e-7) << n;
    EXPECT_NEAR(yaw_deg(places[n]), n < 2 ? 0 : 90, 1e-6) << n;
  }
}

TEST(BodyPlaces, ASphereAloneHasNone) {
  Request request = request_of({});
  request.vehicle.body = nullptr;
  const Route route{kStart, {100, 0, 10}};
  EXPECT_TRUE(body_along(route, request, 1).empty());
  EXPECT_FALSE(nearest_body(route, request));
}

TEST(BodyPlaces, NothingIsNearInAnEmptyWorld) {
  const Request request = request_of({box_part({2, 1, 0.4}, {0, 0, 0})});
  EXPECT_FALSE(nearest_body({kStart, {100, 0, 10}}, request));
  EXPECT_FALSE(nearest_body({kStart}, request));
}

TEST(BodyPlaces, TheNearestPlaceIsBesideTheWall) {
  const Request request =
      request_of({box_part({2, 1, 0.4}, {0, 0, 0}), box_part({0.2, 3, 0.2}, {0, 0, 0.3})},
                 testing::world_of({BoxShape{{{40, 1.92, 0}, {60, 5, 20}}},
                                    BoxShape{{{70, -9, 0}, {80, -2.2, 20}}}}));
  const auto nearest = nearest_body({kStart, {100, 0, 10}}, request);
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(nearest->distance, 0.42, 0.01);
  EXPECT_GT(nearest->placement.at.x(), 39.8);
  EXPECT_LT(nearest->placement.at.x(), 60.2);
  EXPECT_TRUE(nearest->proven);
  EXPECT_EQ(nearest->layer, request.world->layers().front().id);
}

// A rod that turns about its middle points at a thin pole for a moment.
TEST(BodyPlaces, TheNearestPlaceMayBeWithinATurnOnTheSpot) {
  const Vec3 corner{100, 0, 10};
  for (const double bearing : {33.0, 45.0}) {
    const Vec3 pole = corner + 2.03 * unit_heading(radians(bearing));
    const Request request =
        request_of({box_part({4, 0.002, 0.002}, {0, 0, 0})},
                   testing::world_of({Cylinder{pole.x(), pole.y(), 0.01, 0, 20}}));
    const auto nearest = nearest_body({kStart, corner, {100, 80, 10}}, request);
    ASSERT_TRUE(nearest);
    EXPECT_NEAR(nearest->distance, 0.02, 0.01);
    EXPECT_NEAR(yaw_deg(nearest->placement), bearing, 1);
  }
}

TEST(BodyPlaces, WhereItMeetsAnObstacleTheDistanceIsZero) {
  for (const double radius : {0.5, 500.0}) {  // the larger ball has all of it inside
    const Request request = request_of({box_part({2, 1, 0.4}, {0, 0, 0})},
                                       testing::world_of({Sphere{{50, 0.2 + radius, 10}, radius}}));
    for (const Route& route : {Route{kStart, {100, 0, 10}}, Route{{50, 9, 10}, {52, 9, 10}}}) {
      const auto nearest = nearest_body(route, request);
      ASSERT_TRUE(nearest) << radius;
      EXPECT_EQ(nearest->distance == 0, route[0] == kStart || radius > 9) << radius;
    }
  }
}

// On a straight leg a capsule sweeps a longer capsule: its distance to a ball is known.
TEST(BodyPlaces, DistancesOfRandomCapsulesAreExact) {
  RandomStream random(11);
  for (int n = 0; n < 60; ++n) {
    const double radius = random.uniform(0.1, 1);
    const double length = 2 * radius + random.uniform(0, 3);
    Request request = request_of({capsule_part(radius, length, {0, 0, 0})});
    const Vec3 to =
        kStart + Vec3(random.uniform(20, n % 5 == 0 ? 50'000 : 300), random.uniform(-50, 50), 0);
    const Vec3 along = (to - kStart).normalized() * (length / 2 - radius);
    std::vector<Shape> balls;
    double least = kInfinity;
    for (int k = 0; k < 20; ++k) {
      const Vec3 on_route = kStart + random.uniform(-0.1, 1.1) * (to - kStart);
      const Vec3 aside = random.in({{-20, -20, -20}, {20, 20, 20}});
      const Sphere ball{on_route + aside, random.uniform(0.1, 5)};
      balls.emplace_back(ball);
      least = std::min(least, point_leg_distance(ball.centre, kStart - along, to + along) - radius -
                                  ball.radius);
    }
    request.world = std::make_shared<World>(testing::world_of(balls));
    const auto nearest = nearest_body({kStart, to}, request);
    ASSERT_TRUE(nearest) << n;
    EXPECT_TRUE(nearest->proven) << n;
    EXPECT_NEAR(nearest->distance, std::max(0.0, least), 0.01) << n;
  }
}
}  // namespace
}  // namespace altiplan::body_places_test
