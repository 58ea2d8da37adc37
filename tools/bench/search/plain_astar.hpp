// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/voxel_grid.hpp"

namespace altiplan::bench {

struct PlainResult {
  double length = kInfinity;  ///< metres; infinite without a route
  std::size_t expanded = 0;
};

/// Textbook A*: a binary heap, real numbers, arrays cleared for each search, octile distance; a
/// step needs its two cells free. Cells are cubes; with one level of cells steps stay in it. The
/// reference for the planners' lengths and times.
PlainResult plain_astar(const VoxelGrid& grid, const Cell& start, const Cell& goal);
}  // namespace altiplan::bench
