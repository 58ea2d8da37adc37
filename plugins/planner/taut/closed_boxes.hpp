// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "altiplan/voxel_grid.hpp"

namespace altiplan::taut {

/// The closed cells of a grid as boxes, which may overlap: what bars a leg is one of them.
class ClosedBoxes {
 public:
  std::size_t size() const { return boxes_.size(); }
  explicit ClosedBoxes(const VoxelGrid& grid)
      : grid_(grid), spec_(grid.spec()), set_(spec_.cell_count()), within_(spec_.cell_count()) {
    const Cell& n = spec_.counts;
    for (int k = 0; k < n[2]; ++k) {
      for (int j = 0; j < n[1]; ++j) {
        grid.for_each_run(j, k, [&](int first, int last) {
          for (int i = first; i <= last; ++i) {
            add_all({i, j, k});
          }
        });
      }
    }
    within_ = {};
  }

  /// Calls visit(box) for the boxes of the closed cells on the way from a to b, until it returns
  /// true; true then. Which of the cells beside it a leg along a face visits is open.
  template <class Visit>
  bool on_the_way(const Vec3& a, const Vec3& b, const Visit& visit) const {
    constexpr double kInside = 1e-7;  // of the leg: its ends lie on edges
    const Vec3 from = (a - spec_.origin + kInside * (b - a)).cwiseQuotient(spec_.cell);
    const Vec3 to = (b - spec_.origin - kInside * (b - a)).cwiseQuotient(spec_.cell);
    Cell c{};
    Cell last{};
    Cell step{};
    std::array<double, 3> next{};
    std::array<double, 3> each{};
    int left = 0;  // faces to cross
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double x = from[int(axis)];
      const double y = to[int(axis)];
      c[axis] = std::clamp(int(std::floor(x)), 0, spec_.counts[axis] - 1);
      last[axis] = std::clamp(int(std::floor(y)), 0, spec_.counts[axis] - 1);
      step[axis] = last[axis] < c[axis] ? -1 : 1;
      left += std::abs(last[axis] - c[axis]);
      each[axis] = last[axis] == c[axis] ? kInfinity : 1 / std::abs(y - x);
      next[axis] = last[axis] == c[axis]
                       ? kInfinity
                       : std::abs(c[axis] + (step[axis] > 0 ? 1 : 0) - x) * each[axis];
    }
    std::uint32_t before = 0;
    for (;; --left) {
      const std::uint32_t set = set_[number(c)];
      if (set != before) {
        for (const std::uint32_t box : sets_[set]) {
          if (visit(boxes_[box])) {
            return true;
          }
        }
      }
      before = set;
      if (left == 0) {
        return false;
      }
      const std::size_t axis = next[0] <= next[1] && next[0] <= next[2] ? 0
                               : next[1] <= next[2]                     ? 1
                                                                        : 2;
      c[axis] += step[axis];
      next[axis] = c[axis] == last[axis] ? kInfinity : next[axis] + each[axis];
    }
  }

 private:
  std::size_t number(const Cell& c) const {
    return (std::size_t(c[2]) * std::size_t(spec_.counts[1]) + std::size_t(c[1])) *
               std::size_t(spec_.counts[0]) +
           std::size_t(c[0]);
  }
  /// Adds boxes until one holds c, and one c and its lower neighbour on each axis, on two and on
  /// all, where they are closed: no leg leads between two boxes that touch.
  void add_all(const Cell& c) {
    const std::uint8_t& within = within_[number(c)];
    for (unsigned axes = 0; within != 0xFF && axes < 8; ++axes) {
      if ((within >> axes & 1) != 0) {
        continue;
      }
      Cell low = c;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] -= int(axes >> axis & 1);
      }
      if (are_closed(low, c)) {
        add(low, c);
      }
    }
  }
  /// Adds the box, made so large that none of its sides can be moved.
  void add(Cell low, Cell high) {
    for (const std::size_t axis : {2, 0, 1}) {
      const auto may_move = [&](int to) {
        Cell from = low;
        Cell up_to = high;
        from[axis] = up_to[axis] = to;
        return are_closed(from, up_to);
      };
      for (; may_move(low[axis] - 1); --low[axis]) {
      }
      for (; may_move(high[axis] + 1); ++high[axis]) {
      }
    }
    // Beyond the grid nothing is free: no leg leads between a closed cell and its border.
    Box box{spec_.cell_box(low).min, spec_.cell_box(high).max};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.min[int(axis)] -= low[axis] == 0 ? spec_.cell[int(axis)] : 0;
      box.max[int(axis)] += high[axis] == spec_.counts[axis] - 1 ? spec_.cell[int(axis)] : 0;
    }
    std::unordered_map<std::uint32_t, std::uint32_t> with_box;  // by set without it
    std::uint32_t without = ~std::uint32_t{0};
    std::uint32_t with = 0;
    for (int k = low[2]; k <= high[2]; ++k) {
      for (int j = low[1]; j <= high[1]; ++j) {
        const std::size_t row = number({0, j, k});
        for (std::size_t n = row + std::size_t(low[0]); n <= row + std::size_t(high[0]); ++n) {
          if (set_[n] != without) {
            without = set_[n];
            const auto [found, is_new] = with_box.try_emplace(without, std::uint32_t(sets_.size()));
            if (is_new) {
              std::vector<std::uint32_t> more = sets_[without];
              more.push_back(std::uint32_t(boxes_.size()));
              sets_.push_back(std::move(more));
            }
            with = found->second;
          }
          set_[n] = with;
        }
        // Sets of axes of which each has a lower neighbour in the box.
        const std::uint8_t across = j > low[1] && k > low[2] ? 0x55
                                    : j > low[1]             ? 0x05
                                    : k > low[2]             ? 0x11
                                                             : 0x01;
        within_[row + std::size_t(low[0])] |= across;
        for (int i = low[0] + 1; i <= high[0]; ++i) {
          within_[row + std::size_t(i)] |= std::uint8_t(across | across << 1);
        }
      }
    }
    boxes_.push_back(box);
  }
  bool are_closed(const Cell& low, const Cell& high) const {
    if (!spec_.holds(low) || !spec_.holds(high)) {
      return false;
    }
    for (int k = low[2]; k <= high[2]; ++k) {
      for (int j = low[1]; j <= high[1]; ++j) {
        for (int i = low[0]; i <= high[0]; ++i) {
          if (!grid_.blocked(i, j, k)) {
            return false;
          }
        }
      }
    }
    return true;
  }

  const VoxelGrid& grid_;
  GridSpec spec_;
  std::vector<Box> boxes_;
  std::vector<std::vector<std::uint32_t>> sets_{{}};  ///< of boxes; the first has none
  std::vector<std::uint32_t> set_;                    ///< by cell: those that hold it
  /// By cell: for each set of axes, whether one box holds the cell and its lower neighbours there.
  std::vector<std::uint8_t> within_;
};

/// True only if the leg leads through the inside of the box.
inline bool bars(const Box& box, const Vec3& a, const Vec3& b) {
  constexpr double kInside = 1e-7;  // metres; greater than any rounding
  double enters = 0;
  double leaves = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis] + kInside - a[axis];
    const double high = box.max[axis] - kInside - a[axis];
    const double way = b[axis] - a[axis];
    if (std::abs(way) < 1e-12) {
      if (low >= 0 || high <= 0) {
        return false;
      }
      continue;
    }
    const double in = (way > 0 ? low : high) / way;
    const double out = (way > 0 ? high : low) / way;
    enters = std::max(enters, in);
    leaves = std::min(leaves, out);
  }
  return enters <= leaves;
}
}  // namespace altiplan::taut
