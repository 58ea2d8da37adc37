// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/dubins/wind.hpp"

#include <gtest/gtest.h>

#include "framework/dubins_oracle.hpp"

namespace altiplan::kit::dubins_wind_test {
namespace {

namespace oracle = dubins_oracle;
using oracle::random_pose;

constexpr double kRadius = 60;
constexpr double kAirspeed = 20;

Air random_air(RandomStream& random, double share) {
  const double direction = random.uniform(-kPi, kPi);
  return {kAirspeed, share * kAirspeed * unit_heading(direction)};
}

/// The least time at which a word, perhaps with whole circles more, is as long as what has been
/// flown by then, to the goal where the wind has it then: by small steps, then bisection.
class Scan {
 public:
  Scan(const Pose& from, const Pose& to, const Air& air)
      : from_(oracle::place(from)), to_(oracle::place(to)), air_(air) {}

  double first_time(double until) const {
    const double step = kRadius / kAirspeed / 64;
    Circles before = circles(0);
    for (double time = 0; time < until + step; time += step) {
      const Circles after = circles(time + step);
      double first = kInfinity;
      for (std::size_t w = 0; w < before.size(); ++w) {
        first = std::min(first, within_step(time, before[w], time + step, after[w], w));
      }
      if (first < kInfinity) {
        return first;
      }
      before = after;
    }
    return kInfinity;
  }

 private:
  /// By word: how many circles it lacks to what has been flown. Of three turns, the middle one may
  /// be any.
  using Circles = std::array<double, 8>;

  Circles circles(double time) const {
    oracle::Place goal = to_;
    goal.at -= time * oracle::Point(air_.wind.x(), air_.wind.y());
    const std::array<double, 6> lengths = oracle::lengths(from_, goal, kRadius);
    Circles all{};
    std::copy(lengths.begin(), lengths.end(), all.begin());
    all[6] = oracle::with_turns(from_, goal, kRadius, 1, false).length;
    all[7] = oracle::with_turns(from_, goal, kRadius, -1, false).length;
    for (double& length : all) {
      length = (kAirspeed * time - length) / (2 * kPi * kRadius);
    }
    return all;
  }
  double within_step(double low, double at_low, double high, double at_high,
                     std::size_t word) const {
    if (std::isinf(at_low) && std::isinf(at_high)) {
      return kInfinity;
    }
    if (std::isinf(at_low)) {
      low = edge(low, high, word);
      at_low = circles(low)[word];
    } else if (std::isinf(at_high)) {
      high = edge(high, low, word);
      at_high = circles(high)[word];
    }
    const double whole = std::floor(std::max(at_low, at_high));
    if (whole < 0 || std::min(at_low, at_high) >= whole || std::abs(at_high - at_low) > 0.5) {
      return kInfinity;
    }
    return at_low < at_high ? refined(low, high, word, whole) : refined(high, low, word, whole);
  }
  /// Where the word begins or ends, which there is at `inside` only.
  double edge(double outside, double inside, std::size_t word) const {
    for (int n = 0; n < 50; ++n) {
      const double middle = (outside + inside) / 2;
      (std::isinf(circles(middle)[word]) ? outside : inside) = middle;
    }
    return inside;
  }
  double refined(double below, double above, std::size_t word, double whole) const {
    for (int n = 0; n < 60; ++n) {
      const double middle = (below + above) / 2;
      (circles(middle)[word] < whole ? below : above) = middle;
    }
    return above;
  }

