// SPDX-License-Identifier: Apache-2.0
// Beyond the paper: a path over blocks of cells, and planning within the cells around it.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "altiplan/kit/lattice/lattice.hpp"
#include "altiplan/kit/lattice/open_list.hpp"

namespace altiplan::stratified {

/// Blocks of 8 x 8 x 8 cells, with the number of blocked cells of each.
class Blocks {
 public:
  static constexpr int kEdge = 8;

  explicit Blocks(const VoxelGrid& occupancy)
      : occupancy_(occupancy),
        counts_(counts(occupancy.spec().counts)),
        index_(counts_),
        blocked_(index_.size(), 0) {
    const Cell& cells = occupancy.spec().counts;
    for (int k = 0; k < cells[2]; ++k) {
      for (int j = 0; j < cells[1]; ++j) {
        std::uint16_t* row = &blocked_[index_.index({0, j / kEdge, k / kEdge})];
        occupancy.for_each_run(j, k, [&](int first, int last) {
          for (int x = first / kEdge; x <= last / kEdge; ++x) {
            row[x] = std::uint16_t(row[x] + std::min(last, (x + 1) * kEdge - 1) -
                                   std::max(first, x * kEdge) + 1);
          }
        });
      }
    }
  }

  /// The blocks of a cheapest path between two cells: A* over blocks with a free cell, where a step
  /// costs more the less of its block is free. Empty if there is none. The two blocks may be fully
  /// blocked: ends of a route are linked from neighbouring cells.
  std::vector<Cell> way(const Cell& from, const Cell& to) const {
    const std::uint32_t start = index_.index(block_of(from));
    const Cell goal = block_of(to);
    std::vector<float> g(index_.size(), INFINITY);
    std::vector<std::uint8_t> in(index_.size(), kit::kHere);
    kit::OpenList open;
    open.clear(1e-6);
    g[start] = 0;
    open.push(apart(block_of(from), goal), 0, start);
    while (!open.empty()) {
      const auto [f, g_here, index] = open.pop();
      if (g_here > g[index]) {
        continue;
      }
      const Cell here = index_.cell(index);
      if (here == goal) {
        return back(index, in);
      }
      for (int d = 0; d < kit::kDirections; ++d) {
        const Cell o = kit::offset(d);
        const Cell next = {here[0] + o[0], here[1] + o[1], here[2] + o[2]};
        if (d == kit::kHere || !holds(next)) {
          continue;
        }
        const std::uint32_t there = index_.index(next);
        const double cells = volume(next);
        const double free = std::max(1 - blocked_[there] / cells, next == goal ? 1 / cells : 0);
        if (free == 0) {
          continue;
        }
        const float way =
            float(g_here + std::sqrt(double(o[0] * o[0] + o[1] * o[1] + o[2] * o[2])) / free);
        if (way < g[there]) {
          g[there] = way;
          in[there] = std::uint8_t(d);
          open.push(way + apart(next, goal), way, there);
        }
      }
    }
    return {};
  }

  /// The free cells of the blocks of a path and of those up to `around` blocks beside it.
  VoxelGrid corridor(const std::vector<Cell>& way, int around) const {
    VoxelGrid cells(occupancy_.spec());
    const Cell& n = occupancy_.spec().counts;
    for (int k = 0; k < n[2]; ++k) {
      for (int j = 0; j < n[1]; ++j) {
        cells.block_run(0, n[0] - 1, j, k);
      }
    }
    for (const Cell& block : way) {
      Cell low{};
      Cell high{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::max((block[axis] - around) * kEdge, 0);
        high[axis] = std::min((block[axis] + around + 1) * kEdge, n[axis]) - 1;
      }
      cells.copy(occupancy_, low, high);
    }
    return cells;
  }
  int longest_axis() const { return std::max({counts_[0], counts_[1], counts_[2]}); }

 private:
  static Cell counts(const Cell& cells) {
    return {(cells[0] + kEdge - 1) / kEdge, (cells[1] + kEdge - 1) / kEdge,
            (cells[2] + kEdge - 1) / kEdge};
  }
  static Cell block_of(const Cell& c) { return {c[0] / kEdge, c[1] / kEdge, c[2] / kEdge}; }
  bool holds(const Cell& block) const {
    return block[0] >= 0 && block[1] >= 0 && block[2] >= 0 && block[0] < counts_[0] &&
           block[1] < counts_[1] && block[2] < counts_[2];
  }
  /// Number of cells of a block: smaller at the upper ends of the axes.
  double volume(const Cell& block) const {
    double cells = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cells *= std::min(kEdge, occupancy_.spec().counts[axis] - block[axis] * kEdge);
    }
    return cells;
  }
  static double apart(const Cell& a, const Cell& b) {
    return std::hypot(double(a[0] - b[0]), double(a[1] - b[1]), double(a[2] - b[2]));
  }
  std::vector<Cell> back(std::uint32_t index, const std::vector<std::uint8_t>& in) const {
    std::vector<Cell> way = {index_.cell(index)};
    for (; in[index] != kit::kHere; way.push_back(index_.cell(index))) {
      index = std::uint32_t(std::int64_t(index) - index_.stride(in[index]));
    }
    return way;
  }

  const VoxelGrid& occupancy_;
  Cell counts_;
  kit::CellIndex index_;
  std::vector<std::uint16_t> blocked_;
};
}  // namespace altiplan::stratified
