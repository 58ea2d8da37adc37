// SPDX-License-Identifier: Apache-2.0
// D* Lite: a shortest way, repaired where the world changes while the vehicle flies.
//
// Citation: S. Koenig, M. Likhachev: D* Lite. AAAI 2002; Fast Replanning for Navigation in Unknown
//   Terrain. IEEE Transactions on Robotics 21(3), 2005, doi:10.1109/TRO.2004.838026 (the optimized
//   version). Raises that wait for a route: D. Ferguson, A. Stentz: The Delayed D* Algorithm for
//   Efficient Path Replanning. ICRA 2005.
// Guarantees: complete and optimal on its lattice, after every update too; under rules that look at
//   two legs by (cell, heading).
// Complexity: O(n log n) time, O(n) memory in the cells of the lattice for a plan; a repair takes
//   what the change moves, the length of the route, and a look at the words of the occupancy inside
//   the changes' boxes.
// Deviations: costs are whole numbers (kit::StepCosts); start and goal are places off the cells,
//   each with links to some, and the start's g is never stored; keys have one part, and among equal
//   ones a raise comes first, then what was pushed last: the cells of equal ways are not all
//   opened; vertices to be raised on account of a change wait until a route leads over them; stale
//   entries of the open list are skipped when they are taken.
// Symbols: g, rhs cost of the way to the goal, as known and by one leg's look ahead; h estimate of
//   the way to the start; k_m what keys on the open list may be behind by.
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
            "what rules that look at two legs (limits on turns, constraints) are held against: the "
            "shortest way over cells alone (parent), every direction in which a cell is reached "
            "(cell_and_heading), or auto: the second where the first does not keep them");
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
