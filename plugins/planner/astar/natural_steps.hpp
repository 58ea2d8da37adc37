// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>

#include "altiplan/kit/lattice/lattice.hpp"
#include "altiplan/kit/lattice/step_costs.hpp"

namespace altiplan::astar {

/// By the step into a cell, its successors if all steps between the cells around it are free: those
/// that no other path from the preceding cell, around the cell, reaches at less cost, or at the
/// same cost by a last step that comes earlier in a fixed order. Whatever the parents of cells, a
/// cell keeps a predecessor on a shortest path from which it is not pruned: of those, the one with
/// the earliest last step.
///
/// For all steps of a box's neighbourhood that is D. Harabor, A. Grastien, Online Graph Pruning for
/// Pathfinding on Grid Maps, AAAI 2011, doi:10.1609/aaai.v25i1.7994, in 3-D (kNatural, without a
/// table to make); a limit on climbs leaves fewer steps, and so fewer ways around.
class NaturalSteps {
 public:
  NaturalSteps(kit::DirectionMask steps, const kit::StepCosts& costs) {
    for (int in = 0; in < kit::kDirections; ++in) {
      for (kit::DirectionMask left = steps; left != 0; left &= left - 1) {
        const int out = std::countr_zero(left);
        const bool is_needed = in == kit::kHere || is_natural(in, out, steps, costs);
        kept_[std::size_t(in)] |= kit::DirectionMask(is_needed) << out;
      }
    }
  }
  kit::DirectionMask operator[](int in) const { return kept_[std::size_t(in)]; }

 private:
  static int axes(int d) {
    const Cell o = kit::offset(d);
    return std::abs(o[0]) + std::abs(o[1]) + std::abs(o[2]);
  }
  /// True if the step comes before the other: the one along fewer axes.
  static bool is_earlier(int d, int other) {
    return axes(d) != axes(other) ? axes(d) < axes(other) : d < other;
  }

  /// True if the cell `between` is beside `here`, and on the lattice because the cell before, at 0,
  /// `here` and `end` are: between them on each axis.
  static bool is_around(const Cell& between, const Cell& here, const Cell& end) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [low, high] = std::minmax({0, here[axis], end[axis]});
      if (between[axis] < low || between[axis] > high || std::abs(between[axis] - here[axis]) > 1) {
        return false;
      }
    }
    return true;
  }

  static bool is_natural(int in, int out, kit::DirectionMask steps, const kit::StepCosts& costs) {
    const Cell a = kit::offset(in);
    const Cell b = kit::offset(out);
    const Cell end = {a[0] + b[0], a[1] + b[1], a[2] + b[2]};  // from the preceding cell
    if (end == Cell{0, 0, 0}) {
      return false;
    }
    const auto is_step = [&](const Cell& o) {
      return std::abs(o[0]) <= 1 && std::abs(o[1]) <= 1 && std::abs(o[2]) <= 1 &&
             (steps >> kit::direction(o[0], o[1], o[2]) & 1) != 0;
    };
    const std::uint32_t cost = costs[in] + costs[out];
    if (is_step(end) && costs[kit::direction(end[0], end[1], end[2])] <= cost) {
      return false;
    }
    for (kit::DirectionMask left = steps; left != 0; left &= left - 1) {
      const int first = std::countr_zero(left);
      const Cell o = kit::offset(first);
      const Cell rest = {end[0] - o[0], end[1] - o[1], end[2] - o[2]};
      if (first == in || !is_around(o, a, end) || !is_step(rest)) {
        continue;
      }
      const int last = kit::direction(rest[0], rest[1], rest[2]);
      const std::uint32_t around = costs[first] + costs[last];
      if (around < cost || (around == cost && is_earlier(last, out))) {
        return false;
      }
    }
    return true;
  }

  std::array<kit::DirectionMask, kit::kDirections> kept_{};
};
}  // namespace altiplan::astar
