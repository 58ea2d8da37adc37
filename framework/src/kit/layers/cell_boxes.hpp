// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/shape.hpp"
#include "altiplan/voxel_grid.hpp"

namespace altiplan::kit {

/// The first and the last cell of a box of cells, both included.
struct CellBox {
  Cell first;
  Cell last;
};

/// Boxes of cells of one grid, a third of the size of shapes: fragmented maps have millions.
struct CellBoxes {
  GridSpec spec;
  std::vector<CellBox> boxes;

  BoxShape operator[](std::size_t n) const {
    return {{spec.cell_box(boxes[n].first).min, spec.cell_box(boxes[n].last).max}};
  }
};

/// Boxes that cover the blocked cells and share only faces: runs along x, equal runs of
/// neighbouring rows merged, then equal rectangles of neighbouring levels.
CellBoxes cell_boxes_of(const VoxelGrid& cells);
}  // namespace altiplan::kit
