// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "altiplan/kit/scratch.hpp"
#include "problem.hpp"

namespace altiplan::dstar_lite {

struct VertexMemory {
  kit::ScratchArray<std::uint64_t> values;  ///< g and rhs by vertex, complements: 0 is never
  kit::ScratchArray<std::uint64_t> opened;  ///< a bit a cell, laid out like an occupancy

  /// Rounded up, for one vertex a cell.
  static constexpr std::size_t kBytesPerCell = 9;
};

/// What a search knows of vertices, and where on the lattice it has been.
class Vertices {
 public:
  struct Values {
    std::uint32_t g;
    std::uint32_t rhs;
  };

  /// `layout` lays out the bits of cells; all of it must outlive the vertices.
  Vertices(std::size_t count, const VoxelGrid& layout, VertexMemory& memory)
      : values_(memory.values), opened_(memory.opened), layout_(layout) {
    values_.reset(count);
    opened_.reset(layout.words().size());
  }

  Values operator[](std::uint32_t s) const {
    const std::uint64_t word = values_[s];
    return {~std::uint32_t(word), ~std::uint32_t(word >> 32)};
  }
  std::uint32_t g(std::uint32_t s) const { return ~std::uint32_t(values_[s]); }
  void set(std::uint32_t s, const Values& values) {
    values_.at(s) = std::uint64_t{~values.rhs} << 32 | std::uint32_t(~values.g);
  }
  /// Asks the memory for what is known of a vertex.
  void fetch(std::uint32_t s) const { __builtin_prefetch(values_.data() + s); }
  void forget(std::uint32_t s) {
    if (values_[s] != 0) {
      set(s, {kNever, kNever});
    }
  }

  /// Notes that a vertex of the cell was opened.
  void open(const Cell& c) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      known_.low[axis] = std::min(known_.low[axis], c[axis] - 1);
      known_.high[axis] = std::max(known_.high[axis], c[axis] + 1);
    }
    const std::size_t bit = layout_.bit(c);
    opened_.at(bit / 64) |= std::uint64_t{1} << bit % 64;
  }
  /// Notes that vertices of the cell have values without that.
  void know(const Cell& c) { known_.add({c, c}); }
  /// No vertex of another cell has any values.
  const CellRange& known() const { return known_; }
  /// The cells that were opened, among one and those around it.
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
  CellRange known_;
};
}  // namespace altiplan::dstar_lite
