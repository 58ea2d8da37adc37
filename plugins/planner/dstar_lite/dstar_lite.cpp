// SPDX-License-Identifier: Apache-2.0
// D* Lite: a shortest path, repaired where the world changes while the vehicle flies.
//
// Citation: S. Koenig, M. Likhachev: D* Lite. AAAI 2002; Fast Replanning for Navigation in Unknown
//   Terrain. IEEE Transactions on Robotics 21(3), 2005, doi:10.1109/TRO.2004.838026 (the optimized
//   version). Delayed raises: D. Ferguson, A. Stentz: The Delayed D* Algorithm for Efficient Path
//   Replanning. ICRA 2005.
// Guarantees: complete and optimal on its lattice, also after every update; under constraints on
//   two consecutive legs when searching by (cell, heading).
// Complexity: O(n log n) time, O(n) memory in the cells of the lattice for a plan; a repair takes
//   time in the number of affected vertices, the length of the route, and the occupancy words
//   inside the changes' boxes.
// Deviations: costs are integers (kit::StepCosts); start and goal lie off the cells, each linked to
//   some of them, and the start's g is never stored; keys have one part, and among equal ones a
//   raise comes first, then the last one pushed, so that not all cells of equal paths are expanded;
//   vertices to be raised because of a change wait until a route passes over them; stale entries of
//   the open list are skipped when popped.
// Symbols: g, rhs cost of the path to the goal, as known and by one-step lookahead; h estimate of
//   the path to the start; k_m the amount by which keys on the open list may lag.
#include <memory>

#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "dstar_session.hpp"

namespace {

using namespace altiplan;

struct Params : kit::SearchParams {
  void describe(Fields& f) {
    describe_lattice(f);
    f("state", search.state,
      {{"auto", kit::SearchState::automatic},
       {"parent", kit::SearchState::parent},
       {"cell_and_heading", kit::SearchState::cell_and_heading}})
        .doc(
            "where constraints on two consecutive legs (turn limits, constraint plugins) are "
            "checked: on the shortest path over cells alone (parent), for every direction in "
            "which a cell is reached (cell_and_heading), or auto: the second if the first "
            "violates them");
    describe_memory(f);
  }
};

class DStarLite final : public Planner {
 public:
  explicit DStarLite(const Params& params) : params_(params) {}

 private:
  PlanResult do_plan(const Request& request) const override {
    return dstar_lite::Replanner(params_, request, pools_).plan();
  }
  std::unique_ptr<Session> do_begin(const Request& request) const override {
    return std::make_unique<dstar_lite::DStarSession>(params_, request, pools_);
  }
  Traits do_traits() const override {
    Traits traits;
    traits.complete = true;
    traits.optimal = true;
    traits.incremental = true;
    return traits;
  }

  Params params_;
  mutable dstar_lite::Pools pools_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "dstar_lite", DStarLite, Params,
                "D* Lite on a 3-D or level lattice: repairs its plan where the world changes")
