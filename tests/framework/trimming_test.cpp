// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numeric>

#include "altiplan/kit/smoothing/trimming.hpp"
#include "altiplan/random.hpp"

namespace altiplan::kit::trimming_test {
namespace {

std::vector<int> numbered(int count) {
  std::vector<int> nodes(std::size_t(count), 0);
  std::iota(nodes.begin(), nodes.end(), 0);
  return nodes;
}

TEST(Trimming, StridesOfThePaper) {
  EXPECT_EQ(TrimParams().strides(), (std::vector<std::size_t>{10, 8, 6, 5, 4}));
  TrimParams slow;
  slow.longest_stride = 4;
  slow.shortest_stride = 2;
  slow.decay = 0.95;
  EXPECT_EQ(slow.strides(), (std::vector<std::size_t>{4, 3, 2}));
  slow.shortest_stride = 4;
  EXPECT_EQ(slow.strides(), (std::vector<std::size_t>{4}));
}

TEST(Trimming, InTheOpenEveryStrideIsTaken) {
  std::vector<int> nodes = numbered(24);
  trim(nodes, 10, [](std::size_t, std::size_t) { return true; });
  EXPECT_EQ(nodes, (std::vector<int>{0, 10, 20, 23}));
}

TEST(Trimming, WhereNothingIsFreeEveryNodeStays) {
  for (const int count : {0, 1, 2, 3, 30}) {
    std::vector<int> nodes = numbered(count);
    trim(nodes, 4, [](std::size_t, std::size_t) { return false; });
    EXPECT_EQ(nodes, numbered(count));
  }
}

TEST(Trimming, AStrideRefusedMovesOnByOneNode) {
  // No leg may pass over node 5.
  std::vector<int> nodes = numbered(12);
  trim(nodes, 4,
       [&](std::size_t from, std::size_t to) { return !(nodes[from] < 5 && nodes[to] > 5); });
  EXPECT_EQ(nodes, (std::vector<int>{0, 4, 5, 9, 11}));
}

TEST(Trimming, TellsWhichNodesTheLegWouldLieBetween) {
  RandomStream random(7);
  for (int trial = 0; trial < 500; ++trial) {
    const int count = int(random.integer(2, 60));
    std::vector<int> nodes = numbered(count);
    int last_from = -1;
    trim(nodes, std::size_t(random.integer(2, 12)), [&](std::size_t from, std::size_t to) {
      EXPECT_GT(nodes[from], last_from);  // each node that stays is asked for once, in order
      last_from = nodes[from];
      EXPECT_EQ(nodes[to], int(to));  // from there on all is as it was
      EXPECT_TRUE(from == 0 || nodes[from - 1] < nodes[from]);
      EXPECT_GT(to, from + 1);
      return random.uniform() < 0.5;
    });
    EXPECT_EQ(nodes.front(), 0);
    EXPECT_EQ(nodes.back(), count - 1);
    EXPECT_TRUE(std::is_sorted(nodes.begin(), nodes.end()));
  }
}
}  // namespace
}  // namespace altiplan::kit::trimming_test
