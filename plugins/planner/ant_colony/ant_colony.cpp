// SPDX-License-Identifier: Apache-2.0
// The ant colony on a grid of eight neighbours.
//
// Citation: M. Dorigo, V. Maniezzo, A. Colorni: Ant System: Optimization by a Colony of Cooperating
//   Agents. IEEE Transactions on Systems, Man, and Cybernetics B 26(1), 1996, 29-41,
//   doi:10.1109/3477.484436; on grids as the baseline of paper 004 (Li Rongsheng, Yang Xiaolong,
//   Yan Xijun, Ren Tianzhu: Path planning for flight vehicles based on improved ACO), section 1.
// Guarantees: every leg keeps every rule; more budget never gives a longer route; one result for
//   any number of threads. Neither complete nor optimal.
// Complexity: O(1) a step, whatever has evaporated; 224 bytes a cell.
// Deviations: an ant beside the goal goes there (with eta = 1/d_j it would be certain anyway);
//   beside `leg` and `goal`, the two readings of eta that are printed and with which no ant ever
//   arrives on the paper's map, `goal_scaled`, which behaves as the published baseline does.
//   Diagonal legs cut no corners.
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
            "eta of a neighbour: 1 over how much farther from the goal it is than the nearest "
            "free neighbour, and a cell (goal_scaled); 1 over its distance to the goal (goal); or "
            "1 over the length of the leg (leg), as printed");
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
                "ants on a grid of eight neighbours, the baseline of paper 004")
