// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include "altiplan/plan_result.hpp"
#include "altiplan/request.hpp"

namespace altiplan::kit {

enum class Neighbourhood {
  faces,  ///< 6 neighbours, 4 in level flight
  all,    ///< 26 neighbours, 8 in level flight
};

enum class CornerRule {
  any,       ///< a step needs its two cells free
  free_box,  ///< a step needs every cell of its bounding box free
};

/// Directions to the neighbours of a cell are numbered x fastest, with the cell itself in the
/// middle; a set of directions or neighbours is a mask with one bit each.
using DirectionMask = std::uint32_t;
inline constexpr int kDirections = 27;
inline constexpr int kHere = 13;
constexpr int direction(int dx, int dy, int dz) { return (dx + 1) + 3 * (dy + 1) + 9 * (dz + 1); }
constexpr Cell offset(int d) { return {d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1}; }
constexpr int opposite(int d) { return kDirections - 1 - d; }
/// The directions, including the cell itself, whose offset satisfies `holds`.
template <class Holds>
constexpr DirectionMask directions_where(const Holds& holds) {
  DirectionMask mask = 0;
  for (int d = 0; d < kDirections; ++d) {
    mask |= holds(offset(d)) ? DirectionMask{1} << d : 0;
  }
  return mask;
}
inline constexpr DirectionMask kLevelDirections =
    directions_where([](const Cell& o) { return o[2] == 0; });
/// Directions along one, two and three axes.
inline constexpr std::array<DirectionMask, 3> kAlongAxes = [] {
  const auto along = [](int axes) {
    return directions_where(
        [axes](const Cell& o) { return (o[0] != 0) + (o[1] != 0) + (o[2] != 0) == axes; });
  };
  return std::array{along(1), along(2), along(3)};
}();

/// The opposite directions.
constexpr DirectionMask reversed(DirectionMask mask) {
  mask = (mask & 0x55555555) << 1 | (mask >> 1 & 0x55555555);
  mask = (mask & 0x33333333) << 2 | (mask >> 2 & 0x33333333);
  mask = (mask & 0x0F0F0F0F) << 4 | (mask >> 4 & 0x0F0F0F0F);
  return __builtin_bswap32(mask) >> (32 - kDirections);
}

/// Indices of the cells of a box, x fastest.
class CellIndex {
 public:
  CellIndex() = default;
  explicit CellIndex(const Cell& counts)
      : counts_(counts), per_row_(divisor(counts[0])), per_level_(divisor(counts[1])) {}

  std::size_t size() const {
    return std::size_t(counts_[0]) * std::size_t(counts_[1]) * std::size_t(counts_[2]);
  }
  std::uint32_t index(const Cell& c) const {
    return std::uint32_t((std::size_t(c[2]) * std::size_t(counts_[1]) + std::size_t(c[1])) *
                             std::size_t(counts_[0]) +
                         std::size_t(c[0]));
  }
  Cell cell(std::uint32_t index) const {
    const std::uint32_t row = divided(index, per_row_);
    const std::uint32_t level = divided(row, per_level_);
    return {int(index - row * std::uint32_t(counts_[0])),
            int(row - level * std::uint32_t(counts_[1])), int(level)};
  }
  /// Index difference to the neighbour.
  std::int64_t stride(int d) const {
    const Cell o = offset(d);
    return (std::int64_t(o[2]) * counts_[1] + o[1]) * counts_[0] + o[0];
  }

 private:
  /// floor((2^64 - 1) / d), and n / d by it: a division would be the most expensive part of a step.
  static std::uint64_t divisor(int d) { return ~std::uint64_t{0} / std::uint64_t(d); }
  static std::uint32_t divided(std::uint32_t n, std::uint64_t divisor) {
    __extension__ using Wide = unsigned __int128;
    return std::uint32_t((Wide(divisor) * n + divisor) >> 64);
  }

  Cell counts_{};
  std::uint64_t per_row_ = 0;
  std::uint64_t per_level_ = 0;
};

/// Memory limit of a search, and its memory per cell, in bytes.
struct LatticeMemory {
  std::size_t max_bytes = ~std::size_t{0};
  std::size_t bytes_per_cell = 1;
};

/// The cells of a grid search. The start is the centre of a cell, unless a layer has its own cells,
/// which are then used. Centres lie within the request's volume and its altitude bands over sea;
/// level flight has one layer of cells, whose nodes are at level_m.
class ALTIPLAN_API Lattice {
 public:
  /// Throws ParameterError("cell_m", …) if the cells would need more memory than allowed.
  Lattice(const Request& request, const Vec3& cell_m, Neighbourhood neighbourhood,
          const LatticeMemory& memory);

