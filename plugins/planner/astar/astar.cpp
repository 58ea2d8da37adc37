// SPDX-License-Identifier: Apache-2.0
// A* on a lattice.
//
// Citation: P. E. Hart, N. J. Nilsson, B. Raphael: A Formal Basis for the Heuristic Determination
//   of Minimum Cost Paths. IEEE Transactions on Systems Science and Cybernetics 4(2), 1968,
//   doi:10.1109/TSSC.1968.300136. Weights f = w_g g + w_h h: I. Pohl, Artificial Intelligence 1,
//   1970, doi:10.1016/0004-3702(70)90007-X.
// Guarantees: complete and optimal on its lattice while no limit looks at turns, the heuristic is
//   octile, euclidean or zero, and w_h <= w_g (manhattan: w_h sqrt(axes) <= w_g).
// Complexity: O(n log n) time, O(n) memory in the cells of the lattice.
// Deviations: moves are judged, not only cells; start and goal join the lattice by straight links;
//   limits on turns are held against the single parent of a cell, which is incomplete; a closed
//   cell is never opened again; where cells decide alone (cell_search.hpp) lengths are whole
//   numbers (kit::StepCosts), and successors that another way reaches as cheaply are left out.
// Symbols: g travelled length, h heuristic, f = w_g g + w_h h.
#include <memory>

#include "altiplan/plugin.hpp"
#include "astar_search.hpp"
#include "cell_search.hpp"

namespace {

using namespace altiplan;
using astar::Heuristic;
using kit::CornerRule;
using kit::MoveCheck;
using kit::Neighbourhood;

enum class Moves { automatic, exact, cells };

struct Params {
  astar::Settings search;
  int neighbours = 26;
  Moves moves = Moves::automatic;
  int max_memory_mb = 4096;

  void describe(Fields& f) {
    f("cell_m", search.cell_m)
        .unit("m")
        .at_least(0.001)
        .doc("edge of a cell on each axis; a layer with cells of its own sets them instead");
    f("neighbours", neighbours)
        .doc("26 (8 in level flight) or 6 (4 in level flight) neighbours of a cell")
        .range(6, 26);
    f.check(neighbours == 6 || neighbours == 26, "neighbours must be 6 or 26");
    f("corner", search.corner, {{"any", CornerRule::any}, {"free_box", CornerRule::free_box}})
        .doc(
            "with moves by cells: a step needs its two cells free (any), or every cell of the box "
            "that it spans (free_box)");
    f("moves", moves,
      {{"auto", Moves::automatic}, {"exact", Moves::exact}, {"cells", Moves::cells}})
        .doc(
            "how a move is held to the obstacles: the straight leg against the exact world, or "
            "the cells it leads through; auto: cells where every layer has cells of its own and "
            "the vehicle needs no clearance, else exact");
    f("costs", search.costs,
      {{"exact", kit::StepCosts::Scale::fine}, {"integer", kit::StepCosts::Scale::ratio}})
        .doc(
            "where cells decide alone: lengths of steps as they are (to 1e-7 on cubes and "
            "squares), or "
            "in the ratios 41 : 58 : 71 on cubes and 70 : 99 on squares, which make more ways "
            "equal "
            "(routes up to 0.05 % and 0.006 % longer; on other cells 2.5 %)");
    f("heuristic", search.heuristic,
      {{"octile", Heuristic::octile},
       {"euclidean", Heuristic::euclidean},
       {"manhattan", Heuristic::manhattan},
       {"zero", Heuristic::zero}})
        .doc(
            "estimate of the way to go: octile is the length on an empty lattice; manhattan is "
            "not admissible with 26 neighbours, and octile with 6");
    f("weight_g", search.weight_g)
        .range(0, 1)
        .doc("weight of the travelled length in f, paper 002 eq. (10)");
    f("weight_h", search.weight_h).range(0, 1).doc("weight of the heuristic in f");
    f.check(search.weight_g + search.weight_h > 0, "weight_g and weight_h must not both be 0");
    f("max_memory_mb", max_memory_mb)
        .unit("MB")
        .at_least(1)
        .doc("a lattice that needs more is refused before anything is allocated");
  }
};

/// Of a step's cost, where lengths are to be exact and where they are ratios: beyond it the search
/// is left to real numbers.
constexpr double kGreatestError[] = {1e-4, 0.02};

class AStar final : public Planner {
 public:
  explicit AStar(const Params& params) : params_(params) {
    params_.search.neighbours =
        params_.neighbours == 26 ? Neighbourhood::all : Neighbourhood::faces;
    if (params_.neighbours == 6 && params_.search.heuristic == Heuristic::manhattan) {
      // On an empty lattice of faces the two are one; beside it the goal's last leg is straight.
      params_.search.heuristic = Heuristic::octile;
    }
  }

 private:
  PlanResult do_plan(const Request& request) const override {
    astar::Settings settings = params_.search;
    settings.moves = move_check(request);
    const std::size_t most = std::size_t(params_.max_memory_mb) * 1024 * 1024;
    settings.max_bytes = std::min(most, request.budget.max_memory_bytes);
    if (settings.moves == MoveCheck::cells && kit::MoveRules::cells_decide(request)) {
      if (auto result = plan_by_cells(request, settings, most)) {
        return *std::move(result);
      }
    }
    const kit::Lattice lattice(request, params_.search.cell_m, params_.search.neighbours,
                               {most, sizeof(astar::Node) + 1});
    if (auto refused = kit::beyond_budget(lattice, sizeof(astar::Node) + 1, request.budget)) {
      return *std::move(refused);
    }
    const auto memory = memory_.take();
    return astar::Search(request, settings, lattice, *memory).run();
  }

  /// Nothing where the costs would become too coarse.
  std::optional<PlanResult> plan_by_cells(const Request& request, const astar::Settings& settings,
                                          std::size_t most_bytes) const {
    const kit::Lattice lattice(request, settings.cell_m, settings.neighbours,
                               {most_bytes, astar::CellMemory::kBytesPerCell});
    if (auto refused =
            kit::beyond_budget(lattice, astar::CellMemory::kBytesPerCell, request.budget)) {
      return refused;
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
        return result;
      }
      longest_m = 4 * costs.longest_m();
    }
  }

  MoveCheck move_check(const Request& request) const {
    if (params_.moves != Moves::automatic) {
      return params_.moves == Moves::exact ? MoveCheck::exact : MoveCheck::cells;
    }
    const bool all_cells =
        std::all_of(request.world->layers().begin(), request.world->layers().end(),
                    [](const Layer& layer) { return layer.environment->native_grid(); });
    const bool no_clearance = request.limits.min_clearance <= 0 && request.vehicle.radius_m <= 0;
    return all_cells && no_clearance && !request.world->layers().empty() ? MoveCheck::cells
                                                                         : MoveCheck::exact;
  }

  Traits do_traits() const override {
    const astar::Settings& s = params_.search;
    const double stretch = s.heuristic == Heuristic::zero        ? 0
                           : s.heuristic == Heuristic::manhattan ? std::sqrt(3.0)
                                                                 : 1.0;
    Traits traits;
    traits.complete = true;
    traits.optimal = s.weight_g > 0 && stretch * s.weight_h <= s.weight_g &&
                     s.costs == kit::StepCosts::Scale::fine;
    return traits;
  }

  Params params_;
  mutable kit::ScratchPool<astar::Memory> memory_;
  mutable kit::ScratchPool<astar::CellMemory> cell_memory_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "astar", AStar, Params,
                "A* on a 3-D or level lattice, every move judged, with a weighted evaluation")
