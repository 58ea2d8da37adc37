// SPDX-License-Identifier: Apache-2.0
// RRT*: asymptotically optimal, rewires as it grows.
//
// Citation: S. Karaman, E. Frazzoli: Sampling-based Algorithms for Optimal Motion Planning.
//   International Journal of Robotics Research 30(7), 2011, pp. 846-894.
//   doi:10.1177/0278364911406761
//   `bound`: S. Karaman, M. R. Walter, A. Perez, E. Frazzoli, S. Teller: Anytime Motion Planning
//   using the RRT*. IEEE International Conference on Robotics and Automation, 2011.
//   `route_bias` after F. Islam, J. Nasir, U. Malik, Y. Ayaz, O. Hasan: RRT*-Smart: Rapid
//   convergence implementation of RRT* towards optimal solution. IEEE International Conference on
//   Mechatronics and Automation, 2012. doi:10.1109/ICMA.2012.6284384
// Guarantees: every leg satisfies every constraint; more iterations never give a longer route;
//   without limits on two consecutive legs the length converges to the shortest with probability 1.
// Complexity: O(log n) neighbours per node, found in O(log n); O(n) memory.
// Deviations: gamma uses the whole volume instead of its free part (a larger radius, on the safe
//   side); neighbours by radius, not by number: buckets find them in a fraction of the time; legs
//   from possible parents are checked in order of cost until one is valid; a node in range of the
//   goal tries to connect to it until it is in the tree; legs are bent to the limits on turn and
//   climb; under turn limits a node is rewired only if its children's turns remain valid, so the
//   length then converges to no known bound.
// Symbols: x_rand the sample, x_new the new node, eta the range, d the axes, n the nodes, gamma =
//   radius_scale (2 (1 + 1/d) volume / unit ball)^(1/d), the radius min(eta, gamma (log
//   n/n)^(1/d)).
#include "altiplan/kit/sampling/star_params.hpp"
#include "altiplan/kit/scratch.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"

namespace {

using namespace altiplan;

struct Params : kit::StarParams {
  bool bound = true;

  void describe(Fields& f) {
    StarParams::describe(f);
    f("bound", bound)
        .doc("once there is a route, reject samples through which none can be shorter");
  }
};

class RrtStar final : public Planner {
 public:
  explicit RrtStar(const Params& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    const auto memory = memory_.take();
    kit::StarSettings settings = params_.settings(request);
    settings.bounded = params_.bound;
    return kit::star_search(request, settings, *memory);
  }
  Traits do_traits() const override { return params_.traits(); }

  Params params_;
  mutable kit::ScratchPool<kit::StarMemory> memory_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "rrt_star", RrtStar, Params,
                "RRT*: asymptotically optimal, rewires as it grows")
