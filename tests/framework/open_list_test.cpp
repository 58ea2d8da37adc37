// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/open_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <queue>
#include <tuple>
#include <vector>

#include "altiplan/random.hpp"

namespace altiplan::kit::open_list_test {
namespace {

TEST(OpenList, ComesOutSortedInEveryOrderOfPushes) {
  SplitMix64 random(1);
  std::vector<OpenList::Entry> entries;
  for (std::uint32_t node = 0; node < 5000; ++node) {
    entries.push_back({double(random.integer(0, 40)), double(random.integer(0, 9)), node});
  }
  auto sorted = entries;
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.f, -a.g, a.node) < std::tuple(b.f, -b.g, b.node);
  });
  OpenList open;
  for (int order = 0; order < 3; ++order) {
    open.clear(1);
    for (const auto& entry : entries) {
      open.push(entry.f, entry.g, entry.node);
    }
    for (const auto& expected : sorted) {
      ASSERT_EQ(open.top().node, expected.node);
      ASSERT_EQ(open.pop().node, expected.node);
    }
    EXPECT_TRUE(open.empty());
    for (std::size_t i = entries.size() - 1; i > 0; --i) {
      std::swap(entries[i], entries[std::size_t(random.integer(0, int(i)))]);
    }
  }
}

TEST(OpenList, MixedPushesAndPopsGiveTheLeast) {
  SplitMix64 random(2);
  OpenList open;
  open.clear(1e-9);
  std::vector<double> inside;
  for (int turn = 0; turn < 20000; ++turn) {
    if (inside.empty() || random.uniform() < 0.55) {
      inside.push_back(random.uniform());
      open.push(inside.back(), 0, std::uint32_t(turn));
    } else {
      const auto least = std::min_element(inside.begin(), inside.end());
      ASSERT_NEAR(open.pop().f, *least * 1e9, 1);
      inside.erase(least);
    }
  }
}

TEST(OpenList, ManyEntriesComeOutInOrder) {
  using Key = std::tuple<double, double, std::uint32_t>;
  for (const int values : {1, 3, 300, 1'000'000'000}) {  // with fewer, more are equal
    SplitMix64 random(3);
    OpenList open;
    open.clear(1);
    std::priority_queue<Key, std::vector<Key>, std::greater<>> expected;
    double least = 0;
    for (std::uint32_t turn = 0; turn < 300'000 || !expected.empty(); ++turn) {
      if (turn < 300'000 && (expected.empty() || random.uniform() < 0.6)) {
        // As in a search: most are after the last one popped, some before it.
        const double f = std::max(0.0, least + random.integer(-1, values));
        const double g = random.integer(0, 5);
        open.push(f, g, turn);
        expected.emplace(f, -g, turn);
      } else {
        const auto [f, minus_g, node] = expected.top();
        expected.pop();
        ASSERT_EQ(open.top().node, node);
        ASSERT_EQ(open.pop().f, f);
        least = f;
      }
      ASSERT_EQ(open.size(), expected.size());
    }
  }
}

TEST(OpenList, RoundingDoesNotBreakTies) {
  OpenList open;
  open.clear(1e-9);
  open.push(0.1 + 0.2, 1, 1);  // one bit above 0.3
  open.push(0.3, 0.5, 2);
  EXPECT_EQ(open.pop().node, 1u);
}
}  // namespace
}  // namespace altiplan::kit::open_list_test
