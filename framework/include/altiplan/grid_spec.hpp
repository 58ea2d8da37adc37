// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// Index of a cell on each axis.
using Cell = std::array<int, 3>;

/// Cells of a grid, and when a cell is blocked.
struct ALTIPLAN_API GridSpec {
  /// touched: an obstacle, grown by `inflation`, overlaps the open cell; centre: it covers the
  /// cell's centre; native: the layer's own cells, unchanged.
  enum class Rule { touched, centre, native };

  Vec3 origin{0, 0, 0};  ///< lower corner of cell (0, 0, 0), metres
  Vec3 cell{1, 1, 1};    ///< edge lengths, metres
  Cell counts{1, 1, 1};
  double inflation = 0;  ///< metres
  Rule rule = Rule::touched;

  Vec3 centre(const Cell& c) const {
    return origin + cell.cwiseProduct(Vec3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5));
  }
  /// The cell that contains p (on a face: the upper one); may lie outside the grid.
  Cell cell_of(const Vec3& p) const;
  bool holds(const Cell& c) const {
    return c[0] >= 0 && c[1] >= 0 && c[2] >= 0 && c[0] < counts[0] && c[1] < counts[1] &&
           c[2] < counts[2];
  }
  std::size_t cell_count() const {
    return std::size_t(counts[0]) * std::size_t(counts[1]) * std::size_t(counts[2]);
  }
  Box box() const {
    return {origin, origin + cell.cwiseProduct(Vec3(counts[0], counts[1], counts[2]))};
  }
  /// Box of one cell.
  Box cell_box(const Cell& c) const {
    const Vec3 low = origin + cell.cwiseProduct(Vec3(c[0], c[1], c[2]));
    return {low, low + cell};
  }
  friend bool operator==(const GridSpec&, const GridSpec&) = default;
};
}  // namespace altiplan
