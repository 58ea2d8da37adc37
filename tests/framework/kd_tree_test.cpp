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
  // Every third is taken out, every ninth put back.
  const auto in = [](std::size_t i) { return i % 3 != 0 || i % 9 == 0; };
  for (std::size_t i = 0; i < points.size(); i += 3) {
    tree.erase(i);
  }
  for (std::size_t i = 0; i < points.size(); i += 9) {
    tree.restore(i);
  }
  for (int n = 0; n < 300; ++n) {
    const auto draw = [&] { return double(random.integer(0, 1000)); };
    const Vec3 p(draw(), draw(), draw() / 4);
    const Vec3 q(draw(), draw(), draw() / 4);
    const double q_weight = random.integer(0, 3) / 2.0;
    const Box box = Box::empty().with(p).with(q);
    std::size_t nearest = KdTree::kNone;
    std::size_t least_sum = KdTree::kNone;
    double distance = kInfinity;
    double sum = kInfinity;
    std::vector<std::size_t> inside;
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(tree.contains(i), in(i));
      if (!in(i)) {
        continue;
      }
      const double to_p = (points[i] - p).norm();
      const double both = to_p + q_weight * (points[i] - q).norm();
      if ((points[i] - p).squaredNorm() < distance) {
        distance = (points[i] - p).squaredNorm();
        nearest = i;
      }
      if (both < sum) {
        sum = both;
        least_sum = i;
      }
      if (box.contains(points[i])) {
        inside.push_back(i);
      }
    }
    EXPECT_EQ(tree.nearest(p), nearest);
    EXPECT_EQ(tree.least_sum(p, 1, q, q_weight), least_sum);
    tree.within(box, found);
    EXPECT_EQ(found, inside);
  }
  tree.clear();
  EXPECT_EQ(tree.size(), 0u);
  EXPECT_EQ(tree.nearest({0, 0, 0}), KdTree::kNone);
}
}  // namespace
}  // namespace altiplan::kit
