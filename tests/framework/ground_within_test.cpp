// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/layers/ground_within.hpp"

#include <gtest/gtest.h>

#include "altiplan/kit/layers/field_within.hpp"
#include "altiplan/random.hpp"

namespace altiplan::ground_within_test {
namespace {

using kit::GroundPiece;

/// A paraboloid that bends downward, by 0.02 a metre along both axes, and rises eastward.
double ground(double x, double y) { return 0.5 * x - 0.01 * (x * x + y * y); }

/// A search of the ground, cut off at `top`, of a square of 120 m.
kit::GroundWithin searched(const Vec3& a, const Vec3& b, double distance, double top,
                           kit::GroundWithin::Until until) {
  kit::GroundWithin within(a, b, distance, until);
  within.search(-60, -60, 60, 60, [&](double x0, double y0, double x1, double y1) {
    const double x = (x0 + x1) / 2;
    const double y = (y0 + y1) / 2;
    const double r = std::hypot(x1 - x0, y1 - y0) / 2;
    return GroundPiece{x, y, ground(x, y), 0.5 - 0.02 * x, -0.02 * y, 0.01 * r * r, top};
  });
  return within;
}

/// Whether the leg comes nearer than that to the ground.
bool is_within(const Vec3& a, const Vec3& b, double distance, double top) {
  return searched(a, b, distance, top, kit::GroundWithin::Until::found).found();
}

double nearest(const Vec3& a, const Vec3& b, double top) {
  return searched(a, b, 200, top, kit::GroundWithin::Until::nearest).distance();
}

/// The least distance, by samples of the ground, finer and finer about the best.
double sampled(const Vec3& a, const Vec3& b, double top) {
  double x = 0;
  double y = 0;
  double least = kInfinity;
  for (double half = 60; half > 1e-6; half *= 0.8) {
    const double from_x = x;
    const double from_y = y;
    for (int n = 0; n < 41 * 41; ++n) {
      const double at_x = std::clamp(from_x + half * (n % 41 - 20) / 20, -60.0, 60.0);
      const double at_y = std::clamp(from_y + half * (n / 41 - 20) / 20, -60.0, 60.0);
      const Vec3 point(at_x, at_y, std::min(top, ground(at_x, at_y)));
      if (const double distance = point_leg_distance(point, a, b); distance < least) {
        least = distance;
        x = at_x;
        y = at_y;
      }
    }
  }
  return least;
}

TEST(GroundWithin, IsRightByATenthOfAMillimetre) {
  RandomStream random(5);
  const auto above = [&] {  // the summit of the ground is 6.25 m high
    return Vec3(random.uniform(-40, 40), random.uniform(-40, 40), random.uniform(7, 40));
  };
  for (int n = 0; n < 60; ++n) {
    const Vec3 a = above();
    const Vec3 b = n % 3 == 0 ? a : n % 3 == 1 ? Vec3(a + Vec3(0, 0, 10)) : above();
    const double top = n % 2 == 0 ? kInfinity : -3;
    const double distance = sampled(a, b, top);
    EXPECT_TRUE(is_within(a, b, distance + 1e-4, top)) << n;
    EXPECT_FALSE(is_within(a, b, distance - 1e-4, top)) << n;
    const double found = nearest(a, b, top);
    EXPECT_NEAR(found, distance, 1e-4) << n;
    EXPECT_TRUE(is_within(a, b, found + 1e-6, top)) << n;
    EXPECT_FALSE(is_within(a, b, found - 1e-6, top)) << n;
  }
}

TEST(GroundWithin, TheNearestPointOfAnElevationModel) {
  RandomStream random(6);
  std::vector<float> heights(8 * 8);
  for (float& height : heights) {
    height = float(random.uniform(0, 60));
  }
  const HeightField field({0, 0}, {20, 30}, 8, 8, heights);
  for (int n = 0; n < 100; ++n) {
    const Vec3 p(random.uniform(0, 140), random.uniform(0, 210), random.uniform(61, 120));
    kit::GroundWithin search(p, p, 200, kit::GroundWithin::Until::nearest);
    kit::search_field(search, field);
    ASSERT_TRUE(search.nearest()) << n;
    const Vec3& q = *search.nearest();
    EXPECT_NEAR((p - q).norm(), search.distance(), 1e-9) << n;
    EXPECT_NEAR(*field.at(q.x(), q.y()), q.z(), 1e-9) << n;
    for (int k = 0; k < 1000; ++k) {
      const double x = random.uniform(0, 140);
      const double y = random.uniform(0, 210);
      EXPECT_GE((p - Vec3(x, y, *field.at(x, y))).norm(), search.distance() - 1e-8) << n;
    }
  }
}

TEST(GroundWithin, OfALegToAPlane) {
  const GroundPiece slope{10, 20, 5, 1, 0, 0};  // through (10, 20, 5), rising eastward at 45°
  const auto found =
      kit::leg_to_plane({10, 0, 5 + std::sqrt(2)}, {10, 40, 5 + std::sqrt(2)}, slope, 100, 100);
  EXPECT_NEAR(found.distance, 1, 1e-12) << "along the slope";
  const auto through = kit::leg_to_plane({10, 20, 0}, {10, 20, 50}, slope, 1, 1);
  EXPECT_NEAR(through.distance, 0, 1e-12);
  EXPECT_NEAR(through.share, 0.1, 1e-12);
  const auto beside = kit::leg_to_plane({16, 20, 6}, {26, 20, 6}, slope, 1, 1);
  EXPECT_NEAR(beside.distance, 5, 1e-12) << "from its edge";
  EXPECT_NEAR(beside.x, 11, 1e-12);
}
}  // namespace
}  // namespace altiplan::ground_within_test
