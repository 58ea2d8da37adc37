// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "altiplan/voxel_grid.hpp"

namespace altiplan::kit {

/// Marks the blocks of 8 x 8 x 8 cells of a grid with nothing blocked in or directly around them: a
/// leg crosses such a block in one step.
class ALTIPLAN_API FreeBlocks {
 public:
  /// Rebuilt only for another grid than the last one.
  void prepare(const std::shared_ptr<const VoxelGrid>& grid);

  /// Same answer as kit::line_of_sight on that grid, faster where the leg is long and space is
  /// open.
  bool line_of_sight(const Cell& a, const Cell& b) const;

 private:
  bool is_free(const Cell& block) const {
    return free_[(std::size_t(block[2]) * std::size_t(counts_[1]) + std::size_t(block[1])) *
                     std::size_t(counts_[0]) +
                 std::size_t(block[0])] != 0;
  }

  std::weak_ptr<const VoxelGrid> of_;
  const VoxelGrid* grid_ = nullptr;
  Cell counts_{};
  std::vector<std::uint8_t> free_;
};
}  // namespace altiplan::kit
