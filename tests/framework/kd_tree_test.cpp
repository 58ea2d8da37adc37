// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/kd_tree.hpp"

#include <gtest/gtest.h>

#include "altiplan/random.hpp"

namespace altiplan::kit {
namespace {

TEST(KdTree, EqualsBruteForceAfterEveryInsert) {
  SplitMix64 random(4);
  KdTree tree;
  EXPECT_EQ(tree.nearest({0, 0, 0}), KdTree::kNone);
  std::vector<Vec3> points;
  std::vector<std::size_t> found;
  for (std::size_t n = 0; n < 1500; ++n) {
    // A coarse raster: many points coincide or are equally far.
    const auto draw = [&] { return double(random.integer(0, n % 2 == 0 ? 7 : 1000)); };
    points.emplace_back(draw(), draw(), draw() / 4);
    ASSERT_EQ(tree.insert(points.back()), n);
    const Vec3 p(draw(), draw(), draw() / 4);
    const double radius = 1 + double(random.integer(0, 200));
    std::size_t best = 0;
    std::vector<std::size_t> expected;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if ((points[i] - p).squaredNorm() < (points[best] - p).squaredNorm()) {
        best = i;
      }
      if ((points[i] - p).squaredNorm() <= radius * radius) {
        expected.push_back(i);
      }
    }
    ASSERT_EQ(tree.nearest(p), best);
    tree.within(p, radius, found);
    ASSERT_EQ(found, expected);
  }
  tree.clear();
  EXPECT_EQ(tree.size(), 0u);
  EXPECT_EQ(tree.nearest({0, 0, 0}), KdTree::kNone);
}
}  // namespace
}  // namespace altiplan::kit
