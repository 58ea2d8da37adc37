// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/sampling/point_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "altiplan/random.hpp"

namespace altiplan::kit::point_grid_test {
namespace {

std::size_t nearest_of(const std::vector<Vec3>& points, const std::vector<bool>& out,
                       const Vec3& p) {
  std::size_t best = PointGrid::kNone;
  double least = kInfinity;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!out[i] && (points[i] - p).squaredNorm() < least) {
      least = (points[i] - p).squaredNorm();
      best = i;
    }
  }
  return best;
}

/// Against a look at every point, while the points grow in number.
void compare(const Box& box, const Vec3& crowd, std::size_t count, double radius) {
  RandomStream random(5);
  PointGrid grid;
  std::vector<Vec3> points;
  std::vector<bool> out;
  std::vector<std::uint32_t> found;
  EXPECT_EQ(grid.nearest(box.min), PointGrid::kNone);
  for (std::size_t n = 0; n < count; ++n) {
    Vec3 p = random.in(box);
    if (n % 3 == 0) {
      p = crowd + 1e-3 * (p - crowd);
    } else if (n % 7 == 0) {
      p = points[n / 2];  // the same place twice
    }
    points.push_back(p);
    out.push_back(false);
    ASSERT_EQ(grid.insert(p), n);
    if (n == count / 2) {
      grid.forget_if([](std::size_t number) { return number % 5 == 0; });
      for (std::size_t i = 0; i < points.size(); i += 5) {
        out[i] = true;
      }
    }
    if (n % 9 != 0) {
      continue;
    }
    const Vec3 q = n % 2 == 0 ? random.in(box.grown(radius)) : points[n / 3];
    ASSERT_EQ(grid.nearest(q), nearest_of(points, out, q)) << n;
    grid.within(q, radius, found);
    std::sort(found.begin(), found.end());
    std::vector<std::uint32_t> expected;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!out[i] && (points[i] - q).squaredNorm() <= radius * radius) {
        expected.push_back(std::uint32_t(i));
      }
    }
    ASSERT_EQ(found, expected) << n;
  }
}

TEST(PointGrid, AnswersAsALookAtEveryPoint) {
  compare({{0, 0, 0}, {80, 80, 100}}, {5, 5, 5}, 6000, 7);
  compare({{0, 0, 0}, {80, 80, 100}}, {5, 5, 5}, 1500, 0.01);
}

TEST(PointGrid, AlsoOnALevelAndFarFromTheOrigin) {
  compare({{500'000, 4'649'776, 300}, {530'000, 4'680'000, 300}}, {510'000, 4'650'000, 300}, 4000,
          900);
  compare({{-9e6, 2e6, -40}, {-9e6 + 20'000, 2e6 + 300, 2500}}, {-9e6, 2e6, 0}, 3000, 200);
}

TEST(PointGrid, AndWhereAllPointsAreOne) { compare({{3, 3, 3}, {3, 3, 3}}, {3, 3, 3}, 1300, 1); }
}  // namespace
}  // namespace altiplan::kit::point_grid_test
