// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "altiplan/kit/lattice/line_of_sight.hpp"
#include "altiplan/kit/layers/cell_layer.hpp"
#include "altiplan/random.hpp"
#include "support/support.hpp"

// The exact shortest route among the centres of free cells, any two of them joined that see each
// other: what an any-angle search over cells can reach at best. Cells in space have no few corners
// that a route must bend at, so every free cell is a node, and all pairs are drawn out as the
// search comes to them. For small maps: O(cells) lines of sight a node.
namespace altiplan::reference {

/// A* over the free cells with the straight line as its estimate.
class VisibleCells {
 public:
  VisibleCells(const VoxelGrid& grid, const Cell& start, const Cell& goal)
      : grid_(grid), goal_(grid.spec().centre(goal)) {
    const Cell& counts = grid.spec().counts;
    for (int k = 0; k < counts[2]; ++k) {
      for (int j = 0; j < counts[1]; ++j) {
        for (int i = 0; i < counts[0]; ++i) {
          const Cell c = {i, j, k};
          if (!grid.blocked(c)) {
            add(c, c == start, c == goal);
          }
        }
      }
    }
  }

  /// Metres; infinite where there is no route.
  double shortest() {
    if (at_start_ == kNone || at_goal_ == kNone) {
      return kInfinity;
    }
    nodes_[at_start_].g = 0;
    open_.insert({nodes_[at_start_].h, at_start_});
    while (!open_.empty()) {
      const std::size_t here = open_.begin()->second;
      open_.erase(open_.begin());
      if (here == at_goal_) {
        break;
      }
      nodes_[here].closed = true;
      expand(here);
    }
    return nodes_[at_goal_].g;
  }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};
  struct Node {
    Cell cell;
    Vec3 centre;
    double h;  ///< straight to the goal: what the way on takes at least
    double g = kInfinity;
    bool closed = false;
  };

  void add(const Cell& c, bool is_start, bool is_goal) {
    const Vec3 centre = grid_.spec().centre(c);
    at_start_ = is_start ? nodes_.size() : at_start_;
    at_goal_ = is_goal ? nodes_.size() : at_goal_;
    nodes_.push_back({c, centre, (goal_ - centre).norm()});
  }

  /// What cannot be shorter is not looked at: most cells that `here` sees, its parent saw too.
  void expand(std::size_t here) {
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      Node& next = nodes_[n];
      if (next.closed) {
        continue;
      }
      const double g = nodes_[here].g + (next.centre - nodes_[here].centre).norm();
      if (g < next.g && g + next.h <= nodes_[at_goal_].g &&
          kit::line_of_sight(grid_, nodes_[here].cell, next.cell)) {
        open_.erase({next.g + next.h, n});
        next.g = g;
        open_.insert({next.g + next.h, n});
      }
    }
  }

  const VoxelGrid& grid_;
  Vec3 goal_;
  std::vector<Node> nodes_;
  std::size_t at_start_ = kNone;
  std::size_t at_goal_ = kNone;
  std::set<std::pair<double, std::size_t>> open_;
};

/// Length in metres of the shortest route from centre to centre whose legs `kit::line_of_sight`
/// passes, bending at centres of free cells; nothing where there is none.
inline std::optional<double> shortest_visible(const VoxelGrid& grid, const Cell& start,
                                              const Cell& goal) {
  const double length = VisibleCells(grid, start, goal).shortest();
  return length < kInfinity ? std::optional(length) : std::nullopt;
}

/// One level of the cells as a grid of its own. Where all that blocks it goes from the ground up to
/// some height, and nothing else is below that, no way between two of its cells that stays below is
/// shorter in space than on the level. So cities far too large for all pairs of cells do, where a
/// way over their roofs is longer than the answer.
inline VoxelGrid level_of(const VoxelGrid& grid, int k) {
  GridSpec spec = grid.spec();
  spec.origin.z() += k * spec.cell.z();
  spec.counts[2] = 1;
  VoxelGrid level(spec);
  for (int j = 0; j < spec.counts[1]; ++j) {
    grid.for_each_run(j, k, [&](int first, int last) { level.block_run(first, last, j, 0); });
  }
  return level;
}

/// Buildings anywhere on the ground, some as high as the volume, and a low way across, from one
/// side to the other. The class of paper 003's complex city, small enough for all pairs of cells.
struct SmallCity {
  VoxelGrid grid;
  Cell start;
  Cell goal;

  double straight() const { return (grid.spec().centre(goal) - grid.spec().centre(start)).norm(); }
  Request request() const {
    const GridSpec& spec = grid.spec();
    return testing::request_in(testing::world_of(std::make_shared<kit::CellLayer>(grid)),
                               spec.centre(start), spec.centre(goal), spec.box());
  }
};

/// The same seed, the same city. Start and goal are free; a way between them is likely, not sure.
inline SmallCity small_city(std::uint64_t seed, const Cell& counts = {24, 24, 12}) {
  GridSpec spec;
  spec.cell = Vec3::Constant(10);
  spec.counts = counts;
  spec.rule = GridSpec::Rule::native;
  SplitMix64 random(seed);
  SmallCity city{VoxelGrid(spec), {}, {}};
  for (int n = 0; n < counts[0] * counts[1] / 30; ++n) {
    const int w = random.integer(2, 5);
    const int d = random.integer(2, 5);
    const int x = random.integer(0, counts[0] - w);
    const int y = random.integer(0, counts[1] - d);
    const int h = random.integer(counts[2] / 3, counts[2]);
    for (int k = 0; k < h; ++k) {
      for (int j = y; j < y + d; ++j) {
        city.grid.block_run(x, x + w - 1, j, k);
      }
    }
  }
  for (const bool is_start : {true, false}) {
    const int y = random.integer(0, counts[1] - 1);
    const int z = random.integer(0, counts[2] / 4);
    const Cell c = {is_start ? 0 : counts[0] - 1, y, z};
    city.grid.set(c, false);
    (is_start ? city.start : city.goal) = c;
  }
  return city;
}
}  // namespace altiplan::reference
