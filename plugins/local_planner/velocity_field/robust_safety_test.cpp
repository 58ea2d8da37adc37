// SPDX-License-Identifier: Apache-2.0
// The parts of the guarantee separately: exact legs, circles flown forever, escape paths.
#include "robust_safety.hpp"

#include <gtest/gtest.h>

#include "robust_flight.hpp"
#include "robust_test_maps.hpp"

namespace velocity_field::robust_safety_test {
namespace {

const Steps kSteps(30, 500, kPi);

Vec2 direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

TEST(Steps, LongOnesTurnByARightAngle) {
  const Steps steps(300, 50, kPi);
  EXPECT_NEAR(steps.radius_m(), 300 / std::sqrt(2), 1e-9);
  const Pose pose = {{0, 0}, {1, 0}};
  const Vec2 centre = steps.circle_centre(pose, -1);
  Pose around = pose;
  for (int n = 0; n < 4; ++n) {
    EXPECT_NEAR((around.at - centre).norm(), steps.radius_m(), 1e-9);
    around = steps.turned(around, -1);
  }
  EXPECT_LT((around.at - pose.at).norm(), 1e-9);
}

TEST(Steps, TightestTurnStaysOnItsCircle) {
  for (const int side : {1, -1}) {
    Pose pose = {{1000, -400}, direction(0.3)};
    const Vec2 centre = kSteps.circle_centre(pose, side);
    EXPECT_NEAR((centre - pose.at).norm(), 500, 1e-9);
    for (int n = 0; n < 100'000; ++n) {
      const Pose next = kSteps.turned(pose, side);
      EXPECT_NEAR((next.at - pose.at).norm(), 30, 1e-9);
      pose = next;
    }
    EXPECT_NEAR((pose.at - centre).norm(), 500, 1e-4) << "what the kept room must hold";
    EXPECT_LT((kSteps.circle_centre(pose, side) - centre).norm(), 1e-4);
  }
}

TEST(Steps, OfALimitedTurnGoAroundOnALargerCircle) {
  const Steps gentle(30, 500, 0.01);
  EXPECT_NEAR(gentle.radius_m(), 30 / (2 * std::sin(0.005)), 1e-9);
}

TEST(Freedom, JudgesLegsAndCirclesExactly) {
  oracle::Draw draw(5);
  int free_legs = 0;
  int free_circles = 0;
  for (int n = 0; n < 4000; ++n) {
    std::vector<Disc> discs;
    for (int k = 0; k < 4; ++k) {
      discs.push_back({{draw(-2500, 2500), draw(-2500, 2500)}, draw(10, 1200)});
    }
    const Threats threats(discs, Freedom::reach_m(kSteps));
    const Freedom freedom(threats, kSteps);
    const Pose pose = {{0, 0}, direction(draw(0, 2 * kPi))};
    const Vec2 to = pose.at + 30 * pose.course;
    EXPECT_EQ(freedom.is_leg_free(pose.at, to), !enters_one(discs, pose.at, to)) << n;
    free_legs += freedom.is_leg_free(pose.at, to);
    const int side = n % 2 == 0 ? 1 : -1;
    if (freedom.is_circle_free(pose, side)) {
      ++free_circles;
      Pose around = pose;
      for (int k = 0; k < 220; ++k) {
        const Pose next = kSteps.turned(around, side);
        ASSERT_FALSE(enters_one(discs, around.at, next.at)) << n;
        around = next;
      }
    } else {
      // The rejection is justified: a threat is nearer to the circle's inside than the distance
      // kept.
      const Vec2 centre = kSteps.circle_centre(pose, side);
      EXPECT_TRUE(std::any_of(discs.begin(), discs.end(), [&](const Disc& disc) {
        return (disc.centre - centre).norm() < disc.radius + 500 + 0.002;
      })) << n;
    }
  }
  EXPECT_GT(free_legs, 1000);
  EXPECT_GT(free_circles, 500);
}

/// From any position and in any course: if an escape path is reported, the vehicle that only
/// follows it enters no threat, also while it continues on its circle.
TEST(WayOut, EntersNoThreat) {
  oracle::Draw draw(6);
  int with_steps = 0;
  int unsafe = 0;
  for (int n = 0; n < 1000; ++n) {
    std::vector<Disc> discs;
    for (int k = 0; k < 40; ++k) {
      discs.push_back({{draw(-9000, 9000), draw(-9000, 9000)}, draw(500, 2500)});
    }
    const Vec2 goal(draw(-9000, 9000), draw(-9000, 9000));
    Pose pose = {{draw(-9000, 9000), draw(-9000, 9000)}, direction(draw(0, 2 * kPi))};
    if (is_inside_one(discs, pose.at) || is_inside_one(discs, goal)) {
      continue;
    }
    const Threats threats(discs, Freedom::reach_m(kSteps));
    RobustFlight flight(Field(), threats, kSteps);
    flight.set_world(goal, 15, pose.at, pose.course);
    if (!flight.is_safe()) {
      ++unsafe;
      continue;
    }
    WayOut out = flight.way_out();
    EXPECT_TRUE(out.is_free(Freedom(threats, kSteps), pose));
    with_steps += !out.courses.empty();
    for (int k = 0; !out.courses.empty() || (out.circle != 0 && k < 250); ++k) {
      Pose next = kSteps.turned(pose, out.circle);
      if (!out.courses.empty()) {
        next = kSteps.after(pose.at, out.courses.back());
        out.courses.pop_back();
        const double turn = std::acos(std::min(1.0, next.course.dot(pose.course)));
        ASSERT_LE(turn, max_turn(30, 500) + 1e-7) << n;
      }
      ASSERT_FALSE(enters_one(discs, pose.at, next.at)) << n;
      pose = next;
    }
  }
  EXPECT_GT(with_steps, 20);
  EXPECT_GT(unsafe, 5);
}
}  // namespace
}  // namespace velocity_field::robust_safety_test
