// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/free_blocks.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "altiplan/kit/lattice/line_of_sight.hpp"

namespace altiplan::kit {
namespace {

constexpr int kEdgeBits = 3;
constexpr int kEdge = 1 << kEdgeBits;
constexpr int kShort = 96;           // steps, below which every cell is looked at
constexpr int kMaxSteps = 1 << 20;  // their products stay whole numbers

enum class Seen { end, blocked_cell, next_block };

/// A leg between the centres of two cells, on its way from block to block. Face number n of an axis
/// is crossed at the time (2 n + 1) * unit, as in kit::line_of_sight.
class Walk {
 public:
  Walk(const VoxelGrid& grid, const Cell& a, const Cell& b)
      : grid_(grid), words_(grid.words().data()), start_(a), end_(b), cell_(a) {
    const std::int64_t stride[3] = {1, std::int64_t(grid.row_bits()),
                                    std::int64_t(grid.level_bits())};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      steps_[axis] = std::max(1, std::abs(b[axis] - a[axis]));
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      unit_[axis] = steps_[(axis + 1) % 3] * steps_[(axis + 2) % 3];
      per_unit_[axis] = 1 / double(unit_[axis]);
      sign_[axis] = b[axis] < a[axis] ? -1 : 1;
      move_[axis] = sign_[axis] * stride[axis];
      block_[axis] = a[axis] >> kEdgeBits;
      const int in_block = a[axis] & (kEdge - 1);
      const int faces = sign_[axis] < 0 ? in_block : kEdge - 1 - in_block;
      next_[axis] = a[axis] == b[axis] ? kNever : unit_[axis];
      leave_[axis] = is_last(axis) ? kNever : (2 * faces + 1) * unit_[axis];
    }
  }

  const Cell& block() const { return block_; }
  bool is_in_last_block() const { return leaves() == kNever; }

  /// Goes on to the next block without a look at this one's cells.
  void leave_block() {
    now_ = leaves();
    has_jumped_ = true;
    enter_blocks();
  }

  /// Goes on to it from cell to cell.
  Seen look_through_block() {
    if (has_jumped_) {
      catch_up();
    }
    auto at = std::int64_t(grid_.bit(cell_));
    if (is_blocked(at)) {
      return Seen::blocked_cell;
    }
    for (const std::int64_t leaves = this->leaves(); now_ < leaves;) {
      now_ = std::min({next_[0], next_[1], next_[2]});
      if (now_ == kNever) {
        return Seen::end;
      }
      std::int64_t part[3];
      int crossed = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool is_crossed = next_[axis] == now_;
        part[axis] = is_crossed ? move_[axis] : 0;
        crossed += is_crossed ? 1 : 0;
        cell_[axis] += is_crossed ? sign_[axis] : 0;
        next_[axis] += is_crossed ? 2 * unit_[axis] : 0;
      }
      // Through an edge or a corner: the cells beside the way, some of them twice.
      if (crossed > 1 &&
          (is_blocked(at + part[0]) || is_blocked(at + part[1]) || is_blocked(at + part[2]) ||
           is_blocked(at + part[0] + part[1]) || is_blocked(at + part[0] + part[2]) ||
           is_blocked(at + part[1] + part[2]))) {
        return Seen::blocked_cell;
      }
      at += part[0] + part[1] + part[2];
      if (is_blocked(at)) {
        return Seen::blocked_cell;
      }
      if (cell_ == end_) {
        return Seen::end;
      }
    }
    enter_blocks();
    return Seen::next_block;
  }

 private:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

  std::int64_t leaves() const { return std::min({leave_[0], leave_[1], leave_[2]}); }
  bool is_last(std::size_t axis) const { return block_[axis] == end_[axis] >> kEdgeBits; }
  bool is_blocked(std::int64_t bit) const { return (words_[bit / 64] >> (bit % 64) & 1) != 0; }

