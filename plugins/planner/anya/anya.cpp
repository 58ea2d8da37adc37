// SPDX-License-Identifier: Apache-2.0
// Anya on the cells of a level.
//
// Citation: D. Harabor, A. Grastien, D. Öz, V. Aksakalli: Optimal Any-Angle Pathfinding In
//   Practice. Journal of Artificial Intelligence Research 56, 2016, pp. 89-118,
//   doi:10.1613/jair.5007.
// Guarantees: complete, and its routes are the shortest of all in the free cells of the level: they
//   may touch blocked cells, which are open sets.
// Complexity: O(n) memory in the corners of the cells; nothing is precomputed.
// Deviations: intervals lie on the lines between rows of cells, ends of the route anywhere; an
//   interval is split where cells of the row beyond it change, and nowhere else; a root is a
//   corner with one g, and a second path to it that is not shorter is dropped; a flat node is the
//   next corner on its line; straight links join ends in blocked cells.
// Symbols: (I, r) interval and root, g length of the path to r, f = g + h with h the length from r
//   over I to the goal, mirrored where it lies on the side of r.
#include <optional>
#include <sstream>
#include <string>

#include "altiplan/kit/lattice/lattice_params.hpp"
#include "altiplan/kit/lattice/move_rules.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "anya_plan.hpp"

namespace {

using namespace altiplan;

struct Params : kit::LatticeParams {
  anya::Corner corner = anya::Corner::any;

  void describe(Fields& f) {
    describe_cell(f);
    f("corner", corner, {{"any", anya::Corner::any}, {"one_free", anya::Corner::one_free}})
        .doc(
            "a route may pass between two blocked cells that meet at a corner (any), or one of the "
            "two cells beside it must be free there (one_free)");
    describe_memory(f);
  }
};

PlanResult refused(const std::string& what) {
  PlanResult result;
  result.status = PlanStatus::invalid_problem;
  result.message = "anya " + what + ": use theta_star";
  return result;
}

class Anya final : public Planner {
 public:
  explicit Anya(const Params& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    if (const std::string rule = kit::beyond_cells(request); !rule.empty()) {
      return refused("cannot satisfy " + rule);
    }
    if (request.level_m) {
      return on_level(request);
    }
    const double start_z = request.start.position.z();
    const double goal_z = request.goal.position.z();
    if (std::abs(start_z - goal_z) > kLengthTolerance) {
      std::ostringstream heights;
      heights << "flies on one level, but the start is at " << start_z << " m and the goal at "
              << goal_z << " m";
      return refused(heights.str());
    }
    Request level = request;
    level.level_m = start_z;
    return on_level(level);
  }

  PlanResult on_level(const Request& request) const {
    const std::size_t max_bytes = params_.max_bytes();
    const std::size_t bytes_per_cell = sizeof(std::uint32_t) + 1;
    const kit::Lattice lattice(request, params_.cell_m, kit::Neighbourhood::all,
                               {max_bytes, bytes_per_cell});
    if (auto over = kit::beyond_budget(lattice, bytes_per_cell, request.budget)) {
      return *std::move(over);
    }
    const std::shared_ptr<const VoxelGrid> grid = kit::occupancy(request, lattice);
    const auto memory = memory_.take();
    return anya::Plan(request, lattice, *grid, params_.corner,
                      std::min(max_bytes, request.budget.max_memory_bytes), *memory)
        .result();
  }

  Traits do_traits() const override {
    Traits traits;
    traits.complete = true;
    traits.optimal = true;
    traits.any_angle = true;
    traits.spatial = false;
    return traits;
  }

  Params params_;
  mutable kit::ScratchPool<anya::Memory> memory_;
};
}  // namespace

ALTIPLAN_PLUGIN(
    Planner, "anya", Anya, Params,
    "Anya: the shortest route of any angle on one level of cells, searched by intervals "
    "of its lines")
