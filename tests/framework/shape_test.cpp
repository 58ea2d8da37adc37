// SPDX-License-Identifier: Apache-2.0
#include "altiplan/shape.hpp"

#include <gtest/gtest.h>

#include "framework/shape_oracle.hpp"

namespace altiplan::shape_test {
namespace {

using oracle::Draw;
using oracle::Solid;

class ShapeAtScale : public ::testing::TestWithParam<double> {};

TEST_P(ShapeAtScale, DistancesEqualTheOracles) {
  const double scale = GetParam();
  Draw draw(static_cast<std::uint64_t>(scale));
  for (int n = 0; n < 3000; ++n) {
    const Solid solid = oracle::random_solid(draw, draw.point(scale), scale * draw(0.01, 1));
    for (int m = 0; m < 3; ++m) {
      const Vec3 a = draw.point(1.5 * scale);
      const Vec3 b = m == 0 ? Vec3(a + draw.point(0.05 * scale)) : draw.point(1.5 * scale);
      const double expected = oracle::leg_distance(solid, a, b);
      ASSERT_NEAR(leg_distance(solid.shape, a, b), expected, 1e-9 * (scale + expected)) << n;
      const double depth = oracle::signed_distance(solid, a);
      ASSERT_NEAR(signed_distance(solid.shape, a), depth, 1e-9 * (scale + std::abs(depth))) << n;
      const Vec3 q = nearest_surface_point(solid.shape, a);
      ASSERT_NEAR((q - a).norm(), std::abs(depth), 1e-9 * (scale + std::abs(depth))) << n;
      ASSERT_NEAR(oracle::signed_distance(solid, q), 0, 1e-9 * scale) << n;
    }
  }
}

TEST_P(ShapeAtScale, MovesAsARigidBody) {
  const double scale = GetParam();
  Draw draw(99);
  for (int n = 0; n < 500; ++n) {
    const Solid solid = oracle::random_solid(draw, draw.point(scale), 0.4 * scale);
    const Vec3 offset = draw.point(scale);
    const Shape there = moved(solid.shape, offset);
    const Vec3 p = draw.point(2 * scale);
    EXPECT_NEAR(signed_distance(there, p + offset), signed_distance(solid.shape, p), 1e-9 * scale);
    const Box box = bounds(there);
    EXPECT_TRUE(box.contains(nearest_surface_point(there, p), 1e-9 * scale));
  }
}

INSTANTIATE_TEST_SUITE_P(Scales, ShapeAtScale, ::testing::Values(1, 100, 10000, 100000));

TEST(Shape, OverlapIsThatOfTheOpenBox) {
  Draw draw(7);
  int overlapping = 0;
  for (int n = 0; n < 600; ++n) {
    const Solid solid = oracle::random_solid(draw, draw.point(6), 5);
    const Vec3 low = draw.point(8);
    const Box box{low, low + Vec3(draw(0.1, 4), draw(0.1, 4), draw(0.1, 4))};
    const double by = n % 3 == 0 ? 0 : draw(0, 3);
    // Whether some sample of the box lies in the grown shape; a no must leave none.
    double least = kInfinity;
    for (int m = 0; m < 300; ++m) {
      const Vec3 share(draw(0, 1), draw(0, 1), draw(0, 1));
      least = std::min(
          least, signed_distance(solid.shape, box.min + share.cwiseProduct(box.max - box.min)));
    }
    // Distance of the box as a union of legs along x: a fine lattice of them bounds it from above.
    double from_legs = kInfinity;
    for (int j = 0; j <= 12; ++j) {
      for (int k = 0; k <= 12; ++k) {
        const Vec3 a = box.min + Vec3(0, j / 12.0, k / 12.0).cwiseProduct(box.max - box.min);
        from_legs =
            std::min(from_legs, oracle::leg_distance(solid, a, Vec3(box.max.x(), a.y(), a.z())));
      }
    }
    const bool answer = overlaps(solid.shape, box, by);
    overlapping += answer;
    if (least < by - 1e-6 || from_legs < by - 1e-6) {
      EXPECT_TRUE(answer) << n;
    }
    const double cell = (box.max - box.min).tail<2>().norm() / 12;
    if (from_legs > by + cell) {
      EXPECT_FALSE(answer) << n;
    }
  }
  EXPECT_GT(overlapping, 90);
}

TEST(Shape, FacesThatTouchDoNotOverlap) {
  const Box cell{{0, 0, 0}, {1, 1, 1}};
  EXPECT_FALSE(overlaps(BoxShape{{{1, 0, 0}, {2, 1, 1}}}, cell, 0));
  EXPECT_FALSE(overlaps(BoxShape{{{1.25, 0, 0}, {2, 1, 1}}}, cell, 0.25));
  EXPECT_TRUE(overlaps(BoxShape{{{1.25, 0, 0}, {2, 1, 1}}}, cell, 0.2501));
  EXPECT_FALSE(overlaps(Prism{{{1, 0}, {2, 0}, {2, 1}, {1, 1}}, {}, 0, 1}, cell, 0));
  EXPECT_FALSE(overlaps(Cylinder{3, 0.5, 2, 0, 1}, cell, 0));
  EXPECT_FALSE(overlaps(Sphere{{0.5, 0.5, 3}, 2}, cell, 0));
  EXPECT_TRUE(overlaps(BoxShape{{{0.5, 0.2, 0.2}, {0.5, 0.8, 0.8}}}, cell, 0));
  EXPECT_FALSE(overlaps(
      Prism{{{-2, -2}, {3, -2}, {3, 3}, {-2, 3}}, {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}, 0, 1}, cell,
      0));
}

TEST(Shape, LegsThatMeetHaveNoDistance) {
  const Prism wall{{{0, 0}, {0.01, 0}, {0.01, 1000}, {0, 1000}}, {}, 0, 100};
  EXPECT_EQ(leg_distance(wall, {-5000, 500, 50}, {5000, 507, 50}), 0);
  EXPECT_EQ(
      leg_distance(BoxShape{{{0, 0, 0}, {0.01, 1000, 100}}}, {-5000, 500, 50}, {5000, 507, 50}), 0);
  EXPECT_EQ(leg_distance(wall, {0.005, 500, 200}, {0.005, 500, -200}), 0);
  EXPECT_EQ(leg_distance(wall, {0.005, 500, 50}, {0.006, 500, 50}), 0);
}

TEST(Shape, DepthOfALegTellsThroughFromTouching) {
  const Prism corner{{{0, 0}, {10, 0}, {10, 10}, {5, 5}, {0, 10}}, {}, 0, 5};  // a notch from above
  EXPECT_EQ(leg_depth(corner, {-5, 0, 1}, {15, 0, 1}), 0);                     // along a side
  EXPECT_EQ(leg_depth(corner, {-5, 2, 5}, {15, 2, 5}), 0);                     // on the roof
  EXPECT_EQ(leg_depth(corner, {-5, 11, 1}, {15, 11, 1}), 0);
  EXPECT_NEAR(leg_depth(corner, {0, 10, 1}, {5, 5, 1}), 0, 1e-12);  // along the notch
  EXPECT_GT(leg_depth(corner, {-5, 5, 2}, {15, 5, 2}), 0.5);        // meets the notch's tip
  EXPECT_NEAR(leg_depth(BoxShape{{{0, 0, 0}, {0.01, 9, 9}}}, {-5, 5, 5}, {5, 5, 5}), 0.005, 1e-9);
  EXPECT_GE(leg_depth(Sphere{{0, 0, 0}, 3}, {-9, 0, 0}, {9, 0.1, 0}), 1.5);
  EXPECT_EQ(leg_depth(Sphere{{0, 0, 0}, 3}, {-9, 3, 0}, {9, 3, 0}), 0);
  EXPECT_EQ(leg_depth(Cylinder{0, 0, 3, -kInfinity, kInfinity}, {0, 0, -7}, {0, 0, 8}), 3);
}
}  // namespace
}  // namespace altiplan::shape_test
