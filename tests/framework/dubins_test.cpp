// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/dubins/dubins.hpp"

#include <gtest/gtest.h>

#include "framework/dubins_oracle.hpp"

namespace altiplan::kit::dubins_test {
namespace {

namespace oracle = dubins_oracle;
using oracle::expect_flyable;
using oracle::mirrored;
using oracle::random_pose;
using oracle::turned_round;

constexpr double kRadius = 50;

void compare(std::uint64_t seed, int pairs, double within) {
  RandomStream random(seed);
  for (int n = 0; n < pairs; ++n) {
    const Pose from = random_pose(random, within * kRadius);
    const Pose to = random_pose(random, within * kRadius);
    SCOPED_TRACE(::testing::Message() << "pair " << n << " within " << within);
    const std::array<double, 6> expected =
        oracle::lengths(oracle::place(from), oracle::place(to), kRadius);
    const std::array<double, 6> lengths = PosePair(from, to).lengths(kRadius);
    for (std::size_t word = 0; word < 6; ++word) {
      if (expected[word] == kInfinity) {
        ASSERT_EQ(lengths[word], kInfinity) << word;
      } else {
        ASSERT_NEAR(lengths[word], expected[word], 1e-9 * expected[word]) << word;
      }
    }
    const double shortest = *std::min_element(expected.begin(), expected.end());
    const double slack = 1e-9 * shortest;
    ASSERT_NEAR(dubins_length(from, to, kRadius), shortest, slack);
    ASSERT_NEAR(dubins_length(mirrored(from), mirrored(to), kRadius), shortest, slack);
    ASSERT_NEAR(dubins_length(turned_round(to), turned_round(from), kRadius), shortest, slack);
    const DubinsPath path = dubins_path(from, to, kRadius);
    ASSERT_NEAR(path.length(), shortest, slack);
    expect_flyable(path.legs(from, to.position), from, to);
    ASSERT_FALSE(::testing::Test::HasFailure());
  }
}

TEST(Dubins, EveryWordIsAsLongAsTangentsAndCirclesSay) {
  compare(1, 4000, 10);
  compare(2, 4000, 2);
  compare(3, 1000, 0.2);
  compare(4, 1000, 1e6);
}

TEST(NightlyDubins, EveryWordIsAsLongAsTangentsAndCirclesSay) {
  compare(11, 400'000, 10);
  compare(12, 400'000, 2);
  compare(13, 100'000, 0.2);
  compare(14, 100'000, 1e6);
}

TEST(Dubins, EachWordHasLegsOfItsOwn) {
  RandomStream random(5);
  std::array<int, 6> found{};
  for (int n = 0; n < 1000; ++n) {
    const Pose from = random_pose(random, 4 * kRadius);
    const Pose to = random_pose(random, 4 * kRadius);
    const std::array<double, 6> lengths = PosePair(from, to).lengths(kRadius);
    for (const DubinsWord word : kDubinsWords) {
      const auto path = dubins_path(from, to, kRadius, word);
      ASSERT_EQ(path.has_value(), lengths[std::size_t(word)] < kInfinity);
      if (path) {
        ++found[std::size_t(word)];
        ASSERT_NEAR(path->length(), lengths[std::size_t(word)], 1e-9 * path->length());
        expect_flyable(path->legs(from, to.position), from, to);
      }
    }
    ASSERT_FALSE(HasFailure()) << n;
  }
  EXPECT_GT(*std::min_element(found.begin(), found.end()), 100);
}

TEST(Dubins, EqualPosesAreNoPathApart) {
  RandomStream random(6);
  for (int n = 0; n < 100; ++n) {
    const Pose pose = random_pose(random, 1e6);
    EXPECT_EQ(dubins_length(pose, pose, kRadius), 0);
    EXPECT_TRUE(dubins_path(pose, pose, kRadius).legs(pose, pose.position).empty());
    for (const double circles : {-3.0, 1.0, 1000.0}) {
      const Pose again{pose.position, pose.heading + circles * 2 * kPi};
      EXPECT_NEAR(dubins_length(pose, again, kRadius), 0, 1e-9);
      EXPECT_NEAR(PosePair(pose, again).lengths(kRadius)[0], 0, 1e-9);
    }
    const Pose close{pose.position + 1e-10 * unit_heading(n), pose.heading + 1e-13};
    EXPECT_LT(dubins_length(pose, close, kRadius), 1e-9) << n;
  }
}

/// Where rounding decides on which side of the line the second pose lies.
TEST(Dubins, NoCircleIsAddedForRounding) {
  RandomStream random(7);
  for (int n = 0; n < 10'000; ++n) {
    const Pose from = random_pose(random, 1e4);
    const double distance = std::pow(10, random.uniform(-8, 7)) * kRadius;
    const double slack = 1e-9 * (kRadius + distance);
    const Vec3 step = distance * unit_heading(from.heading);
    const Pose ahead{from.position + step, from.heading};
    ASSERT_NEAR(dubins_length(from, ahead, kRadius), distance, slack) << n;
    const double turn = random.uniform(-3, 3);
    const double arc_length = kRadius * std::abs(turn);
    const Leg arc = Leg::turning(from, turn, kRadius, 0);
    const Pose round{arc.to, from.heading + turn};
    ASSERT_NEAR(dubins_length(from, round, kRadius), arc_length, 1e-7) << n;
    const Pose then_ahead{arc.to + distance * unit_heading(round.heading), round.heading};
    ASSERT_NEAR(dubins_length(from, then_ahead, kRadius), arc_length + distance, slack + 1e-7) << n;
    const Pose then_round{arc.to + step, round.heading};
    ASSERT_NEAR(dubins_length(from, then_round, kRadius), arc_length + distance, slack + 1e-7) << n;
    if (distance > kRadius && distance < 100 * kRadius) {
      const std::array<double, 6> lengths = PosePair(from, ahead).lengths(kRadius);
      for (std::size_t word = 0; word < 4; ++word) {
        ASSERT_NEAR(lengths[word], distance, slack) << n << ' ' << word;
      }
      const std::size_t same = turn > 0 ? 0 : 1;
      for (const Pose& to : {then_ahead, then_round}) {
        const double length = PosePair(from, to).lengths(kRadius)[same];
        ASSERT_NEAR(length, arc_length + distance, slack) << n;
      }
    }
  }
}

TEST(Dubins, AtTheEdgeOfAWord) {
  // Right circle at the start and left circle at the end touch: RSL has no straight part.
  const Pose from{{0, 0, 0}, 0};
  const Pose touching{{2 * kRadius, -2 * kRadius, 0}, 0};
  const auto crossing = dubins_path(from, touching, kRadius, DubinsWord::rsl);
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->length(), kPi * kRadius, 1e-9);
  const Pose nearer{{2 * kRadius - 0.01, -2 * kRadius + 0.01, 0}, 0};
  EXPECT_FALSE(dubins_path(from, nearer, kRadius, DubinsWord::rsl));
  // Three circles in a line.
  const Pose far{{4 * kRadius, 0, 0}, 0};
  const auto turns = dubins_path(from, far, kRadius, DubinsWord::lrl);
  ASSERT_TRUE(turns);
  EXPECT_NEAR(turns->parts[1], kPi, 1e-6);
  expect_flyable(turns->legs(from, far.position), from, far);
  const Pose farther{{4 * kRadius + 0.01, 0, 0}, 0};
  EXPECT_FALSE(dubins_path(from, farther, kRadius, DubinsWord::lrl));
  EXPECT_EQ(PosePair(from, farther).lengths(kRadius)[std::size_t(DubinsWord::lrl)], kInfinity);
}

TEST(Dubins, TheHeightChangesLinearly) {
  const Pose from{{0, 0, 100}, 1};
  const Pose to{{700, 300, 160}, -2};
  const DubinsPath path = dubins_path(from, to, kRadius);
  const std::vector<Leg> legs = path.legs(from, to.position);
  ASSERT_EQ(legs.size(), 3u);
  for (const Leg& leg : legs) {
    EXPECT_NEAR((leg.to.z() - leg.from.z()) / leg.air_length(), 60 / path.length(), 1e-12);
  }
  EXPECT_EQ(legs.back().to, to.position);
}
}  // namespace
}  // namespace altiplan::kit::dubins_test
