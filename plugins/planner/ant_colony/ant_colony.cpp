// SPDX-License-Identifier: Apache-2.0
// The ant colony on a grid of eight neighbours.
//
// Citation: M. Dorigo, V. Maniezzo, A. Colorni: Ant System: Optimization by a Colony of Cooperating
//   Agents. IEEE Transactions on Systems, Man, and Cybernetics B 26(1), 1996, 29-41,
//   doi:10.1109/3477.484436; on grids as the baseline of paper 004 (Li Rongsheng, Yang Xiaolong,
//   Yan Xijun, Ren Tianzhu: Path planning for flight vehicles based on improved ACO), section 1.
// Guarantees: every leg satisfies every constraint; a larger budget never gives a longer route; the
//   result does not depend on the number of threads. Neither complete nor optimal.
// Complexity: O(1) per step, also after evaporation; 224 bytes per cell.
// Deviations: an ant next to the goal moves to it (with eta = 1/d_j that would be certain anyway);
//   besides `leg` and `goal`, the two published readings of eta, with which no ant ever arrives on
//   the paper's map, there is `goal_scaled`, which behaves as the published baseline does. Diagonal
//   legs cut no corners.
// Symbols: tau the pheromone of a leg, eta its heuristic, alpha and beta their powers, L_k the
//   length of ant k's route, rho the evaporation.
#include "altiplan/kit/scratch.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "leg_colony.hpp"

namespace {

using namespace altiplan;
using ant_colony::Heuristic;
using ant_colony::LegColony;

struct Params : kit::ColonyParams {
  Heuristic heuristic = Heuristic::goal_scaled;

  void describe(Fields& f) {
    ColonyParams::describe(f);
    f("heuristic", heuristic,
      {{"goal_scaled", Heuristic::goal_scaled}, {"goal", Heuristic::goal}, {"leg", Heuristic::leg}})
        .doc(
            "eta of a neighbour: 1 over its extra distance to the goal, compared with the "
            "nearest free neighbour, plus one cell (goal_scaled); 1 over its distance to the "
            "goal (goal); or 1 over the length of the leg (leg), as published");
  }
};

class AntColony final : public kit::ColonyPlanner {
 public:
  explicit AntColony(const Params& params)
      : ColonyPlanner("ant_colony", params_, LegColony::kBytesPerCell), params_(params) {}

 private:
  PlanResult search(const Request& request, const kit::Lattice& lattice) const override {
    const auto memory = memory_.take();
    return LegColony(request, params_, params_.heuristic, lattice, *memory).run();
  }

  Params params_;
  mutable kit::ScratchPool<LegColony::Memory> memory_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "ant_colony", AntColony, Params,
                "ant colony on an eight-connected grid, the baseline of paper 004")
