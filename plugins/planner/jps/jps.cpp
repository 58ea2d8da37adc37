// SPDX-License-Identifier: Apache-2.0
// Jump point search on the cells of a level.
//
// Citation: D. Harabor, A. Grastien: Online Graph Pruning for Pathfinding on Grid Maps. AAAI 2011,
//   doi:10.1609/aaai.v25i1.7994. Scans of many cells at once, no queue entries for cells where a
//   diagonal run turns: the same, Improving Jump Point Search. ICAPS 2014,
//   doi:10.1609/icaps.v24i1.13633.
// Guarantees: complete and optimal on its lattice.
// Complexity: O(n log n) time, O(n) memory in the cells of the level; nothing is precomputed except
//   a transposed copy of the occupancy.
// Deviations: costs are integers (kit::StepCosts); cells where a diagonal run turned keep their g,
//   which ends runs over a worse path, and the route is recovered without parents; straight links
//   join start and goal to the lattice, and every cell linked to the goal ends a run.
// Symbols: g length so far, h octile distance to the goal, f = g + h.
#include <memory>

#include "altiplan/kit/lattice/lattice_params.hpp"
#include "altiplan/kit/lattice/move_rules.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "jps_search.hpp"

namespace {

using namespace altiplan;
using kit::CornerRule;
using kit::StepCosts;

struct Params : kit::LatticeParams {
  CornerRule corner = CornerRule::any;
  StepCosts::Scale costs = StepCosts::Scale::fine;

  void describe(Fields& f) {
    describe_cell(f);
    f("corner", corner, {{"any", CornerRule::any}, {"free_box", CornerRule::free_box}})
        .doc(
            "a diagonal step requires its two cells to be free (any), or also the two beside it "
            "(free_box)");
    f("costs", costs, {{"exact", StepCosts::Scale::fine}, {"integer", StepCosts::Scale::ratio}})
        .doc(
            "costs of straight and diagonal steps: as fine as 28 bits allow for the length of a "
            "path, or, on square cells, 70 to 99, which makes routes at most 1e-4 longer than "
            "the shortest");
    describe_memory(f);
  }
};

PlanResult refused(const std::string& what) {
  PlanResult result;
  result.status = PlanStatus::invalid_problem;
  result.message = "jps " + what + ": use astar";
  return result;
}

class Jps final : public Planner {
 public:
  explicit Jps(const Params& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    if (const std::string rule = kit::beyond_cells(request); !rule.empty()) {
      return refused("cannot satisfy " + rule);
    }
    const std::size_t max_bytes = params_.max_bytes();
    const std::size_t bytes_per_cell = sizeof(std::uint32_t) + 1;
    const kit::Lattice lattice(request, params_.cell_m, kit::Neighbourhood::all,
                               {max_bytes, bytes_per_cell});
    if (auto over = kit::beyond_budget(lattice, bytes_per_cell, request.budget)) {
      return *std::move(over);
    }
    const std::size_t allowed = std::min(max_bytes, request.budget.max_memory_bytes);
    if (const int levels = lattice.spec().counts[2]; levels > 1) {
      return refused("searches one level of cells, this lattice has " + std::to_string(levels) +
                     " without the scenario's level_flight_at_m");
    }
    return params_.corner == CornerRule::any
               ? search<CornerRule::any>(request, lattice, allowed)
               : search<CornerRule::free_box>(request, lattice, allowed);
  }

  template <CornerRule kRule>
  PlanResult search(const Request& request, const kit::Lattice& lattice,
                    std::size_t allowed) const {
    const std::shared_ptr<const VoxelGrid> grid = kit::occupancy(request, lattice);
    const auto memory = memory_.take();
    const Vec3 size = lattice.spec().box().max - lattice.spec().box().min;
    constexpr double kSpare = double(StepCosts::kMax) / jps::NodeWord::kMax;
    const StepCosts::Scale scale =
        StepCosts::between(params_.costs, lattice, request.start.position, request.goal.position);
    for (double longest = 2 * (size.x() + size.y());; longest *= 4) {
      const StepCosts costs(lattice, scale, kSpare * longest);
      if (costs.error() > (scale == StepCosts::Scale::ratio ? 0.02 : 1e-4)) {
        return refused("cannot distinguish the lengths of paths over " +
                       std::to_string(lattice.size()) + " cells of " +
                       std::to_string(lattice.spec().cell.x()) + " x " +
                       std::to_string(lattice.spec().cell.y()) + " m");
      }
      if (auto result = jps::Search<kRule>(request, lattice, costs, grid, allowed, *memory).run()) {
        return *std::move(result);
      }
    }
  }

  Traits do_traits() const override {
    Traits traits;
    traits.complete = true;
    traits.optimal = params_.costs == StepCosts::Scale::fine;
    traits.spatial = false;
    return traits;
  }

  Params params_;
  mutable kit::ScratchPool<jps::Memory> memory_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "jps", Jps, Params,
                "jump point search on one level of cells, scanning many cells at once")
