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
#include "altiplan/kit/scratch.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "slicing_search.hpp"

namespace {

using namespace altiplan;

enum class Axis { x, y, z, automatic };

struct Params {
  Vec3 cell_m{50, 50, 10};
  Axis axis = Axis::x;
  int plane_cells = 1;
  int max_memory_mb = 4096;

  void describe(Fields& f) {
    f("cell_m", cell_m)
        .unit("m")
        .at_least(0.001)
        .doc("cell edge length on each axis; a layer with its own cells overrides it");
    f("axis", axis, {{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}, {"auto", Axis::automatic}})
        .doc(
            "axis perpendicular to the planes; auto: the axis on which start and goal lie "
            "farthest apart");
    f("plane_cells", plane_cells).range(1, 1000000).doc("spacing of the planes in cells");
    f("max_memory_mb", max_memory_mb)
        .unit("MB")
        .at_least(1)
        .doc("memory limit of the lattice; a larger one is refused before allocation");
  }
};

class SpatialSlicing final : public Planner {
 public:
  explicit SpatialSlicing(const Params& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    const std::size_t most = std::size_t(params_.max_memory_mb) * 1024 * 1024;
    Budget allowed = request.budget;
    allowed.max_memory_bytes = std::min(most, allowed.max_memory_bytes);
    const kit::Lattice lattice(request, params_.cell_m, kit::Neighbourhood::all, {most, 1});
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
