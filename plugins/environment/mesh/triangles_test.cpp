// SPDX-License-Identifier: Apache-2.0
// Distances compared with sampling.
#include "triangles.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>

#include "altiplan/kit/layers/solid.hpp"
#include "random_triangles_test.hpp"

namespace altiplan::mesh::triangles_test {
namespace {

/// Visits points of the triangle at even spacing.
template <class Visit>
void sample(const Triangle& t, const Visit& visit) {
  constexpr int kSteps = 60;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      visit(Vec3(t[0] + (t[1] - t[0]) * i / kSteps + (t[2] - t[0]) * j / kSteps));
    }
  }
}
/// Every point of a triangle in kAround is at most this far from a sample.
constexpr double kGap = 2 * 3.5 / 60;

TEST(Triangle, NearestPointIsOnItAndNearest) {
  RandomStream random(1);
  for (int n = 0; n < 500; ++n) {
    const Triangle t = triangle(random, n);
    const Vec3 p = 2 * random.in(kAround);
    const Vec3 nearest = nearest_point(t, p);
    double sampled = kInfinity;
    double off = kInfinity;
    sample(t, [&](const Vec3& q) {
      sampled = std::min(sampled, (q - p).norm());
      off = std::min(off, (q - nearest).norm());
    });
    EXPECT_LE((nearest - p).norm(), sampled + 1e-9) << n;
    EXPECT_LT(off, kGap) << n;
  }
}

TEST(Triangle, LegDistanceIsTheLeastOfItsPoints) {
  RandomStream random(2);
  constexpr int kSteps = 400;
  int meeting = 0;
  for (int n = 0; n < 2000; ++n) {
    const Triangle t = triangle(random, n);
    const Vec3 a = 2 * random.in(kAround);
    const Vec3 b = n % 7 == 0 ? a : Vec3(2 * random.in(kAround));
    double sampled = kInfinity;
    for (int i = 0; i <= kSteps; ++i) {
      const Vec3 p = a + (b - a) * i / kSteps;
      sampled = std::min(sampled, (nearest_point(t, p) - p).norm());
    }
    const double distance = leg_distance(t, a, b);
    EXPECT_LE(distance, sampled + 1e-9) << n;
    EXPECT_GE(distance, sampled - (b - a).norm() / kSteps) << n;
    EXPECT_NEAR(distance, leg_distance(t, b, a), 1e-9) << n;
    meeting += distance == 0 ? 1 : 0;
  }
  EXPECT_GT(meeting, 20);
}

TEST(Triangle, BoxDistanceIsTheLeastOfItsPoints) {
  RandomStream random(3);
  for (int n = 0; n < 2000; ++n) {
    const Triangle t = triangle(random, n);
    const Vec3 low = 2 * random.in(kAround);
    const Box box{low, low + 0.5 * (random.in(kAround) + Vec3(1.1, 1.1, 1.1))};
    double sampled = kInfinity;
    sample(t, [&](const Vec3& q) { sampled = std::min(sampled, kit::outside(box, q)); });
    const double distance = box_distance(t, box);
    EXPECT_LE(distance, sampled + 1e-9) << n;
    EXPECT_GE(distance, sampled - kGap) << n;
  }
}
}  // namespace
}  // namespace altiplan::mesh::triangles_test
