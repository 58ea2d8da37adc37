// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdlib>

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

/// Whether every cell that the segment between two centres meets is free. Both cells lie in the
/// grid.
inline bool line_of_sight(const VoxelGrid& grid, const Cell& a, const Cell& b) {
  return walk_cells(a, b, [&](const Cell& c) { return !grid.blocked(c); });
}
}  // namespace altiplan::kit
