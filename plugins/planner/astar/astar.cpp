// SPDX-License-Identifier: Apache-2.0
// A* on a lattice.
//
// Citation: P. E. Hart, N. J. Nilsson, B. Raphael: A Formal Basis for the Heuristic Determination
//   of Minimum Cost Paths. IEEE Transactions on Systems Science and Cybernetics 4(2), 1968,
//   doi:10.1109/TSSC.1968.300136. Weights f = w_g g + w_h h: I. Pohl, Artificial Intelligence 1,
//   1970, doi:10.1016/0004-3702(70)90007-X.
// Guarantees: complete and optimal on its lattice while the heuristic is octile, euclidean or zero,
//   w_h <= w_g (manhattan: w_h sqrt(axes) <= w_g) and costs are summed; under limits on turns too,
//   by (cell, heading).
// Complexity: O(n log n) time, O(n) memory in the cells of the lattice; by (cell, heading) in the
//   steps between them.
// Deviations: moves are judged, not only cells; start and goal join the lattice by straight links;
//   limits on turns are held against the single parent of a cell first, which is incomplete; a
//   closed node is never opened again; where cells decide alone (cell_search.hpp) lengths are whole
//   numbers (kit::StepCosts), and successors that another way reaches as cheaply are left out.
// Symbols: g travelled cost, h heuristic, f = w_g g + w_h h.
#include <memory>

#include "altiplan/kit/lattice/heading_search.hpp"
#include "altiplan/kit/lattice/search_params.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "astar_search.hpp"
#include "cell_search.hpp"

namespace {

using namespace altiplan;
using kit::SearchResult;
using kit::MoveCheck;
using kit::SearchSettings;

struct Params : kit::SearchParams {
  void describe(Fields& f) {
    SearchParams::describe(f);
    f("costs", search.costs,
      {{"exact", kit::StepCosts::Scale::fine}, {"integer", kit::StepCosts::Scale::ratio}})
        .doc(
            "where cells decide alone: lengths of steps as they are (to 1e-7 on cubes and "
            "squares), or in the ratios 41 : 58 : 71 on cubes and 70 : 99 on squares, which make "
            "more ways equal (routes up to 0.05 % and 0.006 % longer; on other cells 2.5 %)");
  }
};

/// Of a step's cost, where lengths are to be exact and where they are ratios: beyond it the search
/// is left to real numbers.
constexpr double kGreatestError[] = {1e-4, 0.02};

class AStar final : public Planner {
 public:
  explicit AStar(const Params& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    const SearchSettings settings = params_.settings(request);
    if (!settings.anytime) {
      return search(settings, request, kInfinity).result;
    }
    return kit::improve(settings, request,
                        [&](const SearchSettings& inflated, const Request& rest, double best_cost) {
                          return search(inflated, rest, best_cost);
                        });
  }

  enum class By { cells, one_parent, heading };

  /// The search that is the quickest of those that the problem allows.
  static By quickest(const SearchSettings& settings, const Request& request) {
    if (settings.moves == MoveCheck::cells && kit::MoveRules::cells_decide(request) &&
        settings.cost.length_alone() && settings.cost.length == 1) {
      return By::cells;
    }
    return kit::begins_by_heading(settings, request) ? By::heading : By::one_parent;
  }

  /// One search for a route that costs less than `best_cost`.
  SearchResult search(const SearchSettings& settings, const Request& request, double best_cost) const {
    switch (quickest(settings, request)) {
      case By::cells:
        if (auto found = by_cells(request, settings)) {
          return *std::move(found);
        }
        [[fallthrough]];
      case By::one_parent: {
        SearchResult found = on_lattice<astar::Search, astar::Node>(request, settings, best_cost, memory_);
        if (!kit::heading_may_help(settings, best_cost, sizeof(kit::HeadingCell) + 1, found)) {
          return found;
        }
        const Request rest = kit::after(request, found.result.counters);
        return kit::after_one_parent(by_heading(rest, settings, best_cost), found);
      }
      case By::heading:
        break;
    }
    return by_heading(request, settings, best_cost);
  }

  SearchResult by_heading(const Request& request, const SearchSettings& settings, double best_cost) const {
    return on_lattice<kit::HeadingSearch, kit::HeadingCell>(request, settings, best_cost,
                                                            heading_memory_);
  }

  template <class Search, class Node, class Memory>
  SearchResult on_lattice(const Request& request, const SearchSettings& settings, double best_cost,
                   kit::ScratchPool<Memory>& pool) const {
    constexpr std::size_t kBytes = sizeof(Node) + 1;
    const kit::Lattice lattice(request, settings.cell_m, settings.neighbours,
                               {params_.max_bytes(), kBytes});
    if (auto refused = kit::beyond_budget(lattice, kBytes, request.budget)) {
      return {*std::move(refused)};
    }
    const auto memory = pool.take();
    return Search(request, settings, lattice, best_cost, *memory).run();
  }

  /// Nothing where the costs would become too coarse.
  std::optional<SearchResult> by_cells(const Request& request, const SearchSettings& settings) const {
    const kit::Lattice lattice(request, settings.cell_m, settings.neighbours,
                               {params_.max_bytes(), astar::CellMemory::kBytesPerCell});
    if (auto refused =
            kit::beyond_budget(lattice, astar::CellMemory::kBytesPerCell, request.budget)) {
      return SearchResult{*std::move(refused)};
    }
    const auto memory = cell_memory_.take();
    const Box box = lattice.spec().box();
    // Few ways are longer than four times this, but in a maze they are.
    const auto scale = kit::StepCosts::between(settings.costs, lattice, request.start.position,
                                               request.goal.position);
    double longest_m = 4 * (box.max - box.min).sum();
    while (true) {
      const kit::StepCosts costs(lattice, scale, longest_m);
      if (costs.error() > kGreatestError[scale == kit::StepCosts::Scale::ratio]) {
        return std::nullopt;
      }
      if (auto result = astar::CellSearch(request, settings, lattice, costs, *memory).run()) {
        const double cost = length(result->route);
        const bool at_goal =
            result->status == PlanStatus::solved && result->route.back() == request.goal.position;
        return SearchResult{*std::move(result), cost, at_goal};
      }
      longest_m = 4 * costs.longest_m();
    }
  }

  Traits do_traits() const override { return params_.traits(); }

  Params params_;
  mutable kit::ScratchPool<astar::Memory> memory_;
  mutable kit::ScratchPool<kit::HeadingMemory> heading_memory_;
  mutable kit::ScratchPool<astar::CellMemory> cell_memory_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "astar", AStar, Params,
                "A* on a 3-D or level lattice, every move judged, with angle limits and a "
                "multi-term cost")
