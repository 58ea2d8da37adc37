// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "altiplan/kit/lattice/lattice.hpp"

namespace altiplan::kit {

/// Lengths of a lattice's steps as integer multiples of a small length, so that sums are exact,
/// equal paths have equal costs, and a cost takes four bytes.
///
/// sqrt 2 and sqrt 3 are irrational; on cubic cells (square ones in level flight) the small length
/// is one at which both are nearly integers, elsewhere it is as small as the longest path allows.
/// `error()` gives the remaining error.
class ALTIPLAN_API StepCosts {
 public:
  enum class Scale {
    fine,    ///< cubes and squares: errors of at most 1e-7; else as fine as 32 bits allow
    finest,  ///< as fine as 32 bits allow: for exact lengths of other legs than steps
    ratio,   ///< small ratios: 41 : 58 : 71 for cubes, 70 : 99 for squares, else about as coarse
  };
  /// Maximum cost of a path, so that the sum of two does not overflow.
  static constexpr std::uint32_t kMax = 2'000'000'000;

  /// Costs of paths up to longest_m; a longer path may exceed kMax.
  StepCosts(const Lattice& lattice, Scale scale, double longest_m);

  std::uint32_t operator[](int d) const { return costs_[std::size_t(d)]; }
  /// Cost nearest to a length.
  std::uint32_t of(double metres) const { return std::uint32_t(std::llround(metres * per_metre_)); }
  /// Cost of the leg that joins a point to a cell; 0 only for none.
  std::uint32_t of_link(double metres) const { return metres > 0 ? std::max(of(metres), 1U) : 0; }
  /// A lower bound of the cost of a path of that length, which falls by no more along a step than
  /// the step costs.
  std::uint32_t at_most(double metres) const { return std::uint32_t(metres * bound_per_metre_); }
  double metres(std::uint32_t cost) const { return cost / per_metre_; }
  /// The scale wanted; finest instead of fine if the points are no cell centres, so that paths
  /// between them begin or end with links of any length.
  static Scale between(Scale wanted, const Lattice& lattice, const Vec3& start, const Vec3& goal);
  /// Length of a path that costs kMax.
  double longest_m() const { return kMax / per_metre_; }
  /// Maximum relative error of a step's cost. A cheapest path is longer than a shortest by at most
  /// twice this fraction.
  double error() const { return error_; }

  /// Cost of the cheapest path between cells at that distance on each axis, if none were blocked
  /// (see Lattice::distance).
  std::uint32_t apart(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    if (!alike_) {
      const std::array<std::uint32_t, 3>& marginal = marginal_[order_of({x, y, z})];
      return x * marginal[0] + y * marginal[1] + z * marginal[2];
    }
    const std::uint32_t maximum = std::max({x, y, z});
    const std::uint32_t minimum = std::min({x, y, z});
    return maximum * along_[1] + (x + y + z - maximum - minimum) * (along_[3] - along_[1]) +
           minimum * (along_[7] - along_[3]);
  }
  std::uint32_t between(const Cell& a, const Cell& b) const {
    return apart(std::uint32_t(std::abs(a[0] - b[0])), std::uint32_t(std::abs(a[1] - b[1])),
                 std::uint32_t(std::abs(a[2] - b[2])));
  }

 private:
  /// Which of the numbers of steps on the axes is larger, of each two.
  static std::size_t order_of(const std::array<std::uint32_t, 3>& n) {
    return std::size_t(n[0] > n[1]) | std::size_t(n[0] > n[2]) << 1 | std::size_t(n[1] > n[2]) << 2;
  }

  std::array<std::uint32_t, kDirections> costs_{};
  std::array<std::uint32_t, 8> along_{};  ///< cost of a step by its set of axes, as bits
  /// By that order: the cost of a step along each axis, beyond that of the steps along those with
  /// more of them.
  std::array<std::array<std::uint32_t, 3>, 8> marginal_{};
  bool alike_ = false;  ///< true if steps along the same number of axes cost the
                        ///< same
  double per_metre_ = 1;
  double bound_per_metre_ = 1;
  double error_ = 0;
};
}  // namespace altiplan::kit
