// SPDX-License-Identifier: Apache-2.0
// The levels of a stratified space: lattices whose resolution doubles from one to the next, and the
// share of the space that each knows for certain. Paper 003, section 2.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "altiplan/kit/any_angle/any_angle.hpp"
#include "altiplan/route.hpp"

namespace altiplan::stratified {

/// Cells of an axis on which a level's lattice lies: 2^(level - 1) + 1 of them, evenly spaced
/// between the first cell and the last; every cell if there are fewer.
inline std::vector<int> rows_of(int level, int cells) {
  const int steps = std::min(1 << std::min(level - 1, 30), cells - 1);
  std::vector<int> rows;
  for (int k = 0; k <= steps; ++k) {
    rows.push_back(steps == 0 ? 0 : int(std::lround(double(k) * (cells - 1) / steps)));
  }
  return rows;
}

/// The level whose spacing on the longest axis is nearest to a cell, but not finer.
inline int finest_level(const Cell& counts) {
  const int maximum = std::max({counts[0], counts[1], counts[2], 2});
  int level = 1;
  while (1 << level <= maximum - 1) {
    ++level;
  }
  return level;
}

/// Edges of the blocks into which a level divides an axis: block k from edge k to edge k + 1.
inline std::vector<int> block_edges(int level, int cells) {
  const int blocks = std::min(1 << std::min(level - 1, 30), cells);
  std::vector<int> edges;
  for (int k = 0; k <= blocks; ++k) {
    edges.push_back(int(std::lround(double(k) * cells / blocks)));
  }
  return edges;
}

/// Share of a level's blocks that are fully free or fully blocked, eq. (5); arbitrary once `watch`
/// is spent.
inline double certain_share(int level, const VoxelGrid& occupancy, BudgetWatch* watch = nullptr) {
  const Cell& counts = occupancy.spec().counts;
  std::array<std::vector<int>, 3> edges;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    edges[axis] = block_edges(level, counts[axis]);
  }
  const std::size_t across = edges[0].size() - 1;
  const std::size_t deep = edges[1].size() - 1;
  const std::size_t high = edges[2].size() - 1;
  std::size_t certain = 0;
  std::vector<int> blocked(across);
  for (std::size_t z = 0; z < high; ++z) {
    for (std::size_t y = 0; y < deep; ++y) {
      std::fill(blocked.begin(), blocked.end(), 0);
      for (int k = edges[2][z]; k < edges[2][z + 1]; ++k) {
        if (watch != nullptr && watch->spent(0)) {
          return 0;
        }
        for (int j = edges[1][y]; j < edges[1][y + 1]; ++j) {
          occupancy.for_each_run(j, k, [&](int first, int last) {
            // The blocks that the run passes through.
            std::size_t x = std::size_t(std::upper_bound(edges[0].begin(), edges[0].end(), first) -
                                        edges[0].begin() - 1);
            for (; x < across && edges[0][x] <= last; ++x) {
              blocked[x] += std::min(last + 1, edges[0][x + 1]) - std::max(first, edges[0][x]);
            }
          });
        }
      }
      const int rows = (edges[2][z + 1] - edges[2][z]) * (edges[1][y + 1] - edges[1][y]);
      for (std::size_t x = 0; x < across; ++x) {
        const int cells = rows * (edges[0][x + 1] - edges[0][x]);
        certain += blocked[x] == 0 || blocked[x] == cells;
      }
    }
  }
  return double(certain) / double(across * deep * high);
}

/// The lowest level whose certain share exceeds p_max; the finest if there is none. Arbitrary once
/// `watch` is spent.
inline int min_level(const VoxelGrid& occupancy, double p_max, BudgetWatch* watch = nullptr) {
  const int finest = finest_level(occupancy.spec().counts);
  int level = 1;
  while (level < finest && certain_share(level, occupancy, watch) <= p_max) {
    ++level;
  }
  return level;
}

