// SPDX-License-Identifier: Apache-2.0
// Spatial slicing: from plane to plane toward the goal, around obstacles.
//
// Citation: the stratification that paper 003 starts from.
// Guarantees: every leg satisfies the constraints, and on each plane the detour is the shortest.
//   Neither complete nor optimal: a chosen point is never revised.
// Complexity: O(m n log n) time at most for m planes of n cells on which the line is blocked, less
//   where points near the line are free; O(n) memory in addition to the occupancy.
// Deviations: the line's own points are kept off the centres of cells; the last plane's point must
//   lead on to the goal; points on a straight stretch are removed at the end.
// Symbols: p_i the route's point on plane i, p_0 the start.
#include "altiplan/kit/lattice/lattice_params.hpp"
#include "altiplan/kit/scratch.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "slicing_search.hpp"

namespace {

using namespace altiplan;

enum class Axis { x, y, z, automatic };

struct Params : kit::LatticeParams {
  Axis axis = Axis::x;
  int plane_cells = 1;

  void describe(Fields& f) {
    describe_cell(f);
    f("axis", axis, {{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}, {"auto", Axis::automatic}})
        .doc(
            "axis perpendicular to the planes; auto: the axis on which start and goal lie "
            "farthest apart");
    f("plane_cells", plane_cells).range(1, 1000000).doc("spacing of the planes in cells");
    describe_memory(f);
  }
};

class SpatialSlicing final : public Planner {
 public:
  explicit SpatialSlicing(const Params& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    const std::size_t max_bytes = params_.max_bytes();
    Budget allowed = request.budget;
    allowed.max_memory_bytes = std::min(max_bytes, allowed.max_memory_bytes);
    const kit::Lattice lattice(request, params_.cell_m, kit::Neighbourhood::all, {max_bytes, 1});
    const int axis = axis_of(request);
    // The occupancy, at most one byte per cell, and the candidates of one plane.
    const std::size_t planes = std::size_t(lattice.spec().counts[std::size_t(axis)]);
    const std::size_t bytes_per_cell = 1 + (sizeof(slicing::Candidate) + planes - 1) / planes;
    if (auto over = kit::beyond_budget(lattice, bytes_per_cell, allowed)) {
      return *std::move(over);
    }
    const auto candidates = candidates_.take();
    return slicing::Search(request, lattice,
                           slicing::Planes(request, lattice, axis, params_.plane_cells),
                           *candidates)
        .run();
  }

  int axis_of(const Request& request) const {
    int axis = int(params_.axis);
    if (params_.axis == Axis::automatic) {
      (request.goal.position - request.start.position).cwiseAbs().maxCoeff(&axis);
    }
    return axis;
  }

  Traits do_traits() const override { return {}; }

  Params params_;
  mutable kit::ScratchPool<std::vector<slicing::Candidate>> candidates_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "spatial_slicing", SpatialSlicing, Params,
                "slices the volume into planes toward the goal and moves each plane's point "
                "around obstacles")
