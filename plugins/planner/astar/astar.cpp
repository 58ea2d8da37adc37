// SPDX-License-Identifier: Apache-2.0
// A* on a lattice.
//
// Citation: P. E. Hart, N. J. Nilsson, B. Raphael: A Formal Basis for the Heuristic Determination
//   of Minimum Cost Paths. IEEE Transactions on Systems Science and Cybernetics 4(2), 1968,
//   doi:10.1109/TSSC.1968.300136. Weights f = w_g g + w_h h: I. Pohl, Artificial Intelligence 1,
//   1970, doi:10.1016/0004-3702(70)90007-X.
// Guarantees: complete and optimal on its lattice while the heuristic is octile, euclidean or zero,
//   w_h <= w_g (manhattan: w_h sqrt(axes) <= w_g) and costs are summed; under turn limits too, when
//   searching by (cell, heading).
// Complexity: O(n log n) time, O(n) memory in the cells of the lattice; by (cell, heading) in the
//   steps between them.
// Deviations: moves are checked, not only cells; straight links join start and goal to the lattice;
//   turn limits are first checked against the single parent of a cell, which is incomplete; closed
//   nodes are never reopened; limits on totals are kept by labels (label_search.hpp); where cells
//   or places decide (kit::CellSearch, step_search.hpp) lengths are integers (kit::StepCosts), and
//   successors that another path reaches as cheaply are pruned.
// Symbols: g cost-to-come, h heuristic, f = w_g g + w_h h.
#include <memory>
#include <utility>

#include "altiplan/kit/lattice/cell_search.hpp"
#include "altiplan/kit/lattice/heading_search.hpp"
#include "altiplan/kit/lattice/search_params.hpp"
#include "altiplan/kit/totals.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "astar_search.hpp"
#include "label_search.hpp"
#include "step_search.hpp"

namespace {

using namespace altiplan;
using kit::MoveCheck;
using kit::SearchResult;
using kit::SearchSettings;

struct Params : kit::SearchParams {
  void describe(Fields& f) {
    SearchParams::describe(f);
    f("costs", search.costs,
      {{"exact", kit::StepCosts::Scale::fine}, {"integer", kit::StepCosts::Scale::ratio}})
        .doc(
            "where cells decide alone: step lengths exact (to 1e-7 on cubes and squares), or in "
            "the ratios 41 : 58 : 71 on cubes and 70 : 99 on squares, which gives more paths "
            "equal length (routes up to 0.05 % and 0.006 % longer; on other cells 2.5 %)");
    f("runs", search.runs)
        .doc(
            "where cells decide alone, in space: a straight run beside which nothing changes is "
            "one "
            "step, and its cells are not among those expanded; false: every cell is expanded");
  }
};

/// Largest error of a step's cost, for exact lengths and for ratios; beyond it the search uses real
/// numbers.
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

  enum class By { cells, steps, one_parent, heading, labels };

  /// The fastest search that the problem allows.
  static By quickest(const SearchSettings& settings, const Request& request) {
    if (!kit::resources_of(request).empty()) {
      return By::labels;
    }
    const bool is_length =
        settings.cost.length_alone() && settings.cost.length == 1 && !request.objective;
    if (is_length && settings.moves == MoveCheck::cells && kit::MoveRules::cells_decide(request)) {
      return By::cells;
    }
    if (kit::begins_by_heading(settings, request)) {
      return By::heading;
    }
    return is_length && settings.consistent() && !request.judges_pairs() &&
                   request.limits.max_route_length == kInfinity
               ? By::steps
               : By::one_parent;
  }

  /// Searches once for a route that costs less than `best_cost`.
  SearchResult search(const SearchSettings& settings, const Request& request,
                      double best_cost) const {
    const By by = quickest(settings, request);
    if (by == By::heading) {
      return by_heading(request, settings, best_cost);
    }
    if (by == By::labels) {
      return by_labels(request, settings, best_cost);
    }
    std::optional<SearchResult> exact = by == By::cells   ? by_cells(request, settings)
                                        : by == By::steps ? by_steps(request, settings)
                                                          : std::nullopt;
    SearchResult found = exact ? *std::move(exact) : by_one_parent(request, settings, best_cost);
    if (!kit::heading_may_help(settings, best_cost, found)) {
      return found;
    }
    const Request rest = kit::after(request, found.result.counters);
    return kit::after_one_parent(by_heading(rest, settings, best_cost), found);
  }

