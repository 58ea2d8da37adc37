// SPDX-License-Identifier: Apache-2.0
// Lazy Theta* over the cells of a lattice.
//
// Citation: A. Nash, S. Koenig, C. Tovey: Lazy Theta*: Any-Angle Path Planning and Path Length
//   Analysis in 3D. AAAI 2010, doi:10.1609/aaai.v24i1.7566.
// Guarantees: every leg satisfies every constraint; finds a route over free cells if there is one
//   (angle_rule: complete: also under limits on turns and climb), and where cells alone decide, the
//   route is never longer than the shortest over the grid.
// Complexity: O(n log n) time, O(n) memory in the cells, and one line of sight each time a cell is
//   popped from the open list, over as many cells as the leg intersects.
// Deviations: a cell that its parent does not see is queued again, with its length via its best
//   closed neighbour; a leg is checked against every constraint of the judge; where it violates a
//   limit at the parent's parent, the cell is reached via the expanded cell; path lengths are sums
//   of integers (kit/any_angle.hpp); an f that falls along a step is replaced by the last f;
//   under an objective kit::CostedTheta searches, with real costs.
// Symbols: g length of the path from the start, h straight line to the goal, f = g + h.
#include "altiplan/kit/any_angle/any_angle_planner.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"

namespace {

using namespace altiplan;

class LazyThetaStar final : public kit::EveryCellPlanner {
 public:
  explicit LazyThetaStar(const kit::AnyAngleParams& params)
      : EveryCellPlanner(params, kit::Sight::lazy) {}
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "lazy_theta_star", LazyThetaStar, kit::AnyAngleParams,
                "Lazy Theta*: straight legs between cells that see each other, each checked when "
                "its end is expanded")
