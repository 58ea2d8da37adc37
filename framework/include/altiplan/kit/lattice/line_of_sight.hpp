// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "altiplan/voxel_grid.hpp"

namespace altiplan::kit {

/// Calls `visit(cell)` for every cell whose closed box the segment between the centres of a and b
/// meets, a first; where the segment passes through an edge or a corner that is every cell that
/// shares it. Stops and returns false as soon as a visit returns false. In whole numbers, so the
/// set of cells is the same from both ends.
template <class Visit>
bool walk_cells(const Cell& a, const Cell& b, const Visit& visit) {
  std::int64_t steps[3];  // faces to cross on each axis
  int sign[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    steps[axis] = std::abs(std::int64_t(b[axis]) - a[axis]);
    sign[axis] = b[axis] > a[axis] ? 1 : -1;
  }
  Cell c = a;
  if (!visit(c)) {
    return false;
  }
  std::int64_t crossed[3] = {0, 0, 0};
  // Face number n of an axis is crossed at the time (2 n + 1) / (2 steps): compared crosswise.
  const auto sooner = [&](std::size_t i, std::size_t j) {
    return (2 * crossed[i] + 1) * steps[j] < (2 * crossed[j] + 1) * steps[i];
  };
  while (c != b) {
    unsigned next = 0;  // axes whose face is crossed next, all at the same time
    std::size_t first = 3;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (crossed[axis] == steps[axis]) {
        continue;
      }
      if (first == 3 || sooner(axis, first)) {
        next = 1U << axis;
        first = axis;
      } else if (!sooner(first, axis)) {
        next |= 1U << axis;
      }
    }
    // Through a face one cell, through an edge three, through a corner seven; the last is entered.
    for (unsigned part = 1; part <= next; ++part) {
      if ((part & ~next) != 0) {
        continue;
      }
      Cell beside = c;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        beside[axis] += (part >> axis & 1) != 0 ? sign[axis] : 0;
      }
      if (!visit(beside)) {
        return false;
      }
      if (part == next) {
        c = beside;
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      crossed[axis] += next >> axis & 1;
    }
  }
  return true;
}

/// Whether every cell that the segment between two centres meets is free: the cells that walk_cells
/// visits. Both cells lie in the grid.
///
/// The segment is the same seen from both ends, so half the way is walked, and with each cell the
/// one that mirrors it is looked at. Cells are places of bits, which moves add to; times are whole
/// numbers of a unit that fits all three axes: the middle comes after steps x * steps y * steps z.
inline bool line_of_sight(const VoxelGrid& grid, const Cell& a, const Cell& b) {
  constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  constexpr int kMaxSteps = 1 << 20;  // their products stay whole numbers
  const std::uint64_t* words = grid.row_words(0, 0);
  const std::int64_t stride[3] = {1, 64 * std::int64_t(grid.words_per_row()),
                                  64 * (grid.row_words(0, 1) - words)};
  std::int64_t at = 1 + a[0] + a[1] * stride[1] + a[2] * stride[2];
  const std::int64_t both = at + 1 + b[0] + b[1] * stride[1] + b[2] * stride[2];
  const auto is_free = [&](std::int64_t bit) {
    const std::int64_t mirrored = both - bit;
    return ((words[bit / 64] >> (bit % 64) | words[mirrored / 64] >> (mirrored % 64)) & 1) == 0;
  };

  std::int64_t steps[3];  // faces to cross on each axis, 1 where none
  std::int64_t move[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int way = b[axis] - a[axis];
    if (std::abs(way) > kMaxSteps) {
      return walk_cells(a, b, [&](const Cell& c) { return !grid.blocked(c); });
    }
    steps[axis] = std::max(1, std::abs(way));
    move[axis] = way < 0 ? -stride[axis] : stride[axis];
  }
  // Face number n of an axis is crossed at the time (2 n + 1) * unit.
  const std::int64_t unit[3] = {steps[1] * steps[2], steps[0] * steps[2], steps[0] * steps[1]};
  const std::int64_t middle = steps[0] * unit[0];
  std::int64_t next[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    next[axis] = a[axis] == b[axis] ? kNever : unit[axis];
  }
  if (!is_free(at)) {
    return false;
  }
  for (;;) {
    const std::int64_t now = std::min({next[0], next[1], next[2]});
    if (now > middle) {
      return true;
    }
    std::int64_t part[3];
    int crossed = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool is_crossed = next[axis] == now;
      part[axis] = is_crossed ? move[axis] : 0;
      next[axis] += is_crossed ? 2 * unit[axis] : 0;
      crossed += is_crossed ? 1 : 0;
    }
    // Through an edge or a corner: the cells beside the way, some of them twice.
    if (crossed > 1 && !(is_free(at + part[0]) && is_free(at + part[1]) && is_free(at + part[2]) &&
                         is_free(at + part[0] + part[1]) && is_free(at + part[0] + part[2]) &&
                         is_free(at + part[1] + part[2]))) {
      return false;
    }
    at += part[0] + part[1] + part[2];
    if (!is_free(at)) {
      return false;
    }
  }
}

/// Whether the cells from `first` to `last` of a row of the grid are free.
inline bool row_is_free(const std::uint64_t* row, int first, int last) {
  const auto from = std::size_t(first + 1);
  const auto to = std::size_t(last + 1);
  const std::uint64_t after_from = ~std::uint64_t{0} << from % 64;
  const std::uint64_t up_to = ~std::uint64_t{0} >> (63 - to % 64);
  if (from / 64 == to / 64) {
    return (row[from / 64] & after_from & up_to) == 0;
  }
  std::uint64_t blocked = (row[from / 64] & after_from) | (row[to / 64] & up_to);
  for (std::size_t word = from / 64 + 1; word < to / 64; ++word) {
    blocked |= row[word];
  }
  return blocked == 0;
}

/// The answer of line_of_sight for two cells of one level: row by row, all the cells of one at
/// once.
inline bool level_line_of_sight(const VoxelGrid& grid, const Cell& a, const Cell& b) {
  const Cell& low = a[1] <= b[1] ? a : b;
  const Cell& high = a[1] <= b[1] ? b : a;
  const int rows = high[1] - low[1];
  const int across = std::abs(high[0] - low[0]);
  const int way = high[0] < low[0] ? -1 : 1;
  const std::uint64_t* row = grid.row_words(low[1], low[2]);
  const auto is_free = [&](int from, int to) {
    const int x = low[0] + way * from;
    const int y = low[0] + way * to;
    return row_is_free(row, std::min(x, y), std::max(x, y));
  };
  if (rows == 0) {
    return is_free(0, across);
  }
  // The segment leaves row n at across (2 n + 1) / (2 rows) cells from its lower end, a half more
  // is the right side of a cell: a whole number where it meets the corner of two.
  const std::int64_t half_cells = 2 * std::int64_t(rows);
  const int whole = across / rows;
  const std::int64_t rest = 2 * (std::int64_t(across) - std::int64_t(whole) * rows);
  std::int64_t left = (std::int64_t(across) + rows) % half_cells;
  int last = int((std::int64_t(across) + rows) / half_cells);
  int first = 0;
  for (int n = 0; n < rows; ++n) {
    if (!is_free(first, last)) {
      return false;
    }
    row += grid.words_per_row();
    first = left == 0 ? last - 1 : last;
    last += whole;
    left += rest;
    last += left >= half_cells ? 1 : 0;
    left -= left >= half_cells ? half_cells : 0;
  }
  return is_free(first, across);
}
}  // namespace altiplan::kit