  SearchResult by_heading(const Request& request, const SearchSettings& settings,
                          double best_cost) const {
    const kit::Lattice lattice(request, settings.cell_m, settings.neighbours, {});
    const auto memory = heading_memory_.take();
    return kit::HeadingSearch(request, settings, lattice, best_cost, *memory).run();
  }

  SearchResult by_labels(const Request& request, const SearchSettings& settings,
                         double best_cost) const {
    constexpr std::size_t kBytes = sizeof(std::uint32_t);
    const kit::Lattice lattice(request, settings.cell_m, settings.neighbours,
                               {params_.max_bytes(), kBytes});
    if (auto refused = kit::beyond_budget(lattice, kBytes, request.budget)) {
      return {*std::move(refused)};
    }
    kit::OpenList open;
    return astar::LabelSearch(request, settings, lattice, best_cost, open).run();
  }

  SearchResult by_one_parent(const Request& request, const SearchSettings& settings,
                             double best_cost) const {
    constexpr std::size_t kBytes = sizeof(astar::Node) + 1;
    const kit::Lattice lattice(request, settings.cell_m, settings.neighbours,
                               {params_.max_bytes(), kBytes});
    if (auto refused = kit::beyond_budget(lattice, kBytes, request.budget)) {
      return {*std::move(refused)};
    }
    const auto memory = memory_.take();
    return astar::Search(request, settings, lattice, best_cost, *memory).run();
  }

  /// The result of `once(costs)`, a search with lengths as whole numbers that gives none if a path
  /// is too long for them: it is then tried with coarser ones. Empty if these are too coarse.
  template <class Search>
  static auto with_step_costs(const Request& request, const SearchSettings& settings,
                              const kit::Lattice& lattice, const Search& once)
      -> decltype(once(std::declval<const kit::StepCosts&>())) {
    const Box box = lattice.spec().box();
    const auto scale = kit::StepCosts::between(settings.costs, lattice, request.start.position,
                                               request.goal.position);
    // few paths are longer than four times this, except in mazes
    double longest_m = 4 * (box.max - box.min).sum();
    while (true) {
      const kit::StepCosts costs(lattice, scale, longest_m);
      if (costs.error() > kGreatestError[scale == kit::StepCosts::Scale::ratio]) {
        return std::nullopt;
      }
      if (auto found = once(costs)) {
        return found;
      }
      longest_m = 4 * costs.longest_m();
    }
  }

  /// Empty if the costs would be too coarse, or the cells too many to number by tiles.
  std::optional<SearchResult> by_steps(const Request& request,
                                       const SearchSettings& settings) const {
    const kit::Lattice lattice(request, settings.cell_m, settings.neighbours, {});
    const kit::TileIndex tiles(lattice.spec().counts);
    if (!tiles.fits()) {
      return std::nullopt;
    }
    const auto memory = step_memory_.take();
    return with_step_costs(request, settings, lattice, [&](const kit::StepCosts& costs) {
      return astar::StepSearch(request, settings, lattice, tiles, costs, *memory).run();
    });
  }

  /// Empty if the costs would be too coarse.
  std::optional<SearchResult> by_cells(const Request& request,
                                       const SearchSettings& settings) const {
    const kit::Lattice lattice(request, settings.cell_m, settings.neighbours,
                               {params_.max_bytes(), kit::CellMemory::kBytesPerCell});
    if (auto refused =
            kit::beyond_budget(lattice, kit::CellMemory::kBytesPerCell, request.budget)) {
      return SearchResult{*std::move(refused)};
    }
    const auto memory = cell_memory_.take();
    auto result = with_step_costs(request, settings, lattice, [&](const kit::StepCosts& costs) {
      return kit::CellSearch(request, settings, lattice, costs, *memory).run();
    });
    if (!result) {
      return std::nullopt;
    }
    const double cost = length(result->route);
    const bool at_goal =
        result->status == PlanStatus::solved && result->route.back() == request.goal.position;
    return SearchResult{*std::move(result), cost, at_goal};
  }

  Traits do_traits() const override { return params_.traits(); }

  Params params_;
  mutable kit::ScratchPool<astar::Memory> memory_;
  mutable kit::ScratchPool<kit::HeadingMemory> heading_memory_;
  mutable kit::ScratchPool<kit::CellMemory> cell_memory_;
  mutable kit::ScratchPool<astar::StepMemory> step_memory_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "astar", AStar, Params,
                "A* on a 3-D or level lattice that checks every move, with angle limits and a "
                "multi-term cost")
