// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/sampling/leg_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "altiplan/random.hpp"

namespace altiplan::kit::leg_tree_test {
namespace {

TEST(LegTree, GoesFromTheRootToANode) {
  LegTree tree;
  const auto root = tree.add({0, 0, 0}, LegTree::kNone);
  const auto low = tree.add({1, 0, 0}, root);
  const auto high = tree.add({2, 0, 0}, low);
  EXPECT_EQ(tree.way_to(high), (Route{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
  tree.move(high, root);
  EXPECT_EQ(tree.way_to(high), (Route{{0, 0, 0}, {2, 0, 0}}));
  tree.move(low, LegTree::kNone);
  EXPECT_EQ(tree.way_to(low), (Route{{1, 0, 0}}));
}

// Against a list of parents alone.
TEST(LegTree, KeepsItsLinksThroughRandomMoves) {
  SplitMix64 random(7);
  LegTree tree;
  std::vector<LegTree::Node> parents;
  std::vector<LegTree::Node> below;
  const auto is_below = [&](LegTree::Node node, LegTree::Node top) {
    while (node != LegTree::kNone && node != top) {
      node = parents[std::size_t(node)];
    }
    return node == top;
  };
  for (int n = 0; n < 3000; ++n) {
    const auto any = [&] { return LegTree::Node(random.integer(-1, int(parents.size()) - 1)); };
    if (parents.size() < 60 || random.integer(0, 20) == 0) {
      parents.push_back(any());
      tree.add({double(n), 0, 0}, parents.back());
    } else {
      const LegTree::Node node = std::max(0, any());
      const LegTree::Node parent = any();
      if (parent == LegTree::kNone || !is_below(parent, node)) {
        parents[std::size_t(node)] = parent;
        tree.move(node, parent);
      }
    }
    const LegTree::Node top = std::max(0, any());
    tree.below(top, below);
    ASSERT_EQ(below.front(), top);
    std::sort(below.begin(), below.end());
    std::vector<LegTree::Node> expected;
    for (LegTree::Node i = 0; i < LegTree::Node(parents.size()); ++i) {
      ASSERT_EQ(tree.parent(i), parents[std::size_t(i)]);
      if (is_below(i, top)) {
        expected.push_back(i);
      }
    }
    ASSERT_EQ(below, expected);
  }
}
}  // namespace
}  // namespace altiplan::kit::leg_tree_test
