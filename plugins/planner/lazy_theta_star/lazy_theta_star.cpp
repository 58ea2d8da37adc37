// SPDX-License-Identifier: Apache-2.0
// Lazy Theta* over the cells of a lattice.
//
// Citation: A. Nash, K. Daniel, S. Koenig, A. Felner: Theta*: Any-Angle Path Planning on Grids.
//   AAAI 2007, pp. 1177-1183.
// Guarantees: every leg keeps every rule; a route over free cells is found where there is one
//   (angle_rule: complete: under limits on turns and climb too).
// Complexity: O(n log n) time, O(n) memory in the cells, and for each way that may be shorter one
//   or two lines of sight, over as many cells as the leg meets.
// Deviations: a leg is held to every rule of the judge, not to obstacles alone; where it breaks one
//   at the parent's parent the cell is reached by way of the expanded cell; ways are sums of whole
//   numbers (kit/any_angle.hpp); f that falls from a cell to its successor counts as the last f.
// Symbols: g length of the way from the start, h straight line to the goal, f = g + h.
#include "altiplan/kit/any_angle_planner.hpp"
#include "altiplan/plugin.hpp"

namespace {

using namespace altiplan;
using kit::AnyAngleMemory;
using kit::AnyAngleNodes;
using kit::AnyAngleSearch;

class LazyThetaStar final : public kit::AnyAnglePlanner {
 public:
  explicit LazyThetaStar(const kit::AnyAngleParams& params)
      : AnyAnglePlanner(params, AnyAngleMemory::kBytesPerNode) {}

 private:
  AnyAngleSearch::Result search(Task& task) const override {
    task.settings.sight = kit::Sight::lazy;
    const AnyAngleNodes nodes = AnyAngleNodes::every_cell(*task.rules.grid());
    return AnyAngleSearch(task.request, task.lattice, task.rules, nodes, task.settings, task.memory)
        .run();
  }
  bool looks_everywhere() const override { return true; }
  Traits do_traits() const override {
    return {.complete = params().angle_rule == kit::AnyAngleParams::Angles::complete,
            .any_angle = true};
  }
};
}  // namespace

ALTIPLAN_PLUGIN(
    Planner, "lazy_theta_star", LazyThetaStar, kit::AnyAngleParams,
    "Lazy Theta*: straight legs between cells that see each other, each looked at when its "
    "end is expanded")
