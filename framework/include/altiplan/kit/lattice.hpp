// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "altiplan/request.hpp"

namespace altiplan::kit {

enum class Neighbourhood {
  faces,  ///< 6 neighbours, 4 in level flight
  all,    ///< 26 neighbours, 8 in level flight
};

enum class CornerRule {
  any,       ///< a step needs its two cells free
  free_box,  ///< a step needs every cell of the box that it spans free
};

/// Directions to the cells around one are numbered x fastest, the cell itself in the middle; a set
/// of them, or of those cells, is a mask with a bit for each.
using DirectionMask = std::uint32_t;
inline constexpr int kDirections = 27;
inline constexpr int kHere = 13;
constexpr int direction(int dx, int dy, int dz) { return (dx + 1) + 3 * (dy + 1) + 9 * (dz + 1); }
constexpr Cell offset(int d) { return {d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1}; }
constexpr int opposite(int d) { return kDirections - 1 - d; }

/// How many bytes a search may keep, and how many it keeps for each cell.
struct LatticeMemory {
  std::size_t max_bytes = ~std::size_t{0};
  std::size_t bytes_per_cell = 1;
};

/// The cells of a grid search. The start is the centre of a cell, unless a layer has cells of its
/// own: those are taken then. Centres lie within the request's volume and its altitude bands over
/// sea; level flight has one layer of cells, whose nodes are at level_m.
class ALTIPLAN_API Lattice {
 public:
  /// Throws ParameterError("cell_m", …) when the cells would need more memory than allowed.
  Lattice(const Request& request, const Vec3& cell_m, Neighbourhood neighbourhood,
          const LatticeMemory& memory);

  const GridSpec& spec() const { return spec_; }
  /// Where the vehicle is when it is at the cell.
  Vec3 position(const Cell& c) const {
    Vec3 p = spec_.centre(c);
    if (level_m_) {
      p.z() = *level_m_;
    }
    return p;
  }
  std::size_t size() const { return spec_.cell_count(); }
  std::uint32_t index(const Cell& c) const {
    return std::uint32_t((std::size_t(c[2]) * std::size_t(spec_.counts[1]) + std::size_t(c[1])) *
                             std::size_t(spec_.counts[0]) +
                         std::size_t(c[0]));
  }
  Cell cell(std::uint32_t index) const;

  /// Directions of the neighbourhood.
  DirectionMask steps() const { return steps_; }
  /// Directions whose cell is on the lattice.
  DirectionMask inside(const Cell& c) const;
  Vec3 step(int d) const {
    const Cell o = offset(d);
    return spec_.cell.cwiseProduct(Vec3(o[0], o[1], o[2]));
  }
  double step_length(int d) const { return lengths_[std::size_t(d)]; }
  /// Difference of index to the neighbour.
  std::int64_t stride(int d) const { return strides_[std::size_t(d)]; }

  /// Length of the shortest route between two cells if none were blocked, exactly.
  ///
  /// With all neighbours a route of n_i cells on axis i is a sum of steps, each along a set S of
  /// axes with length L(S) = sqrt(sum of squared edges). L is the root of a modular function, hence
  /// submodular, so the cheapest sum is its Lovász extension: take as many steps along all three
  /// axes as the least n_i, then along the two that remain, then along the last. That holds for
  /// cells of any shape, and being a norm it makes a consistent heuristic.
  double distance(const Cell& a, const Cell& b) const;

  /// A cell, and the length of the straight leg between a point and its centre.
  struct Link {
    Cell cell;
    double length;
  };
  /// How a point joins the lattice: by its own cell alone where it is that cell's centre, else by
  /// every cell at most one edge away from it on each axis.
  std::vector<Link> links(const Vec3& p) const;

 private:
  GridSpec spec_;
  std::optional<double> level_m_;
  Neighbourhood neighbourhood_;
  DirectionMask steps_ = 0;
  std::array<double, kDirections> lengths_{};
  std::array<std::int64_t, kDirections> strides_{};
};

/// The blocked ones among the 27 cells at and around c.
ALTIPLAN_API DirectionMask blocked_around(const VoxelGrid& grid, const Cell& c);

/// Directions in which a step is free under the rule, given the blocked cells around.
ALTIPLAN_API DirectionMask free_steps(DirectionMask blocked, CornerRule rule);
}  // namespace altiplan::kit
