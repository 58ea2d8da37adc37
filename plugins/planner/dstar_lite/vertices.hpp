// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "altiplan/kit/scratch.hpp"
#include "problem.hpp"

namespace altiplan::dstar_lite {

struct VertexMemory {
  kit::ScratchArray<std::uint64_t> values;  ///< g and rhs by vertex, complements: 0 is never
  kit::ScratchArray<std::uint64_t> opened;  ///< one bit per cell, laid out like an occupancy

  /// Rounded up, for one vertex per cell.
  static constexpr std::size_t kBytesPerCell = 9;
};

/// State of the vertices, and the region of the lattice that the search has visited.
class Vertices {
 public:
  struct Values {
    std::uint32_t g;
    std::uint32_t rhs;
  };

  /// `layout` defines the layout of the cells' bits; all arguments must outlive the vertices.
  Vertices(std::size_t count, const VoxelGrid& layout, VertexMemory& memory)
      : values_(memory.values), opened_(memory.opened), layout_(layout) {
    values_.reset(count);
    opened_.reset(layout.words().size());
    known_.assign(std::size_t(layout.spec().counts[2]), {layout.spec().counts, {-1, -1, -1}});
  }

  Values operator[](std::uint32_t s) const {
    const std::uint64_t word = values_[s];
    return {~std::uint32_t(word), ~std::uint32_t(word >> 32)};
  }
  std::uint32_t g(std::uint32_t s) const { return ~std::uint32_t(values_[s]); }
  void set(std::uint32_t s, const Values& values) {
    values_.at(s) = std::uint64_t{~values.rhs} << 32 | std::uint32_t(~values.g);
  }
  /// Prefetches the state of a vertex.
  void fetch(std::uint32_t s) const { __builtin_prefetch(values_.data() + s); }
  void forget(std::uint32_t s) {
    if (values_[s] != 0) {
      set(s, {kNever, kNever});
    }
  }

  /// Records that vertices of the cell have values.
  void know(const Cell& c) {
    CellRange& range = known_[std::size_t(c[2])];
    for (std::size_t axis = 0; axis < 2; ++axis) {
      range.low[axis] = std::min(range.low[axis], c[axis]);
      range.high[axis] = std::max(range.high[axis], c[axis]);
    }
  }
  /// Records that a vertex of the cell was expanded.
  void open(const Cell& c) {
    know(c);
    const std::size_t bit = layout_.bit(c);
    opened_.at(bit / 64) |= std::uint64_t{1} << bit % 64;
  }
  /// No vertex of any cell outside this range on that level has a value.
  CellRange known(int level) const {
    CellRange range{layout_.spec().counts, {-1, -1, -1}};
    const int top = int(known_.size()) - 1;
    for (int k = std::max(level - 1, 0); k <= std::min(level + 1, top); ++k) {
      for (std::size_t axis = 0; axis < 2; ++axis) {  // neighbours of expanded cells have values
        range.low[axis] = std::min(range.low[axis], known_[std::size_t(k)].low[axis] - 1);
        range.high[axis] = std::max(range.high[axis], known_[std::size_t(k)].high[axis] + 1);
      }
    }
    range.low[2] = range.high[2] = level;
    return range;
  }
  /// The expanded cells among a cell and its neighbours.
  kit::DirectionMask opened_around(const Cell& c) const {
    return kit::bits_around(layout_, opened_.data(), layout_.bit(c));
  }
  template <class Visit>
  void for_each_opened(const Visit& visit) const {
    const Cell& counts = layout_.spec().counts;
    for (int k = 0; k < counts[2]; ++k) {
      for (int j = 0; j < counts[1]; ++j) {
        const std::size_t row = layout_.bit(-1, j, k) / 64;
        for (std::size_t word = 0; word < layout_.words_per_row(); ++word) {
          for (std::uint64_t bits = opened_[row + word]; bits != 0; bits &= bits - 1) {
            visit(Cell{int(64 * word) + std::countr_zero(bits) - 1, j, k});
          }
        }
      }
    }
  }

 private:
  kit::ScratchArray<std::uint64_t>& values_;
  kit::ScratchArray<std::uint64_t>& opened_;
  const VoxelGrid& layout_;
  std::vector<CellRange> known_;  ///< by level, without the neighbours of the expanded cells
};
}  // namespace altiplan::dstar_lite
