// SPDX-License-Identifier: Apache-2.0
#include "altiplan/check.hpp"

#include <gtest/gtest.h>

#include "altiplan/measures.hpp"
#include "support/support.hpp"

namespace altiplan::check_test {
namespace {

using testing::request_in;
using testing::world_of;

constexpr double kBig = 1e4;
const Box kVolume{{-kBig, -kBig, -kBig}, {kBig, kBig, kBig}};

Request empty_request() { return request_in(World(), {0, 0, 100}, {1000, 0, 100}, kVolume); }

std::string rules(const CheckResult& result) {
  std::string text;
  for (const Violation& violation : result.violations) {
    text += violation.constraint + "@" + std::to_string(violation.at) + " ";
  }
  return text;
}

TEST(Check, EndsAndVolume) {
  Request request = empty_request();
  request.goal.tolerance_m = 5;
  EXPECT_EQ(rules(check({{0, 0, 100}, {996, 0, 100}}, request)), "");
  EXPECT_EQ(rules(check({{0, 0, 100}, {994, 0, 100}}, request)), "goal@1 ");
  EXPECT_EQ(rules(check({{0, 0, 100.0000001}, {1000, 0, 100}}, request)), "start@0 ");
  EXPECT_EQ(check({{0, 0, 100.0000001}, {1000, 0, 100}}, request).violations.at(0).message,
            "the route begins 1e-07 m from the start");
  EXPECT_EQ(rules(check({}, request)), "route@0 ");
  EXPECT_EQ(rules(check({{0, 0, 100}, {0, kBig + 1, 100}, {1000, 0, 100}}, request)),
            "volume@1 volume@1 ");
}

TEST(Check, ViolationsSayTheirUnitAndLayer) {
  Request request = empty_request();
  const auto of = [&](const Route& route, const std::string& rule) {
    Violation found;
    for (const Violation& violation : check(route, request).violations) {
      found = violation.constraint == rule ? violation : found;
    }
    return found.unit + " of '" + found.layer + "'";
  };
  const Route bend{{0, 0, 100}, {500, 0, 300}, {1000, 500, 100}};
  request.limits.max_turn_horizontal = request.limits.max_climb = radians(5);
  request.limits.max_route_length = 10;
  EXPECT_EQ(of(bend, "turn_angle"), "deg of ''");
  EXPECT_EQ(of(bend, "climb_angle"), "deg of ''");
  EXPECT_EQ(of(bend, "route_length"), "m of ''");
  EXPECT_EQ(of(bend, "goal"), "m of ''");
  request.world = std::make_shared<const World>(world_of({Sphere{{500, 0, 100}, 50}}));
  EXPECT_EQ(of({{0, 0, 100}, {1000, 0, 100}}, "clearance"), "m of 'shapes'");
}

TEST(Check, TurnsInThePlaneAndInSpaceAreHeldToTheLastBit) {
  Request request = empty_request();
  const Route bend{{0, 0, 100}, {500, 0, 100}, {1000, 500, 100}};  // 45 degrees
  request.goal.position = bend.back();
  request.limits.max_turn_horizontal = radians(45);
  EXPECT_EQ(rules(check(bend, request)), "");
  request.limits.max_turn_horizontal = radians(45) - 2 * kAngleTolerance;
  EXPECT_EQ(rules(check(bend, request)), "turn_angle@1 ");
  request.limits.max_turn_horizontal = kPi;
  const Route climb{{0, 0, 100}, {500, 0, 100}, {1000, 0, 600}};
  request.goal.position = climb.back();
  request.limits.max_turn_space = radians(44);
  EXPECT_EQ(rules(check(climb, request)), "turn_angle@1 ");
  request.limits.max_turn_space = kPi;
  request.limits.max_climb = radians(44.9);
  EXPECT_EQ(rules(check(climb, request)), "climb_angle@1 ");
}

TEST(Check, ReversingIsATurnOfHalfACircle) {
  Request request = empty_request();
  request.limits.max_turn_horizontal = radians(179);
  EXPECT_EQ(rules(check({{0, 0, 100}, {2000, 0, 100}, {1000, 0, 100}}, request)), "turn_angle@1 ");
}

TEST(Check, ARepeatedPointHidesNoTurn) {
  Request request = empty_request();
  request.limits.max_turn_horizontal = radians(55);
  request.limits.max_turn_space = radians(55);
  const Route bend{{0, 0, 100}, {2000, 0, 100}, {2000, 0, 100}, {1000, 0, 100}};
  EXPECT_EQ(rules(check(bend, request)), "turn_angle@2 turn_angle@2 ");
}

TEST(Check, AVerticalLegHasNoHeadingFromAnySide) {
  Request request = empty_request();
  request.limits.max_turn_horizontal = radians(10);
  for (const double x : {-1.0, 1e-15, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      const Vec3 level(x, y, 0);
      EXPECT_EQ(turn_angle_horizontal(level, {0, 0, 1}), 0) << x << ' ' << y;
      EXPECT_EQ(turn_angle_horizontal({0, 0, -1}, level), 0) << x << ' ' << y;
      EXPECT_EQ(turn_angle_in_space(level, {0, 0, 0}), 0) << x << ' ' << y;
    }
  }
  // The rounding of coordinates is no heading either.
  request.start.position = {-1000, 0, 100};
  request.goal.position = {0, 0, 200};
  const double nearly = std::nextafter(-1000.0, 0.0);
  EXPECT_EQ(rules(check({{-1000, 0, 100}, {nearly, 1e-12, 200}, {0, 0, 200}}, request)), "");
}

TEST(Check, TheHeadingAtTheStartHoldsTheFirstLeg) {
  Request request = empty_request();
  request.limits.max_turn_horizontal = radians(60);
  request.start.velocity = {0, 20, 0};
  EXPECT_EQ(rules(check({{0, 0, 100}, {1000, 0, 100}}, request)), "turn_angle@0 ");
  request.start.velocity = {20, 20, 0};
  EXPECT_EQ(rules(check({{0, 0, 100}, {1000, 0, 100}}, request)), "");
}

TEST(Check, LegsRadiusAndLength) {
  Request request = empty_request();
  request.limits.min_leg = 600;
  const Route bend{{0, 0, 100}, {500, 500, 100}, {1000, 0, 100}};
  EXPECT_EQ(rules(check(bend, request)), "");
  request.limits.min_leg = 800;
  EXPECT_EQ(rules(check(bend, request)), "leg_length@0 leg_length@1 ");
  request.limits.min_leg = 0;
  // A right angle: the fillet of half of a leg is half of it.
  request.limits.min_turn_radius = 250 * std::sqrt(2);
  EXPECT_EQ(rules(check(bend, request)), "");
  request.limits.min_turn_radius += 0.001;
  EXPECT_EQ(rules(check(bend, request)), "turn_radius@1 ");
  request.limits.min_turn_radius = 0;
  request.limits.max_route_length = length(bend);
  EXPECT_EQ(rules(check(bend, request)), "");
  request.limits.max_route_length = length(bend) - 0.001;
  EXPECT_EQ(rules(check(bend, request)), "route_length@0 ");
}

TEST(Check, AltitudeOverTheSea) {
  Request request = empty_request();
  request.limits.altitude.push_back({AltitudeBand::Datum::sea, 50, 150});
  EXPECT_EQ(rules(check({{0, 0, 100}, {500, 0, 150}, {1000, 0, 100}}, request)), "");
  EXPECT_EQ(rules(check({{0, 0, 100}, {500, 0, 151}, {1000, 0, 100}}, request)),
            "altitude@0 altitude@1 ");
  EXPECT_EQ(rules(check({{0, 0, 100}, {500, 0, 49}, {1000, 0, 100}}, request)),
            "altitude@0 altitude@1 ");
}

TEST(Check, AWallOfACentimetreAnywhereIsFound) {
  for (const double x : {0.005, 123.4567, 500.0, 999.99}) {
    const World world = world_of({BoxShape{{{x, -50, 0}, {x + 0.01, 50, 200}}}});
    const Request request = request_in(world, {-10, 0, 100}, {1010, 0, 100}, kVolume);
    EXPECT_EQ(rules(check({{-10, 0, 100}, {1010, 0, 100}}, request)), "clearance@0 ") << x;
  }
}

TEST(Check, ASpikeOfACentimetreIsFound) {
  const World world = world_of({Cylinder{321, 0, 0.005, 0, 100.01}});
  const Request request = request_in(world, {0, 0, 100}, {1000, 0, 100}, kVolume);
  EXPECT_EQ(rules(check({{0, 0, 100}, {1000, 0, 100}}, request)), "clearance@0 ");
}

TEST(Check, TouchingIsFreeForEveryShape) {
  // The leg runs along y = 0 at z = 100; every shape touches it, for a vehicle of 10 m and of none.
  for (const double r : {0.0, 10.0}) {
    const std::vector<Shape> touching{Sphere{{500, 50 + r, 100}, 50},
                                      Cylinder{500, 50 + r, 50, 0, 200},
                                      Cylinder{500, 0, 50, 0, 100 - r},
                                      BoxShape{{{400, r, 0}, {600, 60, 200}}},
                                      BoxShape{{{400, -50, 100 + r}, {600, 50, 200}}},
                                      Prism{{{400, r}, {600, r}, {500, 100}}, {}, 0, 200},
                                      Prism{{{400, -50}, {600, -50}, {500, 100}}, {}, 0, 100 - r}};
    for (const Shape& shape : touching) {
      Request request = request_in(world_of({shape}), {0, 0, 100}, {1000, 0, 100}, kVolume);
      request.vehicle.radius_m = r;
      EXPECT_EQ(rules(check({{0, 0, 100}, {1000, 0, 100}}, request)), "") << shape.index();
      // A tenth of a millimetre nearer is not.
      const Vec3 nearer = Vec3(0, -1e-4, shape.index() == 1 || shape.index() == 3 ? 1e-4 : 0);
      Vec3 by = nearer;
      if (bounds(shape).min.z() >= 100) {
        by = {0, 0, -1e-4};
      } else if (bounds(shape).max.z() <= 100) {
        by = {0, 0, 1e-4};
      }
      Request hit = request_in(world_of({moved(shape, by)}), {0, 0, 100}, {1000, 0, 100}, kVolume);
      hit.vehicle.radius_m = r;
      EXPECT_EQ(rules(check({{0, 0, 100}, {1000, 0, 100}}, hit)), "clearance@0 ")
          << shape.index() << " r " << r;
    }
  }
}

TEST(Check, LegOkAgreesWithTheViolations) {
  RandomStream random(5);
  std::vector<Shape> shapes;
  for (int i = 0; i < 20; ++i) {
    shapes.emplace_back(Sphere{random.in({{0, -500, 0}, {1000, 500, 200}}), random.uniform(5, 80)});
  }
  Request request = request_in(world_of(shapes), {0, 0, 100}, {1000, 0, 100}, kVolume);
  request.limits.max_climb = radians(20);
  request.limits.max_turn_horizontal = radians(50);
  int sound = 0;
  for (int i = 0; i < 2000; ++i) {
    const Box box{{0, -500, 0}, {1000, 500, 200}};
    const Vec3 a = random.in(box);
    const Vec3 b = random.in(box);
    const Vec3 c = random.in(box);
    const bool ok = leg_ok(a, b, c, request);
    EXPECT_EQ(ok, leg_violations(a, b, c, request, 0).empty());
    sound += ok ? 1 : 0;
  }
  EXPECT_GT(sound, 50);
  EXPECT_LT(sound, 1950);
}

TEST(Check, NumbersBeyondAnyWorldAreToldShortly) {
  Request request = empty_request();
  const CheckResult result = check({{0, 0, 100}, {1e300, 0, 100}}, request);
  ASSERT_FALSE(result.ok());
  for (const Violation& violation : result.violations) {
    EXPECT_LT(violation.message.size(), 120u) << violation.message;
  }
}

/// The violations of a route whose one leg is that turn.
std::string rules_of_turn(const Leg& turn) {
  Request request = empty_request();
  request.goal.position = turn.to;
  Route route;
  route.push_back(turn);
  return rules(check(route, request));
}

TEST(Check, ATurnEndsWhereItsCircleLeads) {
  const Leg turn = Leg::turning({{0, 0, 100}, 0}, kPi / 2, 80, 5);
  EXPECT_EQ(rules_of_turn(turn), "");
  for (const double off : {1e-3, 500.0}) {
    Leg longer = turn;
    longer.to.x() += off;
    EXPECT_EQ(rules_of_turn(longer), "route@0 ") << off;
  }
  Leg other = turn;
  other.heading = std::nan("");
  EXPECT_EQ(rules_of_turn(other), "route@0 ");
}

TEST(Check, ALegBeginsWhereTheOneBeforeEnds) {
  Request request = empty_request();
  Route route{{0, 0, 100}, {400, 0, 100}};
  const Leg turn = Leg::turning({{600, 0, 100}, 0}, kPi / 2, 80, 0);
  route.push_back(turn);
  request.goal.position = turn.to;
  const CheckResult result = check(route, request);
  EXPECT_EQ(rules(result), "route@1 ");
  EXPECT_EQ(result.violations.at(0).message,
            "the leg begins 200.000000 m from the end of the one before");
}

TEST(Check, PointProblemsNameTheFigure) {
  Request request =
      request_in(world_of({Sphere{{0, 0, 100}, 50}}), {0, 0, 100}, {500, 0, 100}, kVolume);
  EXPECT_EQ(point_problem({0, 0, 100}, request),
            "(0.00, 0.00, 100.00) cannot be flown: lies up to 50.00 m inside what 'shapes' blocks, "
            "where 0.00 m of clearance are needed");
  EXPECT_EQ(point_problem({0, 60, 100}, request), "");
  request.vehicle.radius_m = 20;
  EXPECT_EQ(point_problem({0, 60, 100}, request),
            "(0.00, 60.00, 100.00) cannot be flown: comes to 10.00 m of 'shapes', where 20.00 m of "
            "clearance are needed");
}

TEST(Measures, OfARouteByHand) {
  const Route route{{0, 0, 0}, {300, 400, 0}, {300, 900, 0}, {300, 900, 100}};
  Request request =
      request_in(world_of({Sphere{{300, 1000, 50}, 20}}), route.front(), route.back(), kVolume);
  request.vehicle.speed_mps = 10;
  const Measures m = measure(route, request);
  EXPECT_EQ(m.length_m, 1100);
  EXPECT_EQ(m.waypoints, 4u);
  EXPECT_NEAR(*m.max_turn_deg, degrees(std::atan2(3, 4)), 1e-9);
  EXPECT_NEAR(*m.max_climb_deg, 90, 1e-9);
  EXPECT_NEAR(*m.min_clearance_m, 80, 1e-5);
  EXPECT_FALSE(m.min_ground_clearance_m);
  EXPECT_NEAR(*m.duration_s, 110, 1e-9);
  EXPECT_NEAR(*m.smoothness_rad, std::atan2(3, 4) + kPi / 2, 1e-9);
}

TEST(Measures, TheSpeedLawSlowsNearAnObstacle) {
  Request request = request_in(world_of({Cylinder{500, 0, 50, 0, 200}}), {0, 200, 100},
                               {1000, 200, 100}, kVolume);
  request.vehicle.speed_mps = 20;
  request.vehicle.speed_near = {{200, 10}};
  // Within 200 m of the edge: within 250 m of the axis, a chord of 2 sqrt(250^2 - 200^2) = 300 m.
  EXPECT_NEAR(*measure({{0, 200, 100}, {1000, 200, 100}}, request).duration_s,
              300.0 / 10 + 700.0 / 20, 0.2);
}
}  // namespace
}  // namespace altiplan::check_test
