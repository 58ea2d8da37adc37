// SPDX-License-Identifier: Apache-2.0
// The reference itself: against Dijkstra's algorithm over all pairs of cells that see each other by
// the closed boxes of the blocked ones, and against routes of the planner astar.
#include "reference/visible_cells.hpp"

#include <gtest/gtest.h>

#include "altiplan/route.hpp"
#include "framework/sight_oracle.hpp"
#include "reference/graph.hpp"

namespace altiplan::reference::visible_cells_test {
namespace {

/// All pairs drawn out.
double brute_force(const VoxelGrid& grid, const Cell& start, const Cell& goal) {
  const Cell& counts = grid.spec().counts;
  Graph graph;
  std::vector<Cell> cells;
  const auto add = [&](const Cell& c) {
    if (!grid.blocked(c)) {
      graph.add(grid.spec().centre(c));
      cells.push_back(c);
    }
  };
  for (int k = 0; k < counts[2]; ++k) {
    for (int j = 0; j < counts[1]; ++j) {
      for (int i = 0; i < counts[0]; ++i) {
        add({i, j, k});
      }
    }
  }
  for (std::size_t a = 0; a < cells.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (oracle::sees(grid, cells[a], cells[b])) {
        graph.join(a, b);
        graph.join(b, a);
      }
    }
  }
  const auto number = [&](const Cell& c) {
    return std::size_t(std::find(cells.begin(), cells.end(), c) - cells.begin());
  };
  if (grid.blocked(start) || grid.blocked(goal)) {
    return kInfinity;
  }
  return dijkstra(graph, number(start))[number(goal)];
}

TEST(VisibleCells, EqualAllPairsByTheirClosedBoxesOnTinyMaps) {
  SplitMix64 random(4);
  int straight = 0;
  int bent = 0;
  int cut_off = 0;
  for (int world = 0; world < 300; ++world) {
    GridSpec spec;
    spec.counts = {random.integer(1, 7), random.integer(1, 5), random.integer(1, 4)};
    spec.cell = world % 3 == 0 ? Vec3(10, 20, 5) : Vec3(10, 10, 10);
    VoxelGrid grid(spec);
    const auto draw = [&] {
      const int i = random.integer(0, spec.counts[0] - 1);
      const int j = random.integer(0, spec.counts[1] - 1);
      const int k = random.integer(0, spec.counts[2] - 1);
      return Cell{i, j, k};
    };
    const std::size_t blocked = spec.cell_count() / std::size_t(random.integer(2, 8));
    for (std::size_t n = 0; n < blocked; ++n) {
      grid.set(draw(), true);
    }
    const Cell start = draw();
    const Cell goal = draw();
    const double length = brute_force(grid, start, goal);
    const std::optional<double> found = shortest_visible(grid, start, goal);
    ASSERT_EQ(found.has_value(), length < kInfinity) << world;
    if (!found) {
      ++cut_off;
      continue;
    }
    ASSERT_NEAR(*found, length, 1e-9) << world;
    ++(kit::line_of_sight(grid, start, goal) ? straight : bent);
  }
  EXPECT_GT(straight, 50);
  EXPECT_GT(bent, 20);
  EXPECT_GT(cut_off, 50);
}

TEST(VisibleCells, BendAtTheBestCellBesideAWall) {
  GridSpec spec;
  spec.counts = {9, 9, 3};
  VoxelGrid grid(spec);
  EXPECT_DOUBLE_EQ(*shortest_visible(grid, {0, 4, 1}, {8, 4, 1}), 8);
  for (int k = 0; k < 3; ++k) {
    for (int j = 2; j < 9; ++j) {
      grid.set({4, j, k}, true);
    }
  }
  // Past the wall's end at (4, 1): the legs keep clear of its corners by an eighth of a cell.
  EXPECT_DOUBLE_EQ(*shortest_visible(grid, {0, 4, 1}, {8, 4, 1}), 2 * std::hypot(4, 3));
  for (int k = 0; k < 3; ++k) {
    grid.block_run(4, 4, 0, k);
    grid.block_run(4, 4, 1, k);
  }
  EXPECT_FALSE(shortest_visible(grid, {0, 4, 1}, {8, 4, 1}));
  EXPECT_FALSE(shortest_visible(grid, {0, 4, 1}, {4, 4, 1})) << "a blocked goal";
  EXPECT_EQ(shortest_visible(grid, {0, 4, 1}, {0, 4, 1}), 0);
}

TEST(VisibleCells, AreTheSameBothWaysAndNoLongerThanSteps) {
  const auto astar = testing::make_planner("astar", "{corner: free_box}");
  int solved = 0;
  double shares = 0;  // of the length by steps
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const SmallCity city = small_city(seed);
    const PlanResult result = astar->plan(city.request());
    const std::optional<double> there = shortest_visible(city.grid, city.start, city.goal);
    ASSERT_EQ(there.has_value(), result.status == PlanStatus::solved) << seed;
    if (!there) {
      continue;
    }
    ++solved;
    const double steps = length(result.route);
    EXPECT_NEAR(*there, *shortest_visible(city.grid, city.goal, city.start), 1e-9) << seed;
    EXPECT_GE(*there, city.straight() - 1e-9) << seed;
    EXPECT_LE(*there, steps + 1e-9) << seed;
    shares += *there / steps;
  }
  EXPECT_GE(solved, 9);
  EXPECT_LT(shares / solved, 0.97);
}

TEST(VisibleCells, OfOneLevelDoWhereBuildingsReachTheTop) {
  int bent = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    SmallCity city = small_city(seed, {16, 16, 5});
    const int k = city.start[2];
    city.goal[2] = k;
    for (int j = 0; j < 16; ++j) {
      for (int level = 0; level < 5; ++level) {
        if (level != k) {
          city.grid.free_run(0, 15, j, level);
          city.grid.for_each_run(
              j, k, [&](int first, int last) { city.grid.block_run(first, last, j, level); });
        }
      }
    }
    const auto in_space = shortest_visible(city.grid, city.start, city.goal);
    const auto on_level = shortest_visible(
        level_of(city.grid, k), {city.start[0], city.start[1], 0}, {city.goal[0], city.goal[1], 0});
    ASSERT_EQ(in_space.has_value(), on_level.has_value()) << seed;
    if (in_space) {
      EXPECT_NEAR(*in_space, *on_level, 1e-9) << seed;
      bent += *in_space > city.straight() + 1;
    }
  }
  EXPECT_GT(bent, 4);
}
}  // namespace
}  // namespace altiplan::reference::visible_cells_test
