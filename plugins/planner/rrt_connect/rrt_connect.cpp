// SPDX-License-Identifier: Apache-2.0
// RRT-Connect: two rapidly-exploring random trees that grow toward each other.
//
// Citation: J. J. Kuffner, S. M. LaValle: RRT-Connect: An Efficient Approach to Single-Query Path
//   Planning. IEEE International Conference on Robotics and Automation, 2000, pp. 995-1001.
//   doi:10.1109/ROBOT.2000.844730
// Guarantees: every leg satisfies every constraint; probabilistically complete (without limits on
//   two consecutive legs). Not optimal, nor near-optimal.
// Complexity: O(log n) for the nearest of n nodes spread over a volume, O(n) memory.
// Deviations: the other root is the first sample, so that a straight path is found at once; the
//   remaining distance to connect is split into equal legs, as a short last one might violate the
//   minimum leg length; where limits on turn and climb would be violated, a leg is bent until they
//   are satisfied; a node within the goal's tolerance ends the search; after 1000 edges every other
//   sample is the middle of a bridge (bridges.hpp), for narrow passages, except in clutter.
// Symbols: q_rand the sample, q_near the nearest node, q_new the end of the new leg.
#include "altiplan/kit/dubins/steering_params.hpp"
#include "altiplan/kit/scratch.hpp"
#include "altiplan/params.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "pose_edges.hpp"
#include "straight_edges.hpp"
#include "two_trees.hpp"

namespace {

using namespace altiplan;

struct Params : kit::SteeringParams {
  AutoNumber range_m;
  int max_iterations = 100'000;

  void describe(Fields& f) {
    f("range_m", range_m)
        .unit("m")
        .greater_than(0)
        .doc(
            "longest edge by which a tree grows; auto: a tenth of the volume's diagonal, with "
            "turns "
            "at least a circle");
    f("max_iterations", max_iterations).at_least(1).doc("maximum number of edges tried");
    SteeringParams::describe(f);
  }
};

class RrtConnect final : public Planner {
 public:
  explicit RrtConnect(const Params& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    const auto memory = memory_.take();
    const double turn_radius = params_.turn_radius(request);
    const double range = kit::SteeringParams::range(kit::range_of(params_.range_m.value, request),
                                                    !params_.range_m.value, turn_radius);
    const rrt_connect::Settings settings{range, std::uint64_t(params_.max_iterations), turn_radius};
    if (auto refused = kit::unsolvable(request, turn_radius)) {
      return *refused;
    }
    if (turn_radius == 0) {
      return rrt_connect::TwoTrees<rrt_connect::StraightEdges>(request, settings, *memory).run();
    }
    return rrt_connect::TwoTrees<rrt_connect::PoseEdges>(request, settings, *memory).run();
  }
  Traits do_traits() const override {
    Traits traits;
    traits.loiters = params_.loiters();
    return traits;
  }

  Params params_;
  mutable kit::ScratchPool<rrt_connect::Memory> memory_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "rrt_connect", RrtConnect, Params,
                "RRT-Connect: random trees from both ends that grow toward each other")
