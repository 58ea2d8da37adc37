// SPDX-License-Identifier: Apache-2.0
// Spherical-vector particle swarm: the swarm flies through lengths, climbs and headings of legs.
//
// Citation: M. D. Phung, Q. P. Ha: Safety-enhanced UAV path planning with spherical vector-based
//   particle swarm optimization. Applied Soft Computing 107, 2021, 107376,
//   doi:10.1016/j.asoc.2021.107376; constants by the authors' program (github.com/duongpm/SPSO).
// Guarantees: a larger budget never gives a costlier route; the result does not depend on the
// number
//   of threads. Neither complete nor optimal.
// Complexity: an evaluation of a route for each particle and iteration.
// Deviations: the global best changes once per iteration, not within it; routes are compared by the
//   rules of feasibility, where the program draws its first swarm until a route has a cost. The
//   program exchanges sine and cosine of the headings: `encoding: spherical_mirrored`. Defaults are
//   smaller than its 500 particles, 200 iterations and 10 waypoints (configs/pipelines/spso.yaml).
// Symbols: r, psi and phi of a leg in kit/population/route_space.cpp; of the swarm in swarm.cpp.
#include "altiplan/kit/population/swarm.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

struct Params : kit::SwarmParams {
  Params() {
    encoding = kit::Encoding::spherical;
    inertia = 1;
    damping = 0.98;
    own_pull = common_pull = 1.5;
  }
};

class Spso final : public kit::PopulationPlanner {
 public:
  explicit Spso(const Params& params) : PopulationPlanner(params_), params_(params) {}

 private:
  void search(kit::Population& population) const override {
    kit::search_by_swarm(population, params_);
  }

  Params params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "spso", Spso, Params,
                "particle swarm over lengths, climbs and headings of legs (spherical vectors)")
