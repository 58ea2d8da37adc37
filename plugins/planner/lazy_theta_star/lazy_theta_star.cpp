// SPDX-License-Identifier: Apache-2.0
// Lazy Theta* over the cells of a lattice.
//
// Citation: A. Nash, S. Koenig, C. Tovey: Lazy Theta*: Any-Angle Path Planning and Path Length
//   Analysis in 3D. AAAI 2010, doi:10.1609/aaai.v24i1.7566.
// Guarantees: every leg keeps every rule; a route over free cells is found where there is one
//   (angle_rule: complete: under limits on turns and climb too), and where cells alone decide it is
//   never longer than the shortest over the grid.
// Complexity: O(n log n) time, O(n) memory in the cells, and a line of sight each time that a cell
//   is taken from the open list, over as many cells as the leg meets.
// Deviations: a cell that its parent does not see waits for its turn again, with the length that it
//   has by its best closed neighbour; a leg is held to every rule of the judge; where it breaks a
//   limit at the parent's parent the cell is reached by way of the expanded cell; ways are sums of
//   whole numbers (kit/any_angle.hpp); f that falls along a step counts as the last f.
// Symbols: g length of the way from the start, h straight line to the goal, f = g + h.
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
                "Lazy Theta*: straight legs between cells that see each other, each looked at when "
                "its end is expanded")
