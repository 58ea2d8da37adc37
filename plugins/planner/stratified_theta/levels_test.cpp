// SPDX-License-Identifier: Apache-2.0
#include "levels.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "corridor.hpp"
#include "reference/paper_cities.hpp"
#include "reference/random_levels.hpp"

namespace altiplan::stratified::levels_test {
namespace {

VoxelGrid empty(const Cell& counts) {
  GridSpec spec;
  spec.counts = counts;
  return VoxelGrid(spec);
}

std::size_t nodes_of(int number, const Cell& counts) {
  const VoxelGrid grid = empty(counts);
  Level level(number, grid);
  level.add_all();
  return level.node_count();
}

TEST(Levels, HaveTheNodesOfThePaper) {
  EXPECT_EQ(nodes_of(3, {80, 80, 1}), 25u);
  EXPECT_EQ(nodes_of(3, {80, 80, 100}), 125u);
  EXPECT_EQ(nodes_of(4, {80, 80, 1}), 81u);
  EXPECT_EQ(nodes_of(4, {80, 80, 100}), 729u);
  EXPECT_EQ(finest_level({80, 80, 100}), 7);
  EXPECT_EQ(finest_level({65, 1, 1}), 7);
  EXPECT_EQ(finest_level({64, 1, 1}), 6);
  EXPECT_EQ(rows_of(9, 5), (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(rows_of(3, 80), (std::vector<int>{0, 20, 40, 59, 79}));
}

/// Figure 4 of the paper: 6 nodes of a route and 29 successors.
TEST(Levels, SomeRouteOfSixNodesHasASetOf35) {
  const VoxelGrid grid = empty({80, 80, 1});
  const Level coarse(3, grid);
  std::set<std::size_t> sizes;
  // Every path of six different nodes, each adjacent to the previous, sufficient up to symmetry.
  const std::function<void(std::vector<Cell>&)> extend = [&](std::vector<Cell>& way) {
    if (way.size() == 6) {
      Level fine(4, grid);
      for (const Cell& key : way) {
        fine.add_around(coarse.place(key));
      }
      sizes.insert(fine.node_count());
      return;
    }
    for (const int d : {9, 10, 11, 12, 14, 15, 16, 17}) {
      const Cell o = kit::offset(d);
      const Cell next = {way.back()[0] + o[0], way.back()[1] + o[1], 0};
      if (next[0] >= 0 && next[1] >= 0 && next[0] < 5 && next[1] < 5 &&
          std::find(way.begin(), way.end(), next) == way.end()) {
        way.push_back(next);
        extend(way);
        way.pop_back();
      }
    }
  };
  std::vector<Cell> way = {{0, 0, 0}};
  extend(way);
  EXPECT_TRUE(sizes.contains(35));
}

TEST(Levels, CertainSharesAreThoseOfACount) {
  SplitMix64 random(3);
  for (int round = 0; round < 60; ++round) {
    const Cell counts = {random.integer(1, 30), random.integer(1, 25), random.integer(1, 20)};
    VoxelGrid grid = empty(counts);
    for (int n = random.integer(0, 12); n > 0; --n) {
      const int i = random.integer(0, counts[0] - 1);
      const int j = random.integer(0, counts[1] - 1);
      const int k = random.integer(0, counts[2] - 1);
      grid.block_run(i, i + 4, j, k);
    }
    for (int level = 1; level <= 6; ++level) {
      std::array<std::vector<int>, 3> e;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        e[axis] = block_edges(level, counts[axis]);
      }
      int blocks = 0;
      int certain = 0;
      for (std::size_t z = 0; z + 1 < e[2].size(); ++z) {
        for (std::size_t y = 0; y + 1 < e[1].size(); ++y) {
          for (std::size_t x = 0; x + 1 < e[0].size(); ++x) {
            bool any_free = false;
            bool any_blocked = false;
            for (int k = e[2][z]; k < e[2][z + 1]; ++k) {
              for (int j = e[1][y]; j < e[1][y + 1]; ++j) {
                for (int i = e[0][x]; i < e[0][x + 1]; ++i) {
                  (grid.blocked(i, j, k) ? any_blocked : any_free) = true;
                }
              }
            }
            ++blocks;
            certain += any_free != any_blocked;
          }
        }
      }
      EXPECT_DOUBLE_EQ(certain_share(level, grid), double(certain) / blocks) << round;
    }
  }
}

TEST(Levels, LeastLevelsOfThePapersCities) {
  for (const bool complex : {false, true}) {
    std::map<int, int> levels;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const Request request = testing::in_city(complex, seed);
      const kit::Lattice lattice(request, {10, 10, 10}, kit::Neighbourhood::all, {});
      ++levels[min_level(*kit::occupancy(request, lattice), 0.25)];
    }
    EXPECT_EQ(levels, complex ? (std::map<int, int>{{4, 6}, {5, 194}})
                              : (std::map<int, int>{{2, 40}, {3, 160}}));
  }
}

TEST(Levels, AChainIsConnectedAndNearItsRoute) {
  SplitMix64 random(4);
  const VoxelGrid grid = empty({80, 80, 100});
  for (int round = 0; round < 200; ++round) {
    const Level level(random.integer(2, 7), grid);
    Polyline route;
    for (int n = random.integer(1, 5); n >= 0; --n) {
      const double x = random.uniform() * 80;
      const double y = random.uniform() * 80;
      const double z = random.uniform() * 100;
      route.emplace_back(x, y, z);
    }
    const std::vector<Cell> keys = chain(level, route, grid.spec());
    for (std::size_t n = 1; n < keys.size(); ++n) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        // Rows are not exactly evenly spaced, so a step may skip one.
        EXPECT_LE(std::abs(keys[n][axis] - keys[n - 1][axis]), 2) << round;
      }
    }
  }
}

TEST(Corridor, LeadsOverBlocksWithRoomAndHoldsFreeCellsAlone) {
  SplitMix64 random(5);
  int found = 0;
  for (int round = 0; round < 20; ++round) {
    testing::Drawn drawn = testing::draw(testing::random_levels(random, 40, 33, 20, 0.3));
    const kit::Lattice lattice(drawn.request, {1, 1, 1}, kit::Neighbourhood::all, {});
    const VoxelGrid& cells = *kit::occupancy(drawn.request, lattice);
    const Blocks blocks(cells);
    const Cell from = lattice.nearest(drawn.request.start.position).cell;
    const Cell to = lattice.nearest(drawn.request.goal.position).cell;
    const std::vector<Cell> way = blocks.way(from, to);
    ASSERT_FALSE(way.empty());
    EXPECT_EQ(way.back(), (Cell{from[0] / 8, from[1] / 8, from[2] / 8}));
    EXPECT_EQ(way.front(), (Cell{to[0] / 8, to[1] / 8, to[2] / 8}));
    const VoxelGrid corridor = blocks.corridor(way, 0);
    for (const Cell& c : VoxelGrid::diff(corridor, cells)) {
      EXPECT_TRUE(corridor.blocked(c));
      EXPECT_EQ(std::find(way.begin(), way.end(), Cell{c[0] / 8, c[1] / 8, c[2] / 8}), way.end());
    }
    found += blocks.corridor(way, 5).blocked_count() == cells.blocked_count();
  }
  EXPECT_EQ(found, 20);
}
}  // namespace
}  // namespace altiplan::stratified::levels_test
