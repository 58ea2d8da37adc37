// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/voxel_grid.hpp"

namespace altiplan::bench {

struct PlainResult {
  double length = kInfinity;  ///< metres; infinite without a route
  std::size_t expanded = 0;
};

/// A* as a textbook has it: a binary heap, real numbers, arrays cleared for each search, octile
/// distance; a step needs its two cells free. Cells are cubes; with one level of cells steps stay
/// in it. What the planners are compared with, in length and in time.
PlainResult plain_astar(const VoxelGrid& grid, const Cell& start, const Cell& goal);
}  // namespace altiplan::bench
