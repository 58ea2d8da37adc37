// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/layers/ground.hpp"

#include <gtest/gtest.h>

#include "altiplan/random.hpp"

namespace altiplan::ground_test {
namespace {

/// A plane that rises eastward, with a dome of radius 30 over the origin.
double ground(double x, double y) {
  const double left = 900 - x * x - y * y;
  return 0.5 * x + (left > 0 ? std::sqrt(left) : 0);
}
/// No more than the plane's height at the eastern side and the dome's at the nearest place.
double highest(double x0, double y0, double x1, double y1) {
  const double x = std::clamp(0.0, x0, x1);
  const double y = std::clamp(0.0, y0, y1);
  return 0.5 * x1 + ground(x, y) - 0.5 * x;
}

TEST(Ground, HeightThatKeepsADistance) {
  EXPECT_DOUBLE_EQ(kit::height_for(10, 0), 10);
  EXPECT_DOUBLE_EQ(kit::height_for(10, 0.75), 12.5);
  EXPECT_DOUBLE_EQ(kit::height_for(-1, 5), -1);
}

TEST(Ground, TooNearIsHeldToTheSlopeNearby) {
  // Flat up to x = 100, then rising steeply: only near the slope is the steep one asked for.
  const auto at = [](double x) { return std::max(0.0, 2 * (x - 100)); };
  const auto gap = [&](const Vec3& a, const Vec3& b, double) {
    return std::min(a.z() - at(a.x()), b.z() - at(b.x()));
  };
  const auto slope = [](const Vec3& a, const Vec3& b, double r) {
    return std::max(a.x(), b.x()) + r > 100 ? 2.0 : 0.0;
  };
  const double r = 5;
  const double enough = kit::height_for(r, 2);
  const auto near = [&](double x0, double x1, double z) {
    return kit::too_near_ground({x0, 0, z}, {x1, 0, z}, r, {1e9, enough}, 0.1, gap, slope,
                                [](const Vec3&, const Vec3& b, double keep) {
                                  // From the foot of the slope, at its end or beyond it.
                                  const double up = b.x() - 100;
                                  return up + 2 * b.z() > 0 &&
                                         (b.z() - 2 * up) / std::sqrt(5) < keep;
                                });
  };
  EXPECT_FALSE(near(0, 90, 5)) << "touching is free";
  EXPECT_TRUE(near(0, 90, 4.9999));
  EXPECT_FALSE(near(0, 94, 5)) << "5 m above the flat, 6 m from the slope's foot";
  EXPECT_TRUE(near(0, 100, 5)) << "by the slope";
  const double touching = 100 + 2.5 * (1 - std::sqrt(5));
  EXPECT_FALSE(near(0, touching, 5));
  EXPECT_TRUE(near(0, touching + 1e-3, 5));
  EXPECT_FALSE(near(0, 100, enough));
}

TEST(Ground, WhatIsFarAboveTheTopIsFree) {
  // A plateau of 100 m with a steep side: high over it the side's slope is of no matter.
  const auto at = [](double x) { return std::clamp(2 * x, 0.0, 100.0); };
  const auto gap = [&](const Vec3& a, const Vec3& b, double) {
    double least = std::min(a.z() - at(a.x()), b.z() - at(b.x()));
    for (const double x : {0.0, 50.0}) {
      const double t = (x - a.x()) / (b.x() - a.x());
      least = t > 0 && t < 1 ? std::min(least, a.z() + t * (b.z() - a.z()) - at(x)) : least;
    }
    return least;
  };
  const auto slope = [](const Vec3&, const Vec3&, double) { return 2.0; };
  const auto near = [&](const Vec3& a, const Vec3& b) {
    return kit::too_near_ground(a, b, 30, {100, kit::height_for(30, 2)}, 0.1, gap, slope,
                                [](const Vec3&, const Vec3&, double) { return true; });
  };
  EXPECT_FALSE(near({60, 0, 130}, {400, 0, 130})) << "30 m above the plateau";
  EXPECT_TRUE(near({60, 0, 129.99}, {400, 0, 130}));
  EXPECT_FALSE(near({-100, 0, 70}, {50, 0, 190})) << "up the side, its foot 70 m below, and on";
  EXPECT_FALSE(near({50, 0, 190}, {-100, 0, 70}));
  EXPECT_TRUE(near({-100, 0, 40}, {50, 0, 131})) << "too low at the side";
}

TEST(Ground, NearestPointIsWithinFivePercent) {
  const Box all;
  RandomStream random(5);
  for (int n = 0; n < 300; ++n) {
    Vec3 p(random.uniform(-60, 60), random.uniform(-60, 60), 0);
    p.z() = ground(p.x(), p.y()) + random.uniform(0.01, 60);
    const kit::NearestGround nearest(p, all, ground, highest);
    EXPECT_NEAR(nearest.point().z(), ground(nearest.point().x(), nearest.point().y()), 1e-9);
    EXPECT_NEAR((nearest.point() - p).norm(), nearest.distance(), 1e-9);
    for (int k = 0; k < 500; ++k) {
      const double x = p.x() + random.uniform(-1, 1) * nearest.distance();
      const double y = p.y() + random.uniform(-1, 1) * nearest.distance();
      EXPECT_GT((Vec3(x, y, ground(x, y)) - p).norm(), 0.95 * nearest.distance() - 1e-9);
    }
  }
}

TEST(Ground, NearestPointFromBesideTheGround) {
  const Box over{{-20, -20, -kInfinity}, {20, 20, kInfinity}};
  const kit::NearestGround nearest(Vec3(50, 0, 60), over, ground, highest);
  EXPECT_TRUE(over.contains(nearest.point()));
  double least = kInfinity;
  for (double x = -20; x <= 20; x += 0.1) {
    for (double y = -20; y <= 20; y += 0.5) {
      least = std::min(least, (Vec3(x, y, ground(x, y)) - Vec3(50, 0, 60)).norm());
    }
  }
  EXPECT_LT(nearest.distance(), least * 1.0501);
  EXPECT_GT(nearest.distance(), least * 0.99);
}

TEST(Ground, ColumnsAreBlockedUpToTheHighestGround) {
  GridSpec spec;
  spec.origin = {-50, -50, -30};
  spec.cell = {10, 10, 5};
  spec.counts = {10, 10, 20};
  for (const auto rule : {GridSpec::Rule::touched, GridSpec::Rule::centre}) {
    for (const double inflation : {0.0, 7.0}) {
      spec.rule = rule;
      spec.inflation = inflation;
      VoxelGrid grid(spec);
      kit::rasterize_ground(grid, highest);
      const bool centre = rule == GridSpec::Rule::centre;
      const double half = (centre ? 0 : 5) + inflation;
      for (int j = 0; j < 10; ++j) {
        for (int i = 0; i < 10; ++i) {
          const Vec3 c = spec.centre({i, j, 0});
          const double top =
              highest(c.x() - half, c.y() - half, c.x() + half, c.y() + half) + inflation;
          for (int k = 0; k < 20; ++k) {
            const double low = spec.origin.z() + 5 * k;
            EXPECT_EQ(grid.blocked(i, j, k), centre ? low + 2.5 <= top : low < top)
                << i << " " << j << " " << k;
          }
        }
      }
    }
  }
  // Where there is no ground nothing is blocked; where it is unknown, everything.
  VoxelGrid none(spec);
  kit::rasterize_ground(
      none, [](double x0, double, double, double) { return x0 < 0 ? -kInfinity : kInfinity; });
  EXPECT_FALSE(none.blocked(0, 0, 0));
  EXPECT_TRUE(none.blocked(9, 9, 19));
}
}  // namespace
}  // namespace altiplan::ground_test
