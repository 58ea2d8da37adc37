// SPDX-License-Identifier: Apache-2.0
#include "altiplan/voxel_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "altiplan/distance_field.hpp"
#include "altiplan/error.hpp"

namespace altiplan::voxel_grid_test {
namespace {

VoxelGrid speckled(const Cell& counts, const Vec3& cell, double share, unsigned seed) {
  GridSpec spec;
  spec.origin = {-3, 7, 0.5};
  spec.cell = cell;
  spec.counts = counts;
  VoxelGrid grid(spec);
  std::mt19937 engine(seed);
  for (int k = 0; k < counts[2]; ++k) {
    for (int j = 0; j < counts[1]; ++j) {
      for (int i = 0; i < counts[0]; ++i) {
        if (double(engine()) < share * 4294967296.0) {
          grid.set({i, j, k}, true);
        }
      }
    }
  }
  return grid;
}

TEST(VoxelGrid, IsFreeInsideABlockedBorder) {
  for (const int nx : {1, 61, 62, 63, 64, 126, 127, 130}) {
    GridSpec spec;
    spec.counts = {nx, 3, 2};
    const VoxelGrid grid(spec);
    EXPECT_EQ(grid.blocked_count(), 0U);
    for (int k = -1; k <= 2; ++k) {
      for (int j = -1; j <= 3; ++j) {
        for (int i = -1; i <= nx; ++i) {
          EXPECT_EQ(grid.blocked(i, j, k), !spec.holds({i, j, k})) << i << ' ' << j << ' ' << k;
        }
      }
    }
  }
}

TEST(VoxelGrid, RunsAreThoseOfItsCells) {
  unsigned seed = 0;
  for (const int nx : {1, 61, 62, 63, 64, 126, 127, 130, 300}) {
    for (const double share : {0.0, 0.02, 0.5, 0.98, 1.0}) {
      const VoxelGrid grid = speckled({nx, 3, 2}, {1, 1, 1}, share, ++seed);
      for (int k = 0; k < 2; ++k) {
        for (int j = 0; j < 3; ++j) {
          std::vector<bool> seen(std::size_t(nx), false);
          int last_end = -2;
          grid.for_each_run(j, k, [&](int first, int last) {
            EXPECT_GT(first, last_end + 1) << "runs that meet are one";
            ASSERT_LE(first, last);
            ASSERT_LT(last, nx);
            std::fill(seen.begin() + first, seen.begin() + last + 1, true);
            last_end = last;
          });
          for (int i = 0; i < nx; ++i) {
            EXPECT_EQ(seen[std::size_t(i)], grid.blocked(i, j, k))
                << nx << ' ' << share << ' ' << i;
          }
        }
      }
    }
  }
}

TEST(VoxelGrid, CopiesABoxAndNoMore) {
  const Cell counts{150, 5, 4};
  const VoxelGrid from = speckled(counts, {1, 1, 1}, 0.5, 1);
  for (const auto& [low, high] : std::vector<std::pair<Cell, Cell>>{{{0, 0, 0}, {149, 4, 3}},
                                                                    {{-3, -1, -1}, {400, 9, 9}},
                                                                    {{62, 1, 1}, {64, 3, 2}},
                                                                    {{7, 2, 0}, {7, 2, 3}},
                                                                    {{127, 0, 1}, {140, 4, 1}},
                                                                    {{9, 1, 1}, {8, 3, 3}},
                                                                    {{150, 0, 0}, {160, 4, 3}}}) {
    const VoxelGrid before = speckled(counts, {1, 1, 1}, 0.5, 2);
    VoxelGrid grid = before;
    grid.copy(from, low, high);
    for (int k = -1; k <= counts[2]; ++k) {
      for (int j = -1; j <= counts[1]; ++j) {
        for (int i = -1; i <= counts[0]; ++i) {
          const bool within = i >= low[0] && i <= high[0] && j >= low[1] && j <= high[1] &&
                              k >= low[2] && k <= high[2];
          EXPECT_EQ(grid.blocked(i, j, k), (within ? from : before).blocked(i, j, k))
              << i << ' ' << j << ' ' << k;
        }
      }
    }
  }
  VoxelGrid other(GridSpec{});
  EXPECT_THROW(other.copy(from, {0, 0, 0}, {1, 1, 1}), Error);
}

TEST(VoxelGrid, BlocksRunsClippedToTheGrid) {
  GridSpec spec;
  spec.counts = {200, 4, 4};
  for (const auto& [first, last] : std::vector<std::pair<int, int>>{
           {-10, -1}, {-5, 0}, {0, 0}, {60, 70}, {62, 63}, {5, 190}, {199, 300}, {200, 300}}) {
    VoxelGrid grid(spec);
    grid.block_run(first, last, 2, 1);
    grid.block_run(first, last, 4, 1);
    for (int i = 0; i < 200; ++i) {
      EXPECT_EQ(grid.blocked(i, 2, 1), i >= first && i <= last) << i;
    }
    const int expected = std::max(0, std::min(last, 199) - std::max(first, 0) + 1);
    EXPECT_EQ(grid.blocked_count(), std::size_t(expected));
  }
}

TEST(VoxelGrid, DiffAndMerge) {
  VoxelGrid a = speckled({70, 9, 5}, {1, 1, 1}, 0.3, 1);
  const VoxelGrid b = speckled({70, 9, 5}, {1, 1, 1}, 0.3, 2);
  std::size_t different = 0;
  for (const Cell& c : VoxelGrid::diff(a, b)) {
    EXPECT_NE(a.blocked(c), b.blocked(c));
    ++different;
  }
  EXPECT_GT(different, 100U);
  VoxelGrid both = a;
  both.merge(b);
  EXPECT_EQ(2 * both.blocked_count(), a.blocked_count() + b.blocked_count() + different);
  EXPECT_EQ(VoxelGrid::diff(both, both).size(), 0U);
  EXPECT_THROW(both.merge(speckled({70, 9, 6}, {1, 1, 1}, 0.3, 2)), Error);
  EXPECT_THROW(a.set({70, 0, 0}, true), Error);
}

TEST(VoxelGrid, CellOfAgreesWithTheCellsFaces) {
  GridSpec spec;
  spec.origin = {0.1, -1234.7, 1e5};
  spec.cell = {0.1, 0.3, 1.0 / 3};
  spec.counts = {500, 500, 500};
  for (int i = -5; i < 505; ++i) {
    const Box box = spec.cell_box({i, i, i});
    EXPECT_EQ(spec.cell_of(box.min), (Cell{i, i, i}));
    EXPECT_EQ(spec.cell_of(spec.centre({i, i, i})), (Cell{i, i, i}));
  }
  EXPECT_FALSE(spec.holds(spec.cell_of({1e300, 0, 0})));
}

TEST(DistanceField, EqualsBruteForce) {
  for (const double share : {0.002, 0.05}) {
    const VoxelGrid grid = speckled({17, 12, 9}, {1, 2.5, 0.4}, share, 3);
    const DistanceField field(grid);
    const GridSpec& spec = grid.spec();
    std::vector<Cell> blocked;
    VoxelGrid none(spec);
    blocked = VoxelGrid::diff(grid, none);
    ASSERT_FALSE(blocked.empty());
    std::mt19937 engine(5);
    for (int n = 0; n < 1000; ++n) {
      const Cell c{int(engine() % 17), int(engine() % 12), int(engine() % 9)};
      double nearest = kInfinity;
      for (const Cell& b : blocked) {
        nearest = std::min(nearest, (spec.centre(b) - spec.centre(c)).norm());
      }
      EXPECT_NEAR(field.centre_distance(c), nearest, 1e-6 * nearest);
      const Vec3 p = spec.cell_box(c).min + spec.cell.cwiseProduct(Vec3(0.9, 0.2, 0.6));
      double to_box = kInfinity;
      for (const Cell& b : blocked) {
        const Box box = spec.cell_box(b);
        to_box = std::min(to_box, (p - p.cwiseMax(box.min).cwiseMin(box.max)).norm());
      }
      EXPECT_LE(field.clearance(p), to_box);
      EXPECT_GE(field.clearance(p), to_box - 2 * spec.cell.norm());
    }
  }
}

TEST(DistanceField, CutOffEmptyAndOutside) {
  GridSpec spec;
  spec.counts = {40, 3, 3};
  VoxelGrid grid(spec);
  EXPECT_EQ(DistanceField(grid).centre_distance({5, 1, 1}), kInfinity);
  grid.set({0, 1, 1}, true);
  EXPECT_EQ(DistanceField(grid, 10).centre_distance({35, 1, 1}), 10);
  EXPECT_EQ(DistanceField(grid, 10).centre_distance({4, 1, 1}), 4);
  EXPECT_EQ(DistanceField(grid).clearance({-1, 0, 0}), 0);
}
}  // namespace
}  // namespace altiplan::voxel_grid_test
