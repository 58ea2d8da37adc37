// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/voxel_grid.hpp"

namespace altiplan::bench {

struct PlainResult {
  double length = kInfinity;  ///< metres; infinite without a route
  std::size_t expanded = 0;
};

/// Octile distance, in cells.
double octile(const Cell& a, const Cell& b);

/// Textbook A*, the reference for the planners' lengths and times: a binary heap, floating-point
/// costs, arrays cleared for each search, octile distance; a step needs its two cells free. Cells
/// are cubes; steps stay within the level if there is only one.
PlainResult plain_astar(const VoxelGrid& grid, const Cell& start, const Cell& goal);
}  // namespace altiplan::bench
