// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/dubins/airplane.hpp"

#include <gtest/gtest.h>

#include "framework/dubins_oracle.hpp"

namespace altiplan::kit::dubins_airplane_test {
namespace {

namespace oracle = dubins_oracle;

constexpr AirplaneLimits kLimits{50, radians(12), radians(7)};

Pose random_pose(RandomStream& random, double within, double height) {
  Pose pose = oracle::random_pose(random, within);
  pose.position.z() = random.uniform(0, height);
  return pose;
}

/// The shortest of a fine grid of paths that are as long as they must be: words with any radius,
/// words of the least radius after and before any turn, all with whole circles added.
class Enumeration {
 public:
  Enumeration(const Pose& from, const Pose& to, double least, int steps)
      : from_(oracle::place(from)), to_(oracle::place(to)), least_(least) {
    const double radius = kLimits.radius;
    for (int n = 0; n <= steps; ++n) {
      const double larger = radius * std::exp(5.0 * n / steps);
      add(oracle::lengths(from_, to_, larger), 0, larger);
    }
    for (const int sense : {1, -1}) {
      for (int n = 1; n <= steps; ++n) {
        const double turn = 2 * kPi * n / steps;
        const oracle::Place after = turned(from_, sense, sense * turn);
        add(oracle::lengths(after, to_, radius), radius * turn, radius);
        const oracle::Place before = turned(to_, sense, -sense * turn);
        add(oracle::lengths(from_, before, radius), radius * turn, radius);
      }
    }
  }

  double shortest() const { return shortest_; }

 private:
  /// After a turn of the least radius to the left (sense 1) or right; a turn of the opposite sign
  /// is one that ends here.
  static oracle::Place turned(const oracle::Place& place, int sense, double turn) {
    const oracle::Point centre = place.at + double(sense) * kLimits.radius *
                                                oracle::left_of(oracle::direction(place.heading));
    return {centre + (place.at - centre) * oracle::direction(turn), place.heading + turn};
  }
  void add(const std::array<double, 6>& lengths, double more, double radius) {
    const double circle = 2 * kPi * radius;
    for (const double length : lengths) {
      const double lacking = std::ceil((least_ * (1 - 1e-12) - length - more) / circle);
      shortest_ = std::min(shortest_, length + more + circle * std::max(0.0, lacking));
    }
  }

  oracle::Place from_;
  oracle::Place to_;
  double least_;
  double shortest_ = kInfinity;
};

struct Counts {
  int direct = 0;     ///< the shortest horizontal path
  int extra = 0;      ///< with an extra turn
  int circling = 0;   ///< with whole circles
  int stretched = 0;  ///< of a larger radius
  int longer = 0;     ///< longer than the climb takes
};

void check(const Pose& from, const Pose& to, int steps, Counts& counts) {
  const double rise = to.position.z() - from.position.z();
  const double least = std::abs(rise) / std::tan(rise > 0 ? kLimits.climb : kLimits.sink);
  const std::array<double, 6> words =
      oracle::lengths(oracle::place(from), oracle::place(to), kLimits.radius);
  const double direct = *std::min_element(words.begin(), words.end());
  const auto path = airplane_path(from, to, kLimits);
  ASSERT_TRUE(path);
  ASSERT_GE(path->word.radius, kLimits.radius * (1 - 1e-12));
  const double length = oracle::expect_flyable(path->legs(from, to.position), from, to);
  ASSERT_NEAR(length, path->length(), 1e-9 * length);
  ASSERT_NEAR(airplane_length(from, to, kLimits), length, 1e-9 * length);
  const double angle = std::atan2(rise, length);
  ASSERT_LE(angle, kLimits.climb + 1e-8);
  ASSERT_GE(angle, -kLimits.sink - 1e-8);
  counts.direct += direct >= least;
  counts.extra += path->before != 0 || path->after != 0;
  counts.circling += path->word.parts[0] > 2 * kPi || path->word.parts[2] > 2 * kPi;
  counts.stretched += path->word.radius > kLimits.radius;
  if (length > std::max(direct, least) * (1 + 1e-8)) {
    ++counts.longer;
    ASSERT_LE(length, Enumeration(from, to, least, steps).shortest() * (1 + 1e-6));
  }
  // In a mirror, and flown backwards.
  const AirplaneLimits swapped{kLimits.radius, kLimits.sink, kLimits.climb};
  ASSERT_NEAR(airplane_length(oracle::mirrored(from), oracle::mirrored(to), kLimits), length,
              1e-8 * length);
  ASSERT_NEAR(airplane_length(oracle::turned_round(to), oracle::turned_round(from), swapped),
              length, 1e-8 * length);
}

Counts compare(std::uint64_t seed, int pairs, double within, double height, int steps) {
  RandomStream random(seed);
  Counts counts;
  for (int n = 0; n < pairs && !::testing::Test::HasFailure(); ++n) {
    SCOPED_TRACE(::testing::Message() << "pair " << n << " within " << within);
    const Pose from = random_pose(random, within * kLimits.radius, height);
    const Pose to = random_pose(random, within * kLimits.radius, height);
    check(from, to, steps, counts);
  }
  return counts;
}

TEST(DubinsAirplane, NoPathOfTheFamilyIsShorter) {
  const Counts counts = compare(1, 10'000, 6, 200, 1000);
  EXPECT_GT(counts.direct, 1000);
  EXPECT_GT(counts.extra, 200);
  EXPECT_GT(counts.circling, 500);
  EXPECT_GT(counts.stretched, 1000);
  EXPECT_GT(counts.longer, 30);
  compare(2, 500, 1, 50, 500);
  compare(3, 500, 30, 1000, 1000);
  compare(4, 500, 6, 10'000, 1000);
}

TEST(NightlyDubinsAirplane, NoPathOfTheFamilyIsShorter) {
  compare(11, 50'000, 6, 200, 4000);
  compare(12, 10'000, 1, 50, 4000);
  compare(13, 50'000, 30, 1000, 4000);
  compare(14, 10'000, 6, 10'000, 4000);
}

TEST(DubinsAirplane, WhatTheLimitsAllowDependsOnTheDirection) {
  const Pose low{{0, 0, 0}, 0};
  const Pose high{{600, 0, 100}, 0};
  EXPECT_NEAR(airplane_length(low, high, kLimits), 600, 1e-9);
  const double sinking = 100 / std::tan(kLimits.sink);
  EXPECT_NEAR(airplane_length({high.position, kPi}, {low.position, kPi}, kLimits), sinking, 1e-9);
  const AirplaneLimits level{50, 0, kLimits.sink};
  EXPECT_FALSE(airplane_path(low, high, level));
  EXPECT_EQ(airplane_length(low, high, level), kInfinity);
  EXPECT_TRUE(airplane_path({high.position, kPi}, {low.position, kPi}, level));
  EXPECT_NEAR(airplane_length(low, {{600, 0, 0}, 0}, level), 600, 1e-9);
}

TEST(DubinsAirplane, AboveItselfItFliesAHelix) {
  for (const double height : {1.0, 60.0, 100.0, 5000.0}) {
    const Pose low{{10, 20, 0}, 1};
    const Pose high{{10, 20, height}, 1};
    const auto path = airplane_path(low, high, kLimits);
    ASSERT_TRUE(path);
    const double length = oracle::expect_flyable(path->legs(low, high.position), low, high);
    const double least = height / std::tan(kLimits.climb);
    EXPECT_NEAR(length, std::max(least, 2 * kPi * kLimits.radius), 1e-8 * length) << height;
  }
}
}  // namespace
}  // namespace altiplan::kit::dubins_airplane_test
