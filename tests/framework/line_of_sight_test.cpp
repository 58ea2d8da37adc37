// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/line_of_sight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "altiplan/kit/lattice/free_blocks.hpp"
#include "altiplan/random.hpp"
#include "framework/sight_oracle.hpp"

namespace altiplan::kit::line_of_sight_test {
namespace {

using oracle::meets;

std::set<Cell> walked(const Cell& a, const Cell& b) {
  std::set<Cell> cells;
  walk_cells(a, b, [&](const Cell& c) {
    EXPECT_TRUE(cells.insert(c).second) << "visited twice";
    return true;
  });
  return cells;
}

TEST(LineOfSight, WalksExactlyTheCellsThatTheSegmentMeets) {
  SplitMix64 random(3);
  for (int n = 0; n < 1500; ++n) {
    const int reach = n % 3 == 0 ? 3 : 9;
    const auto draw = [&] { return random.integer(0, reach); };
    const Cell a = {draw(), draw(), draw()};
    const Cell b = {draw(), draw(), n % 4 == 0 ? a[2] : draw()};
    const std::set<Cell> cells = walked(a, b);
    for (int k = -1; k <= reach + 1; ++k) {
      for (int j = -1; j <= reach + 1; ++j) {
        for (int i = -1; i <= reach + 1; ++i) {
          ASSERT_EQ(cells.count({i, j, k}) == 1, meets(a, b, {i, j, k}));
        }
      }
    }
    ASSERT_EQ(cells, walked(b, a));
  }
}

TEST(LineOfSight, IsSymmetricAndMeetsNoClosedBoxOfABlockedCell) {
  SplitMix64 random(12);
  int free = 0;
  for (int world = 0; world < 100; ++world) {
    GridSpec spec;
    for (int& count : spec.counts) {
      count = random.integer(1, 16);
    }
    VoxelGrid grid(spec);
    const auto draw = [&] {
      const int i = random.integer(0, spec.counts[0] - 1);
      const int j = random.integer(0, spec.counts[1] - 1);
      const int k = random.integer(0, spec.counts[2] - 1);
      return Cell{i, j, k};
    };
    const std::size_t blocked = spec.cell_count() / std::size_t(random.integer(10, 100));
    for (std::size_t n = 0; n < blocked; ++n) {
      grid.set(draw(), true);
    }
    for (int n = 0; n < 100; ++n) {
      const Cell a = draw();
      const Cell b = draw();
      const bool seen = oracle::sees(grid, a, b);
      ASSERT_EQ(line_of_sight(grid, a, b), seen);
      ASSERT_EQ(line_of_sight(grid, b, a), seen);
      free += seen;
    }
  }
  EXPECT_GT(free, 2000);
  EXPECT_LT(free, 8000);
}

TEST(LineOfSight, TouchingACornerIsEnoughToBlock) {
  GridSpec spec;
  spec.counts = {4, 4, 4};
  VoxelGrid grid(spec);
  EXPECT_TRUE(line_of_sight(grid, {0, 0, 0}, {3, 3, 3}));
  grid.set({2, 1, 1}, true);  // shares a corner with the diagonal
  EXPECT_FALSE(line_of_sight(grid, {0, 0, 0}, {3, 3, 3}));
  EXPECT_FALSE(line_of_sight(grid, {3, 3, 3}, {0, 0, 0}));
  EXPECT_TRUE(line_of_sight(grid, {0, 0, 0}, {0, 0, 0}));
  EXPECT_FALSE(line_of_sight(grid, {2, 1, 1}, {2, 1, 1}));
}

TEST(LineOfSight, SeesWhatTheWalkSees) {
  SplitMix64 random(9);
  int free = 0;
  for (int world = 0; world < 40; ++world) {
    GridSpec spec;
    for (int& count : spec.counts) {
      count = random.integer(1, world % 4 == 0 ? 200 : 40);
    }
    VoxelGrid grid(spec);
    const auto draw = [&] {
      return Cell{random.integer(0, spec.counts[0] - 1), random.integer(0, spec.counts[1] - 1),
                  random.integer(0, spec.counts[2] - 1)};
    };
    const std::size_t blocked = spec.cell_count() / std::size_t(random.integer(10, 150));
    for (std::size_t n = 0; n < blocked; ++n) {
      grid.set(draw(), true);
    }
    for (int n = 0; n < 3000; ++n) {
      const Cell a = draw();
      Cell b = draw();
      if (n % 2 == 0) {  // short, often through edges and corners
        for (std::size_t axis = 0; axis < 3; ++axis) {
          b[axis] = std::clamp(a[axis] + random.integer(-6, 6), 0, spec.counts[axis] - 1);
        }
      }
      const bool walked = walk_cells(a, b, [&](const Cell& c) { return !grid.blocked(c); });
      ASSERT_EQ(line_of_sight(grid, a, b), walked);
      free += walked;
    }
  }
  EXPECT_GT(free, 20000);
  EXPECT_LT(free, 100000);
}

TEST(LineOfSight, EveryCellOfALegCounts) {
  SplitMix64 random(10);
  GridSpec spec;
  spec.counts = {70, 12, 12};
  VoxelGrid grid(spec);
  for (int n = 0; n < 300; ++n) {
    const auto draw = [&] {
      return Cell{random.integer(0, 69), random.integer(0, 11), random.integer(0, 11)};
    };
    const Cell a = draw();
    const Cell b = draw();
    ASSERT_TRUE(line_of_sight(grid, a, b));
    walk_cells(a, b, [&](const Cell& c) {
      grid.set(c, true);
      EXPECT_FALSE(line_of_sight(grid, a, b));
      grid.set(c, false);
      return true;
    });
  }
}

TEST(LineOfSight, OnALevelItIsTheSame) {
  SplitMix64 random(15);
  int free = 0;
  for (int world = 0; world < 60; ++world) {
    GridSpec spec;
    spec.counts = {random.integer(1, 260), random.integer(1, 90), 2};
    VoxelGrid grid(spec);
    const auto draw = [&] {
      const int i = random.integer(0, spec.counts[0] - 1);
      return Cell{i, random.integer(0, spec.counts[1] - 1), 1};
    };
    for (std::size_t n = spec.cell_count() / std::size_t(random.integer(20, 400)); n > 0; --n) {
      grid.set(draw(), true);
    }
    grid.set({0, 0, 0}, true);
    for (int n = 0; n < 2000; ++n) {
      const Cell a = draw();
      Cell b = draw();
      if (n % 2 == 0) {
        b[0] = std::clamp(a[0] + random.integer(-9, 9), 0, spec.counts[0] - 1);
        b[1] = std::clamp(a[1] + random.integer(-9, 9), 0, spec.counts[1] - 1);
      }
      const bool seen = line_of_sight(grid, a, b);
      ASSERT_EQ(level_line_of_sight(grid, a, b), seen);
      free += seen;
    }
  }
  EXPECT_GT(free, 20000);
  EXPECT_LT(free, 110000);
}

TEST(LineOfSight, ThroughFreeBlocksIsTheSame) {
  SplitMix64 random(13);
  int seen = 0;
  for (int world = 0; world < 60; ++world) {
    GridSpec spec;
    for (int& count : spec.counts) {
      count = random.integer(1, 90);
    }
    const auto grid = std::make_shared<VoxelGrid>(spec);
    const auto draw = [&] {
      const int i = random.integer(0, spec.counts[0] - 1);
      const int j = random.integer(0, spec.counts[1] - 1);
      const int k = random.integer(0, spec.counts[2] - 1);
      return Cell{i, j, k};
    };
    for (int n = random.integer(0, 60); n > 0; --n) {
      const Cell c = draw();
      grid->block_run(c[0], c[0] + random.integer(0, 4), c[1], c[2]);
    }
    FreeBlocks blocks;
    blocks.prepare(grid);
    for (int n = 0; n < 1000; ++n) {
      const Cell a = draw();
      const Cell b = draw();
      const bool sees = line_of_sight(*grid, a, b);
      ASSERT_EQ(blocks.line_of_sight(a, b), sees) << world;
      seen += sees;
    }
  }
  EXPECT_GT(seen, 20000);
  EXPECT_LT(seen, 55000);
}
}  // namespace
}  // namespace altiplan::kit::line_of_sight_test