  void enter_blocks() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (leave_[axis] <= now_) {
        block_[axis] += sign_[axis];
        leave_[axis] = is_last(axis) ? kNever : leave_[axis] + 2 * kEdge * unit_[axis];
      }
    }
  }

  /// Finds the cell where the leg is by now.
  void catch_up() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (start_[axis] == end_[axis]) {
        continue;
      }
      const std::int64_t unit = unit_[axis];
      auto crossed = std::int64_t((double(now_) * per_unit_[axis] + 1) / 2);  // or one beside it
      crossed += (2 * crossed + 1) * unit <= now_ ? 1 : 0;
      crossed -= (2 * crossed - 1) * unit > now_ ? 1 : 0;
      crossed = std::min(crossed, steps_[axis]);
      next_[axis] = crossed == steps_[axis] ? kNever : (2 * crossed + 1) * unit;
      cell_[axis] = start_[axis] + sign_[axis] * int(crossed);
    }
    has_jumped_ = false;
  }

  const VoxelGrid& grid_;
  const std::uint64_t* words_;
  Cell start_;
  Cell end_;
  Cell cell_;
  Cell block_{};
  std::int64_t steps_[3];
  std::int64_t unit_[3];
  double per_unit_[3];
  int sign_[3];
  std::int64_t move_[3];   // in bits
  std::int64_t next_[3];   // when the next face is crossed
  std::int64_t leave_[3];  // when the block is left
  std::int64_t now_ = 0;
  bool has_jumped_ = false;
};
}  // namespace

void FreeBlocks::prepare(const std::shared_ptr<const VoxelGrid>& grid) {
  if (of_.lock() == grid) {
    return;
  }
  of_ = grid;
  grid_ = grid.get();
  const Cell& cells = grid->spec().counts;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    counts_[axis] = (cells[axis] + kEdge - 1) / kEdge;
  }
  free_.assign(std::size_t(counts_[0]) * std::size_t(counts_[1]) * std::size_t(counts_[2]), 1);
  std::vector<std::uint64_t> any(grid->words_per_row() + 1);
  std::uint8_t* block = free_.data();
  // The border counts as free: no leg leads there.
  for (int z = 0; z < counts_[2]; ++z) {
    for (int y = 0; y < counts_[1]; ++y) {
      std::fill(any.begin(), any.end(), 0);
      for (int k = std::max(z * kEdge - 1, 0); k <= std::min(z * kEdge + kEdge, cells[2] - 1);
           ++k) {
        for (int j = std::max(y * kEdge - 1, 0); j <= std::min(y * kEdge + kEdge, cells[1] - 1);
             ++j) {
          const std::uint64_t* row = grid->row_words(j, k);
          for (std::size_t word = 0; word < grid->words_per_row(); ++word) {
            any[word] |= row[word];
          }
        }
      }
      // Bit i + 1 is cell i: cells 8 x - 1 to 8 x + 8 are ten bits from 8 x on.
      any[0] &= ~std::uint64_t{1};
      const std::size_t end = std::size_t(cells[0]) + 1;
      any[end / 64] &= (std::uint64_t{1} << end % 64) - 1;
      std::fill(any.begin() + std::ptrdiff_t(end / 64) + 1, any.end(), 0);
      for (int x = 0; x < counts_[0]; ++x) {
        const std::size_t bit = std::size_t(x) * kEdge;
        std::uint64_t window = any[bit / 64] >> bit % 64;
        if (bit % 64 > 54) {
          window |= any[bit / 64 + 1] << (64 - bit % 64);
        }
        *block++ = (window & 0x3FF) == 0;
      }
    }
  }
}

bool FreeBlocks::line_of_sight(const Cell& a, const Cell& b) const {
  const int steps = std::abs(b[0] - a[0]) + std::abs(b[1] - a[1]) + std::abs(b[2] - a[2]);
  if (steps < kShort || steps > kMaxSteps) {
    return kit::line_of_sight(*grid_, a, b);
  }
  Walk walk(*grid_, a, b);
  for (;;) {
    if (!is_free(walk.block())) {
      if (const Seen seen = walk.look_through_block(); seen != Seen::next_block) {
        return seen == Seen::end;
      }
    } else if (walk.is_in_last_block()) {
      return true;
    } else {
      walk.leave_block();
    }
  }
}
}  // namespace altiplan::kit
