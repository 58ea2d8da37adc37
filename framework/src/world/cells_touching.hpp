// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "altiplan/voxel_grid.hpp"

namespace altiplan {

/// Cells that may touch the box, clipped to the grid.
inline std::pair<Cell, Cell> cells_touching(const GridSpec& spec, const Box& box) {
  Cell low{};
  Cell high{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto index = [&](double at, double margin) {
      const double cell = std::floor((at - spec.origin[axis]) / spec.cell[axis]) + margin;
      return int(std::clamp(cell, -1.0, double(spec.counts[axis])));
    };
    low[axis] = std::max(0, index(box.min[axis], -1));
    high[axis] = std::min(spec.counts[axis] - 1, index(box.max[axis], 1));
  }
  return {low, high};
}

}  // namespace altiplan
