// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "altiplan/kit/lattice/lattice.hpp"
#include "altiplan/kit/lattice/search_params.hpp"
#include "altiplan/kit/lattice/step_costs.hpp"
#include "altiplan/planner.hpp"

namespace altiplan::kit {

/// The heuristic of a search over cells whose costs are integers.
class CellEstimate {
 public:
  /// A cell from which the goal is one leg away.
  struct Link {
    std::uint32_t index;
    std::uint32_t cost;
    Cell cell;
  };

  /// `lattice` and `costs` must outlive it.
  CellEstimate(const Lattice& lattice, const StepCosts& costs, Heuristic heuristic,
               const Goal& goal)
      : lattice_(lattice), costs_(costs), heuristic_(heuristic), goal_(goal) {
    for (const Lattice::Link& link : lattice.links(goal.position)) {
      links_.push_back({lattice.index(link.cell), costs.of_link(link.length), link.cell});
    }
    is_octile_to_cell_ = heuristic == Heuristic::octile && links_.size() == 1;
  }

  const std::vector<Link>& links() const { return links_; }

  /// Lower bound of the cost from the cell to the goal (except for `manhattan`); kLevel: on a
  /// lattice of one level.
  template <bool kLevel>
  std::uint32_t at(int x, int y, int z) const {
    if (is_octile_to_cell_) {
      const auto& [index, cost, cell] = links_.front();
      return costs_.apart(std::uint32_t(std::abs(x - cell[0])),
                          std::uint32_t(std::abs(y - cell[1])),
                          kLevel ? 0 : std::uint32_t(std::abs(z - cell[2]))) +
             cost;
    }
    return other({x, y, z});
  }

 private:
  [[gnu::noinline]] std::uint32_t other(const Cell& c) const {
    if (heuristic_ == Heuristic::octile && !links_.empty()) {
      std::uint32_t minimum = ~std::uint32_t{0};
      for (const Link& link : links_) {
        minimum = std::min(minimum, costs_.between(c, link.cell) + link.cost);
      }
      return minimum;
    }
    const Vec3 way = lattice_.position(c) - goal_.position;
    switch (heuristic_) {
      case Heuristic::octile:  // only the goal's tolerance is on the lattice
        return costs_.at_most(std::max(0.0, way.norm() - goal_.tolerance_m));
      case Heuristic::euclidean:
        return costs_.at_most(way.norm());
      case Heuristic::manhattan:
        return costs_.of(way.lpNorm<1>());
      case Heuristic::zero:
        break;
    }
    return 0;
  }

  const Lattice& lattice_;
  const StepCosts& costs_;
  Heuristic heuristic_;
  Goal goal_;
  std::vector<Link> links_;
  bool is_octile_to_cell_ = false;
};
}  // namespace altiplan::kit
