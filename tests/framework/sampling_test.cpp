// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/sampling/sampling.hpp"

#include <gtest/gtest.h>

#include "altiplan/check.hpp"

namespace altiplan::kit::sampling_test {
namespace {

TEST(Sampling, TheInformedSetIsDrawnEvenlyWithinTheBox) {
  for (const double height : {0.0, 100.0}) {
    const Box box{{0, 0, 50}, {100, 80, 50 + height}};
    const Vec3 start(20, 30, 50);
    const Vec3 goal(70, 60, 50 + height / 2);
    const double apart = (goal - start).norm();
    for (const double ratio : {1.0, 1.05, 1.5, 4.0}) {
      InformedSet set(start, goal, box);
      EXPECT_EQ(set.measure(), height == 0 ? 8000 : 800'000);
      set.set_length(apart * ratio);
      RandomStream random(7);
      RandomStream plain(8);
      Vec3 mean = Vec3::Zero();
      Vec3 expected = Vec3::Zero();
      const int count = 4000;
      int hit = 0;
      for (int n = 0; n < count; ++n) {
        const Vec3 p = set.draw(random);
        ASSERT_TRUE(box.contains(p));
        ASSERT_LE((p - start).norm() + (p - goal).norm(), apart * ratio * (1 + 1e-9));
        mean += p / count;
      }
      for (int n = 0; n < 1'000'000 && hit < count; ++n) {
        const Vec3 p = plain.in(box);
        if (set.contains(p)) {
          expected += p;
          ++hit;
        }
      }
      if (hit == count) {
        EXPECT_LT((mean - expected / hit).norm(), 0.02 * box.max.norm()) << height << ' ' << ratio;
      }
    }
  }
}

TEST(Sampling, StraightAheadWhereNothingIsInTheWay) {
  const Limits limits;
  EXPECT_EQ(steer(std::nullopt, {0, 0, 0}, {3, 4, 0}, 5, limits), Vec3(3, 4, 0));
  EXPECT_TRUE(steer(Vec3(1, 0, 0), {0, 0, 0}, {30, 40, 0}, 5, limits).isApprox(Vec3(3, 4, 0)));
  Limits long_legs;
  long_legs.min_leg = 10;
  EXPECT_NEAR(steer(std::nullopt, {0, 0, 0}, {3, 4, 0}, 20, long_legs).norm(), 10, 1e-6);
}

/// Each limit alone is kept wherever the target lies, and what keeps it already stays.
TEST(Sampling, LegsAreBentToKeepALimit) {
  Request request;
  request.world = std::make_shared<const World>();
  request.volume = {{-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}};
  const auto steered = [&](const Limits& limits, bool level) {
    RandomStream random(9);
    request.limits = limits;
    int bent = 0;
    const double height = level ? 0 : 20;
    const Box around{{-20, -20, -height}, {20, 20, height}};
    for (int n = 0; n < 3000; ++n) {
      const Vec3 at = random.in(around);
      const Vec3 before = at - 8 * (random.in(around)-at).normalized();
      const Vec3 target = random.in(around);
      const Vec3 end = steer(before, at, target, 8, limits);
      EXPECT_TRUE(leg_ok(before, at, end, request)) << n;
      if (level) {
        EXPECT_EQ(end.z(), 0);
      }
      const Vec3 straight = steer(std::nullopt, at, target, 8, Limits{});
      if (leg_ok(before, at, straight, request) && limits.min_turn_radius == 0) {
        EXPECT_EQ(end, straight) << n;
      }
      bent += end != straight;
    }
    EXPECT_GT(bent, 300);
  };
  for (const bool level : {false, true}) {
    Limits turn;
    turn.max_turn_horizontal = radians(40);
    steered(turn, level);
    Limits space;
    space.max_turn_space = radians(70);
    steered(space, level);
    Limits climb;
    climb.max_climb = radians(15);
    if (!level) {
      steered(climb, level);
    }
  }
}
}  // namespace
}  // namespace altiplan::kit::sampling_test