/// The lattice of a level, or part of it.
class Level {
 public:
  Level(int level, const VoxelGrid& occupancy) : occupancy_(occupancy), grid_(spec(level)) {
    nodes_.grid = &grid_;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      nodes_.cell[axis] = rows_of(level, occupancy.spec().counts[axis]);
    }
    const Cell& counts = grid_.spec().counts;
    for (int k = 0; k < counts[2]; ++k) {
      for (int j = 0; j < counts[1]; ++j) {
        grid_.block_run(0, counts[0] - 1, j, k);
      }
    }
  }
  Level(const Level&) = delete;
  Level& operator=(const Level&) = delete;

  const kit::AnyAngleNodes& nodes() const { return nodes_; }
  std::size_t node_count() const { return grid_.spec().cell_count() - grid_.blocked_count(); }

  void add_all() {
    const Cell& counts = grid_.spec().counts;
    for (int k = 0; k < counts[2]; ++k) {
      for (int j = 0; j < counts[1]; ++j) {
        for (int i = 0; i < counts[0]; ++i) {
          add({i, j, k});
        }
      }
    }
  }

  /// Adds the node nearest to a position, in cells, and its neighbours.
  void add_around(const std::array<double, 3>& place) {
    const Cell key = nearest(place);
    for (int d = 0; d < kit::kDirections; ++d) {
      const Cell o = kit::offset(d);
      const Cell next = {key[0] + o[0], key[1] + o[1], key[2] + o[2]};
      if (grid_.spec().holds(next)) {
        add(next);
      }
    }
  }

  /// The key of the node nearest to a position, in cells.
  Cell nearest(const std::array<double, 3>& place) const {
    Cell key{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::vector<int>& rows = nodes_.cell[axis];
      const auto above = std::lower_bound(rows.begin(), rows.end(), place[axis]);
      key[axis] = int(above - rows.begin());
      if (above == rows.end() ||
          (above != rows.begin() && place[axis] - *(above - 1) < *above - place[axis])) {
        --key[axis];
      }
    }
    return key;
  }
  std::array<double, 3> place(const Cell& key) const {
    return {double(nodes_.cell[0][std::size_t(key[0])]),
            double(nodes_.cell[1][std::size_t(key[1])]),
            double(nodes_.cell[2][std::size_t(key[2])])};
  }

 private:
  GridSpec spec(int level) const {
    GridSpec spec;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      spec.counts[axis] = int(rows_of(level, occupancy_.spec().counts[axis]).size());
    }
    return spec;
  }
  void add(const Cell& key) {
    const Cell c = {nodes_.cell[0][std::size_t(key[0])], nodes_.cell[1][std::size_t(key[1])],
                    nodes_.cell[2][std::size_t(key[2])]};
    if (!occupancy_.blocked(c)) {
      grid_.set(key, false);
    }
  }

  const VoxelGrid& occupancy_;
  VoxelGrid grid_;
  kit::AnyAngleNodes nodes_;
};

/// The chain of a level's nodes along a route: the nearest ones to points one spacing apart. (The
/// bends alone would leave clusters without a path between them.)
inline std::vector<Cell> chain(const Level& level, const Polyline& route, const GridSpec& cells) {
  const auto in_cells = [&](const Vec3& p) {
    std::array<double, 3> place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int a = int(axis);
      const double at = (p[a] - cells.origin[a]) / cells.cell[a] - 0.5;
      place[axis] = std::clamp(at, 0.0, cells.counts[axis] - 1.0);
    }
    return place;
  };
  std::vector<Cell> keys = {level.nearest(in_cells(route.front()))};
  for (std::size_t leg = 0; leg + 1 < route.size(); ++leg) {
    const auto from = in_cells(route[leg]);
    const auto to = in_cells(route[leg + 1]);
    double spacings = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::vector<int>& rows = level.nodes().cell[axis];
      if (rows.size() > 1) {
        const double spacing = double(rows.back()) / double(rows.size() - 1);
        spacings = std::max(spacings, std::abs(to[axis] - from[axis]) / spacing);
      }
    }
    const int steps = int(std::ceil(spacings));
    for (int n = 1; n <= steps; ++n) {
      const double t = double(n) / steps;
      std::array<double, 3> place;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        place[axis] = from[axis] + t * (to[axis] - from[axis]);
      }
      if (const Cell key = level.nearest(place); key != keys.back()) {
        keys.push_back(key);
      }
    }
  }
  return keys;
}
}  // namespace altiplan::stratified