  const GridSpec& spec() const { return spec_; }
  /// Position of the vehicle at the cell.
  Vec3 position(const Cell& c) const {
    Vec3 p = spec_.centre(c);
    if (level_m_) {
      p.z() = *level_m_;
    }
    return p;
  }
  std::size_t size() const { return spec_.cell_count(); }
  std::uint32_t index(const Cell& c) const { return numbers_.index(c); }
  Cell cell(std::uint32_t index) const { return numbers_.cell(index); }

  /// Directions of the neighbourhood.
  DirectionMask steps() const { return steps_; }
  /// Directions whose cell is on the lattice.
  DirectionMask inside(const Cell& c) const;
  Vec3 step(int d) const {
    const Cell o = offset(d);
    return spec_.cell.cwiseProduct(Vec3(o[0], o[1], o[2]));
  }
  double step_length(int d) const { return lengths_[std::size_t(d)]; }
  /// Index difference to the neighbour.
  std::int64_t stride(int d) const { return strides_[std::size_t(d)]; }

  /// Length of the shortest path between two cells if none were blocked, exactly.
  ///
  /// With all neighbours a path of n_i cells on axis i is a sum of steps, each along a set S of
  /// axes with length L(S) = sqrt(sum of squared edges). L is the root of a modular function, hence
  /// submodular, so the cheapest sum is its Lovász extension: take as many steps along all three
  /// axes as the smallest n_i, then along the two that remain, then along the last. That holds for
  /// cells of any shape, and being a norm it makes a consistent heuristic.
  double distance(const Cell& a, const Cell& b) const;

  /// A cell, and the length of the straight leg between a point and its centre.
  struct Link {
    Cell cell;
    double length;
  };
  /// The cell with its centre nearest to the point; a boundary cell for a point outside. The length
  /// is 0 if the point is that centre within the judge's tolerance.
  Link nearest(const Vec3& p) const;
  /// Connections of a point to the lattice: its own cell alone where it is that cell's centre, else
  /// every cell at most one edge away from it on each axis.
  std::vector<Link> links(const Vec3& p) const { return links(p, 1); }
  /// The same with every cell at most that many edges away.
  std::vector<Link> links(const Vec3& p, int edges) const;

 private:
  GridSpec spec_;
  CellIndex numbers_;
  std::optional<double> level_m_;
  Neighbourhood neighbourhood_;
  DirectionMask steps_ = 0;
  std::array<double, kDirections> lengths_{};
  std::array<std::int64_t, kDirections> strides_{};
};

/// The result of a search whose cells alone need more than the budget's memory; nothing if they
/// fit.
ALTIPLAN_API std::optional<PlanResult> beyond_budget(const Lattice& lattice,
                                                     std::size_t bytes_per_cell,
                                                     const Budget& budget);

/// Bits of the cell at bit number `at` and its neighbours, in an array laid out like the grid's
/// words; with kLevel only those of its own level.
template <bool kLevel = false>
DirectionMask bits_around(const VoxelGrid& grid, const std::uint64_t* words, std::size_t at) {
  const auto row = [&](std::size_t bit) {
    const std::uint64_t window = words[bit / 64] >> bit % 64;
    return DirectionMask(
        (bit % 64 > 61 ? window | words[bit / 64 + 1] << (64 - bit % 64) : window) & 7);
  };
  const auto level = [&](std::size_t bit) {
    return row(bit - grid.row_bits()) | row(bit) << 3 | row(bit + grid.row_bits()) << 6;
  };
  const DirectionMask own = level(at - 1) << 9;
  return kLevel ? own
                : level(at - 1 - grid.level_bits()) | own | level(at - 1 + grid.level_bits()) << 18;
}

/// The blocked cells among c and its 26 neighbours.
inline DirectionMask blocked_around(const VoxelGrid& grid, const Cell& c) {
  return bits_around(grid, grid.words().data(), grid.bit(c));
}

/// Directions in which a step is free under the rule, given the blocked neighbours.
inline DirectionMask free_steps(DirectionMask blocked, CornerRule rule) {
  // Neighbours with offset 0 on each axis, and the stride between neighbours on it.
  constexpr auto kLevelWith = [](std::size_t axis) {
    return directions_where([axis](const Cell& o) { return o[axis] == 0; });
  };
  constexpr std::array<DirectionMask, 3> kLevel = {kLevelWith(0), kLevelWith(1), kLevelWith(2)};
  constexpr std::array<int, 3> kApart = {1, 3, 9};
  constexpr DirectionMask kMiddle = DirectionMask{1} << kHere;
  if ((blocked & kMiddle) != 0) {
    return 0;
  }
  if (rule == CornerRule::free_box) {  // a blocked cell closes every step whose bounding box
                                       // contains it
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const DirectionMask level = blocked & kLevel[axis];
      blocked |= level << kApart[axis] | level >> kApart[axis];
    }
  }
  return ~(blocked | kMiddle) & ((DirectionMask{1} << kDirections) - 1);
}
}  // namespace altiplan::kit
