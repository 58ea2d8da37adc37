// SPDX-License-Identifier: Apache-2.0
// Theta* over the cells of a lattice.
//
// Citation: A. Nash, K. Daniel, S. Koenig, A. Felner: Theta*: Any-Angle Path Planning on Grids.
//   AAAI 2007, pp. 1177-1183.
// Guarantees: every leg satisfies every constraint; finds a route over free cells if there is one
//   (angle_rule: complete: also under limits on turns and climb), and where cells alone decide, the
//   route is never longer than the shortest over the grid.
// Complexity: O(n log n) time, O(n) memory in the cells, and one or two lines of sight for each
//   path that may be shorter, over as many cells as the leg intersects.
// Deviations: a leg is checked against every constraint of the judge, not only obstacles; where it
//   violates one at the parent's parent, the cell is reached via the expanded cell; path lengths
//   are sums of integers (kit/any_angle.hpp); an f that falls from a cell to its successor is
//   replaced by the last f; under an objective kit::CostedTheta searches, with real costs.
// Symbols: g length of the path from the start, h straight line to the goal, f = g + h.
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
                "Theta*: straight legs between cells that see each other, each checked when it is "
                "found")
