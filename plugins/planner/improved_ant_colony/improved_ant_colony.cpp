// SPDX-License-Identifier: Apache-2.0
// The improved ant colony: wide steps over fine cells, regional pheromone, trimmed routes.
//
// Citation: Li Rongsheng, Yang Xiaolong, Yan Xijun, Ren Tianzhu: Path planning for flight vehicles
//   based on improved ACO (paper 004).
// Guarantees: every leg satisfies every constraint; a larger budget never gives a longer route; the
//   result does not depend on the number of threads. Neither complete nor optimal.
// Complexity: O(k) per step for k candidates, also after evaporation; O(r^2) per pheromone deposit.
//   32 bytes per cell, plus one for each candidate whose leg is remembered.
// Deviations: eta_min and eta_max are taken over the allowed candidates, not over all of them (with
//   which most ants die); an ant that sees the goal within its neighbourhood moves to it; the
//   candidates of a cell are remembered, nearest to the goal first; pheromone is deposited every
//   l_c along the trimmed legs (`deposit`: on every cell, or on nodes alone, is worse); `heuristic:
//   geodesic` is ours. Under an objective routes are trimmed where that costs no more. The paper's
//   last part, smoothing, is a separate step: hermite.
// Symbols: l_c the reach of a step and l_s the spacing of candidates in cells, C the tilt of the
//   roulette, r and mu radius and decay of the region, tau^equ its pheromone; alpha, beta, rho, Q
//   as in ant_colony.
#include "altiplan/error.hpp"
#include "altiplan/kit/scratch.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "region_colony.hpp"

namespace {

using namespace altiplan;
using improved_ant_colony::Deposit;
using improved_ant_colony::Heuristic;
using improved_ant_colony::LegTest;
using improved_ant_colony::RegionColony;
using improved_ant_colony::Settings;

bool has_room(int reach, int spacing) {
  return improved_ant_colony::candidates(reach, spacing) <=
         std::int64_t(RegionColony::kMaxCandidates);
}

struct Params : kit::ColonyParams {
  Settings settings;
  std::optional<int> min_steps;

  void describe(Fields& f) {
    ColonyParams::describe(f);
    f("reach_cells", settings.reach)
        .range(1, 1000)
        .doc("l_c: a step leads to the border of the square of this half-width around the ant");
    f("min_steps", min_steps)
        .range(1, 1'000'000)
        .was("least_steps")
        .doc("N_c of eq. (6): steps from start to goal in open air, in place of reach_cells");
    f("spacing_cells", settings.spacing)
        .range(0, 1000)
        .doc("l_s: cells skipped between candidates, from each corner to the middle of a side");
    f("leg_test", settings.leg_test,
      {{"remembered", LegTest::remembered},
       {"guard_zone", LegTest::guard_zone},
       {"always", LegTest::always}})
        .doc(
            "when legs are tested against the cells: every time (always); only near blocked "
            "cells (guard_zone); there, and once per plan (remembered); the route is the same");
    f("tilt", settings.tilt)
        .range(0, 0.999)
        .doc(
            "C of eq. (8): candidates below this fraction of the range of eta are excluded; 0: "
            "none");
    f("region_radius", settings.region_radius)
        .range(0, 20)
        .doc("r of eq. (10): rings of cells whose pheromone counts; 0: only the cell's own");
    f("region_decay", settings.region_decay)
        .range(0, 1)
        .doc("mu of eq. (10): decay from ring to ring");
    f("heuristic", settings.heuristic,
      {{"euclidean", Heuristic::euclidean}, {"geodesic", Heuristic::geodesic}})
        .doc(
            "eta is 1 over the distance to the goal: the straight line, eq. (9), or over the "
            "free cells (geodesic)");
    f("trim", settings.trims).doc("trim routes before pheromone is deposited, eq. (11)");
    settings.trim.describe(f);
    f("deposit", settings.deposit,
      {{"resampled", Deposit::resampled}, {"cells", Deposit::cells}, {"nodes", Deposit::nodes}})
        .doc(
            "where pheromone is deposited: every reach_cells along the legs, on every cell of "
            "them, or on the nodes alone");
    f.check(has_room(settings.reach, settings.spacing),
            "reach_cells and spacing_cells together give more than 56 candidates");
  }
};

class ImprovedAntColony final : public kit::ColonyPlanner {
 public:
  explicit ImprovedAntColony(const Params& params)
      : ColonyPlanner("improved_ant_colony", params_, RegionColony::kBytesPerCell),
        params_(params) {}

 private:
  PlanResult search(const Request& request, const kit::Lattice& lattice) const override {
    Settings settings = params_.settings;
    if (params_.min_steps) {
      settings.reach = reach_for(*params_.min_steps, request, lattice);
    }
    const auto memory = memory_.take();
    return RegionColony(request, params_, settings, lattice, *memory).run();
  }

  /// Eq. (6).
  int reach_for(int min_steps, const Request& request, const kit::Lattice& lattice) const {
    const double cells = (request.goal.position - request.start.position).norm() /
                         (min_steps * lattice.spec().cell.x());
    const int reach = std::max(1, int(std::min(std::ceil(cells), 1e6)));
    if (!has_room(reach, params_.settings.spacing)) {
      throw ParameterError("min_steps", "gives a reach of " + std::to_string(reach) +
                                            " cells, and with spacing_cells more than 56 "
                                            "candidates: choose more steps or wider spacing");
    }
    return reach;
  }

  Params params_;
  mutable kit::ScratchPool<RegionColony::Memory> memory_;
};
}  // namespace

ALTIPLAN_PLUGIN(Planner, "improved_ant_colony", ImprovedAntColony, Params,
                "ant colony with wide steps, regional pheromone and trimmed routes, paper 004")
