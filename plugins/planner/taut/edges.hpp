// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <optional>
#include <vector>

#include "altiplan/voxel_grid.hpp"

namespace altiplan::taut {

/// An edge at which closed cells stand out into free ones: a shortest route bends there and at
/// corners where two free cells meet, nowhere else.
struct Edge {
  int axis = 0;  ///< along which it runs
  Vec3 low;      ///< its ends
  Vec3 high;
  /// On the two axes after that: where the closed cells lie, upwards (1) or downwards (-1); 0: at a
  /// corner.
  std::array<int, 2> closed{};

  bool is_corner() const { return closed[0] == 0; }
};

/// Finds the edges of a grid, 64 cells of a row at a time.
class EdgeFinder {
 public:
  /// On a level, if there is one, the upright edges of the grid's cells are points.
  EdgeFinder(const VoxelGrid& grid, std::optional<double> level) : grid_(grid), level_(level) {}

  std::vector<Edge> edges() {
    const Cell& counts = grid_.spec().counts;
    for (int k = 0; k < counts[2]; ++k) {
      for (int j = 0; j < counts[1]; ++j) {
        for (std::size_t word = 0; word < grid_.words_per_row(); ++word) {
          const std::uint64_t corners = mixed(j, k, word);
          for (std::size_t axis = level_ ? 2 : 0; corners != 0 && axis < 3; ++axis) {
            for (unsigned quadrant = 0; quadrant < 4; ++quadrant) {
              const std::uint64_t starts = standing(axis, quadrant, j, k, word) &
                                           ~standing_before(axis, quadrant, j, k, word);
              for_each_cell(starts, word, [&](int i) { add(axis, quadrant, {i, j, k}); });
            }
          }
          if (!level_) {
            for_each_cell(corners, word, [&](int i) { add_corner({i, j, k}); });
          }
        }
      }
    }
    return std::move(edges_);
  }

 private:
  template <class Visit>
  void for_each_cell(std::uint64_t bits, std::size_t word, const Visit& visit) const {
    for (; bits != 0; bits &= bits - 1) {
      const int i = int(64 * word) + std::countr_zero(bits) - 1;
      if (i >= 0 && i < grid_.spec().counts[0]) {
        visit(i);
      }
    }
  }
  /// Blocked cells of row (j, k), or (`lower`) their neighbours above.
  std::uint64_t row(int j, int k, std::size_t word, bool lower) const {
    const std::uint64_t* words = grid_.row_words(j, k);
    return lower ? words[word] << 1 | (word > 0 ? words[word - 1] >> 63 : 0) : words[word];
  }
  /// Cells along whose lower edge on the axis cells of that quadrant are blocked, and those of both
  /// next to it are free.
  std::uint64_t standing(std::size_t axis, unsigned quadrant, int j, int k,
                         std::size_t word) const {
    const auto closed = [&](unsigned q) {
      std::array<int, 3> by{};
      by[(axis + 1) % 3] = (q & 1) != 0 ? 0 : -1;
      by[(axis + 2) % 3] = (q & 2) != 0 ? 0 : -1;
      return row(j + by[1], k + by[2], word, by[0] < 0);
    };
    return closed(quadrant) & ~closed(quadrant ^ 1) & ~closed(quadrant ^ 2);
  }
  std::uint64_t standing_before(std::size_t axis, unsigned quadrant, int j, int k,
                                std::size_t word) const {
    if (axis == 0) {
      return standing(axis, quadrant, j, k, word) << 1 |
             (word > 0 ? standing(axis, quadrant, j, k, word - 1) >> 63 : 0);
    }
    const bool is_first = (axis == 1 ? j : k) == 0;
    return is_first ? 0
                    : standing(axis, quadrant, axis == 1 ? j - 1 : j, axis == 2 ? k - 1 : k, word);
  }
  bool stands_at(std::size_t axis, unsigned quadrant, const Cell& c) const {
    const int bit = c[0] + 1;
    return c[axis] < grid_.spec().counts[axis] &&
           (standing(axis, quadrant, c[1], c[2], std::size_t(bit / 64)) >> bit % 64 & 1) != 0;
  }
  void add(std::size_t axis, unsigned quadrant, Cell c) {
    Edge edge{int(axis), low_corner(c), {}, {}};
    edge.closed = {(quadrant & 1) != 0 ? 1 : -1, (quadrant & 2) != 0 ? 1 : -1};
    for (; stands_at(axis, quadrant, c); ++c[axis]) {
    }
    edge.high = low_corner(c);
    if (level_) {
      edge.low.z() = edge.high.z() = *level_;
    }
    edges_.push_back(edge);
  }

  /// Cells at whose lower corner both free and blocked cells meet.
  std::uint64_t mixed(int j, int k, std::size_t word) const {
    std::uint64_t any = 0;
    std::uint64_t all = ~std::uint64_t{0};
    for (unsigned n = 0; n < 8; ++n) {
      const std::uint64_t one = row(j - int(n >> 1 & 1), k - int(n >> 2), word, (n & 1) != 0);
      any |= one;
      all &= one;
    }
    return any & ~all;
  }
  /// Adds the lower corner of the cell if two free cells meet in it alone: a route may bend there
  /// and at no edge.
  void add_corner(const Cell& c) {
    unsigned free = 0;  // of the eight cells
    for (unsigned n = 0; n < 8; ++n) {
      const bool is_free =
          !grid_.blocked(c[0] - int(n & 1), c[1] - int(n >> 1 & 1), c[2] - int(n >> 2));
      free |= is_free ? 1U << n : 0;
    }
    for (unsigned n = 0; n < 4; ++n) {
      if (free == (1U << n | 0x80U >> n)) {
        edges_.push_back({0, low_corner(c), low_corner(c), {}});
      }
    }
  }
  Vec3 low_corner(const Cell& c) const { return grid_.spec().cell_box(c).min; }

  const VoxelGrid& grid_;
  std::optional<double> level_;
  std::vector<Edge> edges_;
};
}  // namespace altiplan::taut
