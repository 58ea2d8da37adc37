// SPDX-License-Identifier: Apache-2.0
#include "altiplan/leg.hpp"

#include <gtest/gtest.h>

#include "altiplan/leg_limits.hpp"
#include "altiplan/random.hpp"
#include "altiplan/route.hpp"
#include "altiplan/vehicle.hpp"
#include "altiplan/wind.hpp"

namespace altiplan::leg_test {
namespace {

constexpr double kQuarter = kPi / 2;

Leg random_turn(RandomStream& random) {
  const Pose from{random.in({{-1e4, -1e4, 0}, {1e4, 1e4, 2000}}), random.uniform(-kPi, kPi)};
  const double turn = random.uniform(-4 * kPi, 4 * kPi);
  const double radius = random.uniform(1, 500);
  const Vec3 drift(random.uniform(-0.8, 0.8) * radius * std::abs(turn) / 2,
                   random.uniform(-0.8, 0.8) * radius * std::abs(turn) / 2, 0);
  return Leg::turning(from, turn, radius, random.uniform(-100, 100),
                      random.integer(0, 1) == 0 ? Vec3(0, 0, 0) : drift);
}

TEST(Leg, ALeftTurnFromEastLeadsNorth) {
  const Leg leg = Leg::turning({{100, 200, 50}, 0}, kQuarter, 80, 12);
  EXPECT_EQ(leg.kind(), Leg::Kind::arc);
  EXPECT_LT((leg.to - Vec3(180, 280, 62)).norm(), 1e-12);
  EXPECT_LT(
      (leg.at(0.5) - Vec3(100 + 80 * std::sin(kPi / 4), 280 - 80 * std::cos(kPi / 4), 56)).norm(),
      1e-12);
  EXPECT_NEAR(leg.length(), std::hypot(80 * kQuarter, 12), 1e-12);
  EXPECT_LT(leg.rate(1).normalized().head<2>().x(), 1e-12);
  const Leg right = Leg::turning({{100, 200, 50}, 0}, -kQuarter, 80, 0);
  EXPECT_LT((right.to - Vec3(180, 120, 50)).norm(), 1e-12);
}

TEST(Leg, AWellFormedLegIsFiniteAndItsTurnHasARadius) {
  EXPECT_TRUE(is_well_formed(Leg::straight({0, 0, 0}, {1, 2, 3})));
  EXPECT_FALSE(is_well_formed(Leg::straight({0, 0, 0}, {1, kInfinity, 3})));
  const Leg turn = Leg::turning({{0, 0, 0}, 0}, -200 * kPi, 80, 12);
  EXPECT_TRUE(is_well_formed(turn));
  const auto with = [&](auto member, double value) {
    Leg leg = turn;
    leg.*member = value;
    return is_well_formed(leg);
  };
  for (const double bad : {std::nan(""), kInfinity, -kInfinity}) {
    EXPECT_FALSE(with(&Leg::turn, bad) || with(&Leg::radius, bad) || with(&Leg::heading, bad));
  }
  EXPECT_FALSE(with(&Leg::turn, 201 * kPi) || with(&Leg::radius, 0) || with(&Leg::radius, 2e8));
  Leg drifting = turn;
  drifting.drift.x() = kInfinity;
  EXPECT_FALSE(is_well_formed(drifting));
}

TEST(Leg, AWholeHelixEndsAboveItsStart) {
  const Leg helix = Leg::turning({{0, 0, 100}, 1}, 6 * kPi, 60, 90);
  EXPECT_LT((helix.to - Vec3(0, 0, 190)).norm(), 1e-9);
  EXPECT_NEAR(helix.length(), std::hypot(60 * 6 * kPi, 90), 1e-9);
  const Box box = helix.box();
  EXPECT_NEAR((box.max - box.min).x(), 120, 1e-9);
  EXPECT_NEAR((box.max - box.min).y(), 120, 1e-9);
}

TEST(Leg, RandomTurnsAgreeWithFinePolylines) {
  RandomStream random(7);
  for (int n = 0; n < 300; ++n) {
    const Leg leg = random_turn(random);
    constexpr int kSteps = 20000;
    double length = 0;
    Box box = Box::empty();
    for (int i = 0; i < kSteps; ++i) {
      const Vec3 here = leg.at(double(i) / kSteps);
      const Vec3 next = leg.at(double(i + 1) / kSteps);
      length += (next - here).norm();
      box = box.with(here).with(next);
      const Vec3 rate = leg.rate((i + 0.5) / kSteps) / kSteps;
      ASSERT_LT((next - here - rate).norm(), 1e-3 * rate.norm() + 1e-9) << n;
    }
    EXPECT_NEAR(leg.length(), length, 1e-6 * length) << n;
    EXPECT_LT((leg.box().min - box.min).norm(), 1e-3) << n;
    EXPECT_LT((leg.box().max - box.max).norm(), 1e-3) << n;
    EXPECT_TRUE(leg.box().contains(box.min, 1e-9) && leg.box().contains(box.max, 1e-9)) << n;
  }
}

TEST(Leg, ChordsAndPiecesStayWithinTheSagitta) {
  RandomStream random(8);
  for (int n = 0; n < 500; ++n) {
    const Leg leg = random_turn(random);
    const double begin = random.uniform(0, 1);
    const double end = random.uniform(begin, 1);
    const Leg piece = leg.piece(begin, end);
    for (const double t : {0.0, 0.2, 0.5, 0.9, 1.0}) {
      const Vec3 p = piece.at(t);
      ASSERT_LT((p - leg.at(begin + t * (end - begin))).norm(), 1e-7) << n;
      ASSERT_LE((p - (piece.from + t * (piece.to - piece.from))).norm(), piece.sagitta() + 1e-7);
    }
    const Polyline points = leg.chords(0.5);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const Vec3 middle = leg.at((double(i) + 0.5) / double(points.size() - 1));
      ASSERT_LE(point_leg_distance(middle, points[i], points[i + 1]), 0.5 + 1e-9) << n;
    }
    const Leg back = leg.reversed();
    for (const double t : {0.0, 0.3, 1.0}) {
      ASSERT_LT((back.at(t) - leg.at(1 - t)).norm(), 1e-7) << n;
      ASSERT_LT((back.rate(t) + leg.rate(1 - t)).norm(), 1e-7 * leg.length()) << n;
    }
  }
}

TEST(Route, TurnsMakeARouteThatIsNotStraight) {
  Route route{{0, 0, 0}, {100, 0, 0}};
  EXPECT_TRUE(route.is_straight());
  const Leg turn = Leg::turning({{100, 0, 0}, 0}, kQuarter, 50, 0);
  route.push_back(turn);
  route.push_back(Vec3(150, 500, 0));
  EXPECT_FALSE(route.is_straight());
  ASSERT_EQ(route.leg_count(), 3u);
  EXPECT_EQ(route.leg(0), Leg::straight({0, 0, 0}, {100, 0, 0}));
  EXPECT_EQ(route.leg(1), turn);
  EXPECT_NEAR(length(route), 100 + 50 * kQuarter + (route.back() - turn.to).norm(), 1e-9);
  EXPECT_EQ(route.part(1, 2).leg(0), turn);
  Route twice = route.part(0, 1);
  twice.append(route.part(1, 3));
  EXPECT_EQ(twice, route);
  EXPECT_EQ(route.chords(100), route.waypoints());
  route.edit().pop_back();
  EXPECT_TRUE(route.is_straight());
}

TEST(Wing, RadiusOfACoordinatedTurn) {
  EXPECT_NEAR((Wing{20, radians(45), 0, 0}).turn_radius(), 400 / 9.80665, 1e-9);
}

TEST(Wind, GroundSpeedIsThatOfTheWindTriangle) {
  EXPECT_NEAR(*ground_speed({1, 0, 0}, 20, {5, 0, 0}), 25, 1e-12);
  EXPECT_NEAR(*ground_speed({-1, 0, 0}, 20, {5, 0, 0}), 15, 1e-12);
  EXPECT_NEAR(*ground_speed({0, 3, 0}, 20, {12, 0, 0}), 16, 1e-12);
  EXPECT_FALSE(ground_speed({0, 1, 0}, 20, {21, 0, 0}));
  EXPECT_FALSE(ground_speed({-1, 0, 0}, 20, {20, 0, 0}));
  const Wind wind{{{0, {5, 0, 0}}, {100, {10, 0, 0}}}};
  EXPECT_NEAR(flight_time({0, 0, 50}, {1000, 0, 150}, 20, wind), 500 / 25.0 + 500 / 30.0, 1e-9);
  EXPECT_EQ(wind.at({0, 0, -1}), Vec3(0, 0, 0));
}
}  // namespace
}  // namespace altiplan::leg_test
