// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>

#include "altiplan/voxel_grid.hpp"

// Sight between the centres of cells, by the definition: every cell is asked for, none is walked
// to. Nothing here is shared with the kit.
namespace altiplan::oracle {

/// Whether the closed box of cell c meets the segment between the centres of a and b: the
/// parameters at which it is within each slab, as fractions of whole numbers, compared crosswise.
inline bool meets(const Cell& a, const Cell& b, const Cell& c) {
  std::int64_t low_n = 0;
  std::int64_t low_d = 1;
  std::int64_t high_n = 1;
  std::int64_t high_d = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::int64_t d = 2 * (std::int64_t(b[axis]) - a[axis]);
    std::int64_t enter = 2 * (std::int64_t(c[axis]) - a[axis]) - 1;
    std::int64_t leave = enter + 2;
    if (d == 0) {
      if (enter > 0 || leave < 0) {
        return false;
      }
      continue;
    }
    if (d < 0) {
      d = -d;
      std::swap(enter, leave);
      enter = -enter;
      leave = -leave;
    }
    if (enter * low_d > low_n * d) {
      low_n = enter;
      low_d = d;
    }
    if (leave * high_d < high_n * d) {
      high_n = leave;
      high_d = d;
    }
  }
  return low_n * high_d <= high_n * low_d;
}

/// Whether the segment between two cells of the grid meets no blocked one.
inline bool sees(const VoxelGrid& grid, const Cell& a, const Cell& b) {
  const Cell& counts = grid.spec().counts;
  for (int k = 0; k < counts[2]; ++k) {
    for (int j = 0; j < counts[1]; ++j) {
      for (int i = 0; i < counts[0]; ++i) {
        if (grid.blocked(i, j, k) && meets(a, b, {i, j, k})) {
          return false;
        }
      }
    }
  }
  return true;
}
}  // namespace altiplan::oracle
