// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "altiplan/kit/lattice/lattice_search.hpp"

namespace altiplan::dstar_lite {

inline constexpr std::uint32_t kNever = ~std::uint32_t{0};  ///< the cost if there is no path

/// The inputs of a plan. All of them outlive everything built from it.
struct Problem {
  const Request& request;
  const kit::SearchSettings& settings;
  const kit::Lattice& lattice;
  const kit::StepCosts& costs;
};

/// True if the cells that a step passes through, and its direction, decide alone if it is free.
inline bool cells_decide(const Request& request, const kit::SearchSettings& settings) {
  Request each_leg = request;  // constraints on whole routes are checked at the end
  each_leg.limits.max_turn_horizontal = each_leg.limits.max_turn_space = kPi;
  each_leg.limits.min_turn_radius = 0;
  each_leg.limits.max_route_length = kInfinity;
  return settings.moves == kit::MoveCheck::cells && kit::MoveRules::cells_decide(each_leg);
}

/// Cells from low to high, both inclusive.
struct CellRange {
  Cell low{1, 1, 1};
  Cell high{0, 0, 0};  ///< below low on an axis: no cells

  std::size_t count() const {
    std::size_t cells = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cells *= std::size_t(std::max(high[axis] - low[axis] + 1, 0));
    }
    return cells;
  }
  void add(const CellRange& other) {
    const bool empty = count() == 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = empty ? other.low[axis] : std::min(low[axis], other.low[axis]);
      high[axis] = empty ? other.high[axis] : std::max(high[axis], other.high[axis]);
    }
  }
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (int k = low[2]; k <= high[2]; ++k) {
      for (int j = low[1]; j <= high[1]; ++j) {
        for (int i = low[0]; i <= high[0]; ++i) {
          visit(Cell{i, j, k});
        }
      }
    }
  }
};

/// A cell and those around it.
inline CellRange around(const Cell& c, const kit::Lattice& lattice) {
  CellRange range{c, c};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    range.low[axis] = std::max(c[axis] - 1, 0);
    range.high[axis] = std::min(c[axis] + 1, lattice.spec().counts[axis] - 1);
  }
  return range;
}

/// The cells that a box intersects, and their neighbours.
inline CellRange cells_in(const Box& box, const kit::Lattice& lattice) {
  const GridSpec& spec = lattice.spec();
  CellRange range;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = std::size_t(axis);
    const auto cell = [&](double at, double more) {
      const double index = std::floor((at - spec.origin[axis]) / spec.cell[axis]) + more;
      return int(std::clamp(index, -1.0, double(spec.counts[a])));
    };
    range.low[a] = std::max(cell(box.min[axis], -1), 0);
    range.high[a] = std::min(cell(box.max[axis], 1), spec.counts[a] - 1);
  }
  return range;
}

/// The heuristic: minimum cost between the start and a cell if no cell were blocked.
class ToStart {
 public:
  explicit ToStart(const Problem& problem) : costs_(problem.costs) {}

  /// Must not be called without any link.
  void move(const std::vector<kit::Lattice::Link>& links, const Problem& problem) {
    others_.clear();
    for (const kit::Lattice::Link& link : links) {
      others_.push_back({link.cell, problem.costs.of_link(link.length)});
    }
    first_ = others_.back();  // usually the only one
    others_.pop_back();
  }
  std::uint32_t operator()(const Cell& c) const {
    std::uint32_t minimum = costs_.between(c, first_.cell) + first_.cost;
    for (const End& end : others_) {
      minimum = std::min(minimum, costs_.between(c, end.cell) + end.cost);
    }
    return minimum;
  }

 private:
  struct End {
    Cell cell;
    std::uint32_t cost;
  };
  const kit::StepCosts& costs_;
  End first_{};
  std::vector<End> others_;
};
}  // namespace altiplan::dstar_lite
