// SPDX-License-Identifier: Apache-2.0
// Theta* over the cells of a lattice.
//
// Citation: A. Nash, K. Daniel, S. Koenig, A. Felner: Theta*: Any-Angle Path Planning on Grids.
//   AAAI 2007, pp. 1177-1183.
// Guarantees: every leg keeps every rule; a route over free cells is found where there is one
//   (angle_rule: complete: under limits on turns and climb too), and where cells alone decide it is
//   never longer than the shortest over the grid.
// Complexity: O(n log n) time, O(n) memory in the cells, and for each way that may be shorter one
//   or two lines of sight, over as many cells as the leg meets.
// Deviations: a leg is held to every rule of the judge, not to obstacles alone; where it breaks one
//   at the parent's parent the cell is reached by way of the expanded cell; ways are sums of whole
//   numbers (kit/any_angle.hpp); f that falls from a cell to its successor counts as the last f.
// Symbols: g length of the way from the start, h straight line to the goal, f = g + h.
#include "altiplan/kit/any_angle/any_angle_planner.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"

namespace {

using namespace altiplan;

class ThetaStar final : public kit::EveryCellPlanner {
 public:
  explicit ThetaStar(const kit::AnyAngleParams& params)
      : EveryCellPlanner(params, kit::Sight::eager) {}
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "theta_star", ThetaStar, kit::AnyAngleParams,
                "Theta*: straight legs between cells that see each other, each looked at when it "
                "is found")
