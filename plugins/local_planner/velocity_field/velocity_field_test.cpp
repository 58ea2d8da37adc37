// SPDX-License-Identifier: Apache-2.0
// The published figures of paper 001, and the properties of its field.
#include <gtest/gtest.h>

#include "field.hpp"
#include "reference/velocity_flights.hpp"
#include "virtual_targets.hpp"

namespace velocity_field::velocity_field_test {
namespace {

TEST(Field, PushAtTheNamedPlaces) {
  const Field field;
  EXPECT_NEAR(field.length(), 141.776, 5e-4);
  for (const double r : {1013.0, 4399.0, 8925.0}) {
    EXPECT_NEAR(field.push(r, r), 10, 1e-12);
    EXPECT_NEAR(field.push(r * (1 - 1e-12), r), 10, 1e-9) << "continuous at the edge";
    EXPECT_NEAR(field.push(r + field.balance(), r), 1, 1e-12) << "at L2";
    EXPECT_NEAR(field.push(r + field.ring, r), 0.05, 1e-12);
    EXPECT_NEAR(field.push(r / 2, r), 40, 1e-9);
  }
}

TEST(Field, ActsInTheRingAndNotBeyond) {
  const Field field;
  const Disc threat{{1000, 0}, 500};
  const Vec2 target(-9000, 3000);
  EXPECT_EQ(field.of_threat({-1500.001, 0}, threat, target), Vec2(0, 0));
  EXPECT_NEAR(field.of_threat({-1500, 0}, threat, target).norm(), 0.05 * std::sqrt(2), 1e-12);
}

TEST(Field, GuidesTowardTheTarget) {
  const Field field;
  const Disc threat{{0, 0}, 500};
  for (int degree = 0; degree < 360; degree += 7) {
    const Vec2 to_target(std::cos(radians(degree)), std::sin(radians(degree)));
    const Vec2 sum = field.of_threat({600, 0}, threat, to_target);
    EXPECT_NEAR(sum.x(), std::abs(sum.y()), 1e-12) << "away and beside alike";
    EXPECT_GE(sum.y() * to_target.y(), -1e-12) << degree;
  }
  EXPECT_GT(field.of_threat({600, 0}, threat, {-1, 0}).y(), 0) << "an exact tie turns by +90";
}

TEST(TurnLimit, TurnsByTheLimitExactlyOrNotAtAll) {
  const double maximum = max_turn(30, 500);
  EXPECT_NEAR(2 * 500 * std::sin(maximum / 2), 30, 1e-12);
  EXPECT_EQ(max_turn(1000, 500), kPi);
  EXPECT_EQ(max_turn(1001, 500), kPi);
  const TurnLimit limit(maximum);
  for (int degree = -179; degree < 180; ++degree) {
    const Vec2 heading(std::cos(0.7), std::sin(0.7));
    const Vec2 wish(std::cos(0.7 + radians(degree)), std::sin(0.7 + radians(degree)));
    const Vec2 held = limit.held(heading, wish);
    const double turned = std::atan2(cross(heading, held), heading.dot(held));
    EXPECT_NEAR(turned, std::clamp(radians(degree), -maximum, maximum), 1e-12) << degree;
    EXPECT_NEAR(held.norm(), 1, 1e-15);
  }
}

TEST(VirtualTargets, PlacesOfThePage) {
  const VirtualTargets targets(Field().balance(), 100);
  const auto place = [&](std::size_t number) {
    const Cylinder& threat = kTable1[number - 1];
    return targets.place({{threat.x, threat.y}, threat.radius}, {50000, 50000});
  };
  EXPECT_LT((place(2) - Vec2(3860, 14036)).cwiseAbs().maxCoeff(), 1);
  EXPECT_LT((place(9) - Vec2(28612, 4309)).cwiseAbs().maxCoeff(), 1);
}

TEST(VirtualTargets, WedgeAndChord) {
  const Vec2 target(0, 0);
  const Vec2 a(10, 5);
  const Vec2 b(10, -5);
  EXPECT_TRUE(is_in_wedge({5, 0}, target, a, b));
  EXPECT_TRUE(is_in_wedge({50, 24}, target, b, a));
  EXPECT_FALSE(is_in_wedge({50, 26}, target, a, b));
  EXPECT_FALSE(is_in_wedge({-5, 0}, target, a, b));
  EXPECT_TRUE(is_beyond_chord({10.1, 0}, target, a, b));
  EXPECT_TRUE(is_beyond_chord({10.1, 0}, target, b, a));
  EXPECT_FALSE(is_beyond_chord({9.9, 0}, target, a, b));
}

TEST(PaperTable, Waypoints) {
  const Flown flown = flight(table1());
  ASSERT_EQ(flown.outcome, PilotStep::Outcome::arrived);
  EXPECT_NEAR(double(flown.route.size()), 4041, 3);
  EXPECT_GE(length(flown.route), 121.1e3);
  EXPECT_LE(length(flown.route), 121.3e3);
}

TEST(PaperTable, SegmentsAndRadius) {
  const Flown flown = flight(table1());
  EXPECT_LE(uneven(flown.route, 30), 1e-6);
  EXPECT_GE(min_radius(flown.route), 500 - 1e-6);
  EXPECT_LT(min_radius(flown.route), 501) << "the limit is met, not only kept";
  EXPECT_GT(flown.counter("turn_limit_steps"), 0);
}

TEST(PaperTable, VirtualTargetsAndTrapEntries) {
  const Flown flown = flight(table1());
  EXPECT_EQ(flown.counter("potential_virtual_targets"), 10);
  EXPECT_EQ(flown.counter("trap_entries"), 5);
  EXPECT_EQ(flown.counter("virtual_targets_used"), 5);
  EXPECT_EQ(flown.counter("virtual_targets_inside_threats"), 0);
  std::vector<std::string> entered;
  for (const std::string& why : flown.why) {
    const std::size_t at = why.find("of threat ");
    if (at != std::string::npos) {
      entered.push_back(why.substr(at + 10));
    }
  }
  EXPECT_EQ(entered, (std::vector<std::string>{"2", "12", "10", "4", "3"}));
}

TEST(PaperTable, NineOverlappingPairs) {
  std::vector<Disc> discs;
  for (const Cylinder& threat : kTable1) {
    discs.push_back({{threat.x, threat.y}, threat.radius});
  }
  const Threats threats(discs, 2000);
  int pairs = 0;
  for (std::uint32_t i = 0; i < discs.size(); ++i) {
    for (std::uint32_t j = 0; j < i; ++j) {
      pairs += threats.overlap(i, j);
    }
  }
  EXPECT_EQ(pairs, 9);
}

TEST(PaperTable, ClearanceAndJudge) {
  const Request request = table1();
  const Flown flown = flight(request);
  EXPECT_TRUE(check(flown.route, request).ok());
  double minimum = kInfinity;
  for (std::size_t i = 1; i < flown.route.size(); ++i) {
    for (const Cylinder& threat : kTable1) {
      minimum = std::min(minimum, leg_distance(threat, flown.route[i - 1], flown.route[i]));
    }
  }
  EXPECT_NEAR(minimum, 427, 2);
}

TEST(PaperTable, FewPointsStay) {
  const Request request = table1();
  const Route raw = flight(request).route;
  const PlanResult reduced =
      altiplan::testing::make_smoother("waypoint_reduction")->smooth(raw, request);
  EXPECT_EQ(reduced.status, PlanStatus::solved);
  EXPECT_EQ(reduced.route.size(), 4U);
  EXPECT_GE(length(reduced.route), 103.3e3);
  EXPECT_LE(length(reduced.route), 103.5e3);
  EXPECT_TRUE(check(reduced.route, request).ok());
  for (std::size_t i = 2; i < reduced.route.size(); ++i) {
    EXPECT_LE(turn_angle_in_space(reduced.route[i - 1] - reduced.route[i - 2],
                                  reduced.route[i] - reduced.route[i - 1]),
              kPi / 2 + 1e-9);
  }
}
}  // namespace
}  // namespace velocity_field::velocity_field_test
