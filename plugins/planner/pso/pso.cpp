// SPDX-License-Identifier: Apache-2.0
// Particle swarm optimisation of whole routes.
//
// Citation: J. Kennedy, R. Eberhart: Particle swarm optimization. ICNN 1995,
//   doi:10.1109/ICNN.1995.488968; inertia: Y. Shi, R. Eberhart, ICEC 1998,
//   doi:10.1109/ICEC.1998.699146; defaults of M. Clerc, J. Kennedy, IEEE Transactions on
//   Evolutionary Computation 6(1), 2002, doi:10.1109/4235.985692.
// Guarantees: a larger budget never gives a costlier route; the result does not depend on the
// number
//   of threads. Neither complete nor optimal.
// Complexity: an evaluation of a route for each particle and iteration.
// Deviations: the global best changes once per iteration, so that evaluations are independent; a
//   particle that leaves the cube stops at its side and turns back; routes are compared by the
//   rules of feasibility (kit/population).
// Symbols: in kit/population/swarm.cpp, which has the equations.
#include "altiplan/kit/population/swarm.hpp"
#include "altiplan/plugin.hpp"

namespace {
using namespace altiplan;

class Pso final : public kit::PopulationPlanner {
 public:
  explicit Pso(const kit::SwarmParams& params) : PopulationPlanner(params_), params_(params) {}

 private:
  void search(kit::Population& population) const override {
    kit::search_by_swarm(population, params_);
  }

  kit::SwarmParams params_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "pso", Pso, kit::SwarmParams,
                "particle swarm over whole routes, for any objective")
