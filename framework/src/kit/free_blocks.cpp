// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/free_blocks.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "altiplan/kit/line_of_sight.hpp"

namespace altiplan::kit {
namespace {

constexpr int kEdge = 8;
constexpr int kShort = 96;           // steps, below which every cell is looked at
constexpr int kMostSteps = 1 << 20;  // their products stay whole numbers
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
  std::int64_t way[3];
  std::int64_t steps[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    way[axis] = b[axis] - a[axis];
    steps[axis] = std::max<std::int64_t>(1, std::abs(way[axis]));
  }
  const std::int64_t sum = steps[0] + steps[1] + steps[2];
  if (sum < kShort || sum > kMostSteps) {
    return kit::line_of_sight(*grid_, a, b);
  }
  constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  // Face number n of an axis is crossed at the time (2 n + 1) * unit, as in kit::line_of_sight.
  const std::int64_t unit[3] = {steps[1] * steps[2], steps[0] * steps[2], steps[0] * steps[1]};
  std::int64_t now = 0;
  const std::uint64_t* words = grid_->words().data();
  const std::int64_t stride[3] = {1, std::int64_t(grid_->row_bits()),
                                  std::int64_t(grid_->level_bits())};
  const auto blocked = [&](std::int64_t bit) { return (words[bit / 64] >> (bit % 64) & 1) != 0; };
  Cell c = a;
  Cell block;
  int sign[3];
  std::int64_t next[3];   // when the next face is crossed
  std::int64_t leave[3];  // when the block is left
  std::int64_t move[3];
  double per_unit[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sign[axis] = way[axis] < 0 ? -1 : 1;
    move[axis] = sign[axis] * stride[axis];
    per_unit[axis] = 1 / double(unit[axis]);
    block[axis] = c[axis] >> kEdgeBits;
    const int in_block = c[axis] & (kEdge - 1);
    const int faces = way[axis] < 0 ? in_block : kEdge - 1 - in_block;
    next[axis] = way[axis] == 0 ? kNever : unit[axis];
    leave[axis] = block[axis] == b[axis] >> kEdgeBits ? kNever : (2 * faces + 1) * unit[axis];
  }
  const auto leave_blocks = [&] {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (leave[axis] <= now) {
        block[axis] += sign[axis];
        leave[axis] =
            block[axis] == b[axis] >> kEdgeBits ? kNever : leave[axis] + 2 * kEdge * unit[axis];
      }
    }
  };
  for (bool jumped = false;;) {
    const std::int64_t leaves = std::min({leave[0], leave[1], leave[2]});
    if (is_free(block)) {
      if (leaves == kNever) {
        return true;
      }
      jumped = true;
      now = leaves;
      leave_blocks();
      continue;
    }
    if (jumped) {  // where the leg is by now
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (way[axis] == 0) {
          continue;
        }
        auto crossed = std::int64_t((double(now) * per_unit[axis] + 1) / 2);
        crossed += (2 * crossed + 1) * unit[axis] <= now ? 1 : 0;
        crossed -= (2 * crossed - 1) * unit[axis] > now ? 1 : 0;
        crossed = std::min(crossed, steps[axis]);
        next[axis] = crossed == steps[axis] ? kNever : (2 * crossed + 1) * unit[axis];
        c[axis] = a[axis] + sign[axis] * int(crossed);
      }
      jumped = false;
    }
    auto at = std::int64_t(grid_->bit(c));
    if (blocked(at)) {
      return false;
    }
    while (now < leaves) {
      now = std::min({next[0], next[1], next[2]});
      if (now == kNever) {
        return true;
      }
      std::int64_t part[3];
      int crossed = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool is_crossed = next[axis] == now;
        part[axis] = is_crossed ? move[axis] : 0;
        crossed += is_crossed ? 1 : 0;
        c[axis] += is_crossed ? sign[axis] : 0;
        next[axis] += is_crossed ? 2 * unit[axis] : 0;
      }
      // Through an edge or a corner: the cells beside the way, some of them twice.
      if (crossed > 1 && (blocked(at + part[0]) || blocked(at + part[1]) || blocked(at + part[2]) ||
                          blocked(at + part[0] + part[1]) || blocked(at + part[0] + part[2]) ||
                          blocked(at + part[1] + part[2]))) {
        return false;
      }
      at += part[0] + part[1] + part[2];
      if (blocked(at)) {
        return false;
      }
      if (c == b) {
        return true;
      }
    }
    leave_blocks();
  }
}
}  // namespace altiplan::kit
