// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <vector>

#include "altiplan/grid_spec.hpp"

namespace altiplan {

/// Occupancy of a box of cells, one bit each, x fastest, with a border of blocked cells all around:
/// valid indices run from -1 to counts.
class ALTIPLAN_API VoxelGrid {
 public:
  explicit VoxelGrid(const GridSpec& spec);

  const GridSpec& spec() const { return spec_; }
  bool blocked(const Cell& c) const { return blocked(c[0], c[1], c[2]); }
  bool blocked(int i, int j, int k) const {
    const std::size_t bit = std::size_t(i + 1);
    return (words_[row(j, k) + bit / 64] >> (bit % 64)) & 1;
  }
  void set(const Cell& c, bool is_blocked);
  /// Blocks, or frees, cells i0..i1 (both included, clipped to the grid) of row (j, k).
  void block_run(int i0, int i1, int j, int k) { set_run(i0, i1, j, k, true); }
  void free_run(int i0, int i1, int j, int k) { set_run(i0, i1, j, k, false); }
  /// Blocks every cell that `other`, of the same spec, blocks.
  void merge(const VoxelGrid& other);
  /// Copies cells low to high (both included, clipped to the grid) from another grid of the same
  /// spec.
  void copy(const VoxelGrid& other, const Cell& low, const Cell& high);
  /// Calls visit(first, last) for the runs of blocked cells in row (j, k), both included.
  template <class Visit>
  void for_each_run(int j, int k, const Visit& visit) const {
    for (int first = find(0, j, k, true); first < spec_.counts[0];) {
      const int end = find(first, j, k, false);
      visit(first, end - 1);
      first = find(end, j, k, true);
    }
  }
  /// Calls `asked` from now on for every run set and every row read; it throws to interrupt that.
  void watch(std::function<void()> asked) { watch_ = std::move(asked); }
  void ask_watch() const {
    if (watch_) {
      watch_();
    }
  }
  std::size_t blocked_count() const;
  std::size_t bytes() const { return words_.size() * sizeof(std::uint64_t); }

  /// Bits of row (j, k), cell -1 first; `words_per_row()` words.
  const std::uint64_t* row_words(int j, int k) const { return words_.data() + row(j, k); }
  std::size_t words_per_row() const { return words_per_row_; }
  /// All words, border rows included; bit index of a cell, and bit strides to the next row and
  /// level.
  const std::vector<std::uint64_t>& words() const { return words_; }
  std::size_t bit(int i, int j, int k) const { return 64 * row(j, k) + std::size_t(i + 1); }
  std::size_t bit(const Cell& c) const { return bit(c[0], c[1], c[2]); }
  std::size_t row_bits() const { return 64 * words_per_row_; }
  std::size_t level_bits() const { return row_bits() * rows_per_level_; }

  /// Cells whose state differs between two grids of the same spec.
  static std::vector<Cell> diff(const VoxelGrid& a, const VoxelGrid& b);

 private:
  void set_run(int i0, int i1, int j, int k, bool is_blocked);
  /// First blocked (or free) cell of row (j, k) from i on; counts[0] where there is none.
  int find(int i, int j, int k, bool is_blocked) const {
    const std::uint64_t* words = row_words(j, k);
    const std::uint64_t flip = is_blocked ? 0 : ~std::uint64_t{0};
    const std::size_t bit = std::size_t(i + 1);
    std::size_t word = bit / 64;
    std::uint64_t rest = (words[word] ^ flip) & (~std::uint64_t{0} << bit % 64);
    while (rest == 0 && ++word < words_per_row_) {
      rest = words[word] ^ flip;
    }
    return rest == 0 ? spec_.counts[0]
                     : std::min(int(64 * word) + std::countr_zero(rest) - 1, spec_.counts[0]);
  }
  std::size_t row(int j, int k) const {
    return (std::size_t(k + 1) * rows_per_level_ + std::size_t(j + 1)) * words_per_row_;
  }
  GridSpec spec_;
  std::size_t words_per_row_;
  std::size_t rows_per_level_;
  std::vector<std::uint64_t> words_;
  std::function<void()> watch_;
};
}  // namespace altiplan