  oracle::Place from_;
  oracle::Place to_;
  Air air_;
};

/// The legs join, and are flown at the airspeed in the wind, without kinks through the air.
void expect_flyable(const WindPath& path, const Pose& from, const Pose& to) {
  const double seconds = path.seconds();
  const double slack = 1e-9 * (kRadius + kAirspeed * seconds);
  Vec3 at = from.position;
  double heading = from.heading;
  double time = 0;
  for (const Leg& leg : path.legs(from, to.position)) {
    EXPECT_EQ(leg.from, at);
    const double height = leg.to.z() - leg.from.z();
    double duration = 0;
    if (leg.turns()) {
      EXPECT_NEAR(std::remainder(leg.heading - heading, 2 * kPi), 0, 1e-9);
      duration = leg.radius * std::abs(leg.turn) / kAirspeed;
      EXPECT_LT((leg.drift - duration * path.air.wind).norm(), slack);
      const Leg again = Leg::turning({at, heading}, leg.turn, leg.radius, height, leg.drift);
      EXPECT_LT((again.to - leg.to).norm(), slack);
      heading += leg.turn;
    } else {
      const Vec3 over_ground = kAirspeed * unit_heading(heading) + path.air.wind;
      duration = (leg.to - leg.from).head<2>().norm() / over_ground.norm();
      EXPECT_LT((leg.to - leg.from - duration * over_ground).head<2>().norm(), slack);
    }
    EXPECT_NEAR(height * seconds, (to.position - from.position).z() * duration, slack * seconds);
    time += duration;
    at = leg.to;
  }
  EXPECT_EQ(at, to.position);
  EXPECT_NEAR(std::remainder(heading - to.heading, 2 * kPi), 0, 1e-9);
  EXPECT_NEAR(time, seconds, 1e-9 * (1 + seconds));
}

void compare(std::uint64_t seed, int pairs, double within) {
  RandomStream random(seed);
  int missed = 0;
  for (int n = 0; n < pairs && !::testing::Test::HasFailure(); ++n) {
    SCOPED_TRACE(::testing::Message() << "pair " << n << " within " << within);
    const Pose from = random_pose(random, within * kRadius);
    const Pose to = random_pose(random, within * kRadius);
    const Air air = random_air(random, random.uniform(0, 0.95));
    const auto path = wind_path(from, to, kRadius, air);
    ASSERT_TRUE(path);
    expect_flyable(*path, from, to);
    const double first = Scan(from, to, air).first_time(path->seconds());
    ASSERT_LE(path->seconds(), first + 1e-6);
    // Between two steps a word may be short enough and then too long again.
    missed += path->seconds() < first - 1e-6;
  }
  EXPECT_LE(missed, pairs / 200);
}

TEST(DubinsWind, NoWordMeetsTheGoalEarlier) {
  compare(1, 200, 4);
  compare(2, 50, 20);
}

TEST(NightlyDubinsWind, NoWordMeetsTheGoalEarlier) {
  compare(11, 10'000, 2);
  compare(12, 5000, 10);
  compare(13, 500, 100);
}

TEST(DubinsWind, WithoutWindItIsTheShortestPath) {
  RandomStream random(3);
  for (int n = 0; n < 2000; ++n) {
    const Pose from = random_pose(random, 8 * kRadius);
    const Pose to = random_pose(random, 8 * kRadius);
    const double shortest = dubins_length(from, to, kRadius);
    const auto still = wind_path(from, to, kRadius, {kAirspeed, Vec3::Zero()});
    ASSERT_TRUE(still);
    ASSERT_NEAR(still->seconds(), shortest / kAirspeed, 1e-12 * shortest);
    const AirplaneLimits limits{kRadius, radians(5), radians(5)};
    const auto airplane = wind_path(from, to, limits, {kAirspeed, Vec3::Zero()});
    ASSERT_NEAR(airplane->seconds(), shortest / kAirspeed, 1e-12 * shortest);
    for (const Leg& leg : still->legs(from, to.position)) {
      ASSERT_NE(leg.kind(), Leg::Kind::trochoid);
    }
    // The search itself, in a breath of wind.
    const auto moved = wind_path(from, to, kRadius, random_air(random, 1e-10));
    ASSERT_NEAR(moved->seconds(), shortest / kAirspeed, 1e-8 * shortest) << n;
  }
}

TEST(DubinsWind, StraightWithAndAgainstTheWind) {
  const Air air{kAirspeed, {5, 0, 0}};
  for (const double distance : {1e-3, 1.0, 1e3, 1e7}) {
    const Pose from{{0, 0, 0}, 0};
    const Pose to{{distance, 0, 0}, 0};
    EXPECT_NEAR(wind_path(from, to, kRadius, air)->seconds(), distance / 25, 1e-9 * distance);
    const Pose back{{0, 0, 0}, kPi};
    const Pose away{{distance, 0, 0}, kPi};
    EXPECT_NEAR(wind_path(away, back, kRadius, air)->seconds(), distance / 15, 1e-9 * distance);
  }
  const Pose here{{1, 2, 3}, 4};
  EXPECT_EQ(wind_path(here, here, kRadius, air)->seconds(), 0);
  EXPECT_FALSE(wind_path(here, {{1, 2, 9}, 4}, kRadius, {kAirspeed, {0, kAirspeed, 0}}));
}

/// The judge holds a turn to the end of its circle within 1e-6 m.
TEST(DubinsWind, FarAwayTheLastTurnStillEndsWhereItsCircleLeads) {
  RandomStream random(6);
  const AirplaneLimits limits{kRadius, radians(10), radians(6)};
  for (int n = 0; n < 500; ++n) {
    const Pose from = random_pose(random, 5000 * kRadius);
    const Pose to = random_pose(random, 5000 * kRadius);
    const auto path = wind_path(from, to, limits, random_air(random, 0.5));
    ASSERT_TRUE(path);
    const std::vector<Leg> legs = path->legs(from, to.position);
    ASSERT_EQ(legs.back().to, to.position);
    for (std::size_t i = 0; i < legs.size(); ++i) {
      const Leg& leg = legs[i];
      ASSERT_EQ(leg.from, i == 0 ? from.position : legs[i - 1].to);
      if (leg.turns()) {
        const Leg again = Leg::turning({leg.from, leg.heading}, leg.turn, leg.radius,
                                       leg.to.z() - leg.from.z(), leg.drift);
        ASSERT_LT((again.to - leg.to).norm(), 1e-7) << n;
      }
    }
  }
}

/// Heights are linear in time, and the angles through the air keep the limits; where the climb
/// takes longer than the quickest path, it takes no longer than it must.
TEST(DubinsWind, TheClimbKeepsTheLimitsInTheAir) {
  const AirplaneLimits limits{kRadius, radians(10), radians(6)};
  RandomStream random(4);
  int exact = 0;
  int longer = 0;
  for (int n = 0; n < 2000 && !HasFailure(); ++n) {
    Pose from = random_pose(random, 10 * kRadius);
    Pose to = random_pose(random, 10 * kRadius);
    to.position.z() = random.uniform(-200, 200);
    const Air air = random_air(random, random.uniform(0, 0.9));
    const auto path = wind_path(from, to, limits, air);
    ASSERT_TRUE(path);
    expect_flyable(*path, from, to);
    const double quickest = wind_path(from, to, kRadius, air)->seconds();
    const double rise = to.position.z();
    const double least =
        std::abs(rise) / std::tan(rise > 0 ? limits.climb : limits.sink) / kAirspeed;
    const double seconds = path->seconds();
    const double angle = std::atan2(rise, kAirspeed * seconds);
    ASSERT_LE(angle, limits.climb + 1e-8);
    ASSERT_GE(angle, -limits.sink - 1e-8);
    ASSERT_GE(path->through_air.word.radius, kRadius * (1 - 1e-12));
    const bool at_least = std::abs(seconds - std::max(quickest, least)) < 1e-8 * seconds;
    exact += at_least && least > quickest;
    longer += !at_least;
  }
  EXPECT_GT(exact, 500);
  EXPECT_LT(longer, 40);
  EXPECT_FALSE(wind_path({{0, 0, 0}, 0}, {{9, 9, 9}, 0}, {kRadius, 0, 1}, {kAirspeed, {1, 0, 0}}));
}

TEST(DubinsWind, ABoundOnTheLengthChangesNoAnswerBelowIt) {
  RandomStream random(12);
  const AirplaneLimits limits{kRadius, radians(8), radians(11)};
  for (int n = 0; n < 3000; ++n) {
    const Pose from = random_pose(random, 600);
    Pose to = random_pose(random, 600);
    to.position.z() = from.position.z() + random.uniform(-100, 100);
    const Air air = random_air(random, n % 3 == 0 ? 0 : 0.6);
    const double length = wind_path(from, to, limits, air)->through_air.length();
    const auto above = wind_path(from, to, limits, air, length * (1 + 1e-6));
    ASSERT_TRUE(above) << n;
    EXPECT_NEAR(above->through_air.length(), length, 1e-9 * length) << n;
    EXPECT_FALSE(wind_path(from, to, limits, air, length * (1 - 1e-6))) << n;
    const double calm = airplane_length(from, to, limits);
    EXPECT_EQ(airplane_length(from, to, limits, calm * (1 + 1e-6)), calm) << n;
    EXPECT_EQ(airplane_length(from, to, limits, calm * (1 - 1e-6)), kInfinity) << n;
  }
}
}  // namespace
}  // namespace altiplan::kit::dubins_wind_test
