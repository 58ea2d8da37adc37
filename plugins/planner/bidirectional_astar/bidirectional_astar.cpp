// SPDX-License-Identifier: Apache-2.0
// Bidirectional A* on a lattice.
//
// Citation: W. Pijls, H. Post: Yet Another Bidirectional Algorithm for Finding the Shortest Path.
//   Econometric Institute Report EI 2009-10, Erasmus University Rotterdam, 2009. With limits on
//   angles: reference [13] of paper 002.
// Guarantees: complete and optimal on its lattice while the heuristic is octile, euclidean or zero,
//   w_h <= w_g (manhattan: w_h sqrt(axes) <= w_g) and costs are summed; under limits on turns too,
//   by (cell, heading).
// Complexity: O(n log n) time, O(n) memory in the cells of the lattice; by (cell, heading) in the
//   steps between them.
// Deviations: moves are judged, not only cells; start and goal join the lattice by straight links;
//   where the sides meet the turn is judged; a closed node is never opened again.
// Symbols: g travelled cost of a side, h its heuristic, f = w_g g + w_h h.
#include <memory>

#include "altiplan/kit/lattice/search_params.hpp"
#include "altiplan/plugin.hpp"
#include "two_sided_search.hpp"

namespace {

using namespace altiplan;
using bidirectional::Node;
using kit::Found;
using kit::SearchParams;
using kit::SearchSettings;

class BidirectionalAStar final : public Planner {
 public:
  explicit BidirectionalAStar(const SearchParams& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    return kit::plan_by(params_.settings(request), request,
                        [&](const SearchSettings& settings, const Request& rest, double best_cost) {
                          return search(settings, rest, best_cost);
                        });
  }

  Found search(const SearchSettings& settings, const Request& request, double best_cost) const {
    const auto run = [&](const Request& rest, bool by_heading) -> Found {
      const kit::Lattice lattice(rest, settings.cell_m, settings.neighbours,
                                 {params_.max_bytes(), sizeof(Node) + 1});
      if (auto refused = kit::beyond_budget(lattice, sizeof(Node) + 1, rest.budget)) {
        return {*std::move(refused)};
      }
      const auto memory = memory_.take();
      return bidirectional::TwoSidedSearch(rest, settings, lattice, best_cost, by_heading, *memory)
          .run();
    };
    return kit::search_by_state(
        settings, request, best_cost, sizeof(Node) + 1,
        [&](const Request& rest) { return run(rest, false); },
        [&](const Request& rest) { return run(rest, true); });
  }

  Traits do_traits() const override { return params_.traits(); }

  SearchParams params_;
  mutable kit::ScratchPool<bidirectional::Memory> memory_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "bidirectional_astar", BidirectionalAStar, SearchParams,
                "A* from both ends at once, with the options of astar")
