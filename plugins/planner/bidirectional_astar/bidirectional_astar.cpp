// SPDX-License-Identifier: Apache-2.0
// Bidirectional A* on a lattice.
//
// Citation: W. Pijls, H. Post: Yet Another Bidirectional Algorithm for Finding the Shortest Path.
//   Econometric Institute Report EI 2009-10, Erasmus University Rotterdam, 2009. With limits on
//   angles: reference [13] of paper 002.
// Guarantees: complete and optimal on its lattice while the heuristic is octile, euclidean or zero,
//   w_h <= w_g (manhattan: w_h sqrt(axes) <= w_g) and costs are summed; under turn limits too, when
//   searching by (cell, heading).
// Complexity: O(n log n) time, O(n) memory in the cells of the lattice; by (cell, heading) in the
//   steps between them.
// Deviations: moves are checked, not only cells; straight links join start and goal to the lattice;
//   the turn is checked where the sides meet; closed nodes are never reopened.
// Symbols: g cost-to-come of a side, h its heuristic, f = w_g g + w_h h.
#include <memory>

#include "altiplan/kit/lattice/search_params.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "two_sided_search.hpp"

namespace {

using namespace altiplan;
using bidirectional::Node;
using kit::SearchParams;
using kit::SearchResult;
using kit::SearchSettings;

class BidirectionalAStar final : public Planner {
 public:
  explicit BidirectionalAStar(const SearchParams& params) : params_(params) {}

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

  /// Searches once for a route that costs less than `best_cost`.
  SearchResult search(const SearchSettings& settings, const Request& request,
                      double best_cost) const {
    if (kit::begins_by_heading(settings, request)) {
      return run(settings, request, best_cost, true);
    }
    SearchResult found = run(settings, request, best_cost, false);
    if (!kit::heading_may_help(settings, best_cost, found)) {
      return found;
    }
    const Request rest = kit::after(request, found.result.counters);
    return kit::after_one_parent(run(settings, rest, best_cost, true), found);
  }

  SearchResult run(const SearchSettings& settings, const Request& request, double best_cost,
                   bool by_heading) const {
    const kit::Lattice lattice(request, settings.cell_m, settings.neighbours,
                               {params_.max_bytes(), sizeof(Node) + 1});
    if (auto refused = kit::beyond_budget(lattice, sizeof(Node) + 1, request.budget)) {
      return {*std::move(refused)};
    }
    const auto memory = memory_.take();
    return bidirectional::TwoSidedSearch(request, settings, lattice, best_cost, by_heading, *memory)
        .run();
  }

  Traits do_traits() const override { return params_.traits(); }

  SearchParams params_;
  mutable kit::ScratchPool<bidirectional::Memory> memory_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "bidirectional_astar", BidirectionalAStar, SearchParams,
                "A* from both ends simultaneously, with the options of astar")
