// SPDX-License-Identifier: Apache-2.0
// Routes pulled taut around closed cells, with a proven lower bound of the shortest.
//
// Citation: C. H. Papadimitriou: An algorithm for shortest-path motion in three dimensions.
//   Information Processing Letters 20, 1985, pp. 259-263; M. Sharir, A. Schorr: On shortest paths
//   in polyhedral spaces. SIAM Journal on Computing 15, 1986, pp. 193-215.
// Guarantees: no route through free cells is shorter than the bound; the route is never longer than
//   that of Lazy Theta*, and every leg satisfies every constraint.
// Complexity: that of Lazy Theta*, and O(n^2) legs between the n pieces of edges that a route
//   shorter than its own may bend at.
// Deviations: pieces are halved where they matter, not graded beforehand; their arcs are priced
// from
//   below, with slopes as multipliers, so that the error falls with the square of their length.
#include <algorithm>
#include <string>

#include "altiplan/check.hpp"
#include "altiplan/kit/any_angle/any_angle_planner.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "refinement.hpp"

namespace {

using namespace altiplan;

struct Params : kit::LatticeParams {
  double gap = 0.001;

  void describe(Fields& f) {
    describe_cell(f);
    f("gap", gap)
        .at_least(0)
        .doc(
            "how much longer than the bound the route may be, as a fraction: the search ends "
            "there");
    describe_memory(f);
  }
  kit::AnyAngleParams any_angle() const {
    kit::AnyAngleParams params;
    params.cell_m = cell_m;
    params.max_memory_mb = max_memory_mb;
    return params;
  }
};

class Taut final : public kit::AnyAnglePlanner {
 public:
  explicit Taut(const Params& params)
      : AnyAnglePlanner(params.any_angle(), kit::AnyAngleMemory::kBytesPerNode), params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    const std::string rule =
        request.limits.max_slope() < kPi / 2 ? "a limit on climb" : kit::beyond_cells(request);
    if (!rule.empty()) {
      PlanResult refused;
      refused.status = PlanStatus::invalid_problem;
      refused.message = "taut cannot satisfy " + rule + ": use theta_star";
      return refused;
    }
    PlanResult result = AnyAnglePlanner::do_plan(request);
    if (result.status != PlanStatus::solved || result.route.back() != request.goal.position) {
      return result;
    }
    const kit::Lattice lattice(request, params_.cell_m, kit::Neighbourhood::all, {});
    const std::shared_ptr<const VoxelGrid> grid = kit::occupancy(request, lattice);
    for (const Vec3& end : {request.start.position, request.goal.position}) {
      const Cell cell = lattice.spec().cell_of(end);
      if (!lattice.spec().holds(cell) || grid->blocked(cell)) {
        return result;  // joined to the free cells by legs that no bound is known for
      }
    }
    pull(request, *grid, result);
    return result;
  }

  /// Shortens the route, and bounds the shortest.
  void pull(const Request& request, const VoxelGrid& grid, PlanResult& result) const {
    const taut::Refinement::Accepts accepts = [&](const Polyline& route) {
      for (std::size_t i = 1; i < route.size(); ++i) {
        if (!leg_ok(std::nullopt, route[i - 1], route[i], request)) {
          return false;
        }
      }
      return true;
    };
    constexpr double kCellsOfPiece = 8;
    constexpr std::size_t kMaxBytes = 64 << 20;  // what takes more has no close bound
    const taut::Refinement::Settings settings{
        params_.gap, kCellsOfPiece * grid.spec().cell.minCoeff(),
        std::min({params_.max_bytes(), request.budget.max_memory_bytes, kMaxBytes})};
    Counter& expanded = result.counters.front();
    const std::vector<taut::Edge> edges = taut::EdgeFinder(grid, request.level_m).edges();
    const taut::ClosedBoxes boxes(grid);
    taut::Refinement refinement(edges, boxes, result.route.waypoints(), accepts, settings,
                                request.budget, std::uint64_t(expanded.value));
    refinement.run();
    result.route = refinement.best();
    result.budget_hit = refinement.is_spent();
    expanded.value = std::int64_t(refinement.expanded());
    result.counters.push_back(
        {"bound_mm", std::int64_t(1000 * refinement.bound() * (1 - kRounding))});
    result.message = "a route of " + std::to_string(length(result.route)) + " m";
  }

  kit::AnyAngleSearch::Result search(Task& task) const override {
    task.settings.sight = kit::Sight::lazy;
    const kit::AnyAngleNodes nodes = kit::AnyAngleNodes::every_cell(*task.rules.grid());
    return kit::AnyAngleSearch(task.request, task.lattice, task.rules, nodes, task.settings,
                               task.memory)
        .run();
  }
  bool looks_everywhere() const override { return true; }
  Traits do_traits() const override { return {.complete = true, .any_angle = true}; }

  static constexpr double kRounding = 1e-9;  ///< of sums of lengths

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "taut", Taut, Params,
                "a route pulled taut around closed cells, and how much longer than the shortest of "
                "all it is at most")
