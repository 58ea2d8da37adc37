// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "altiplan/error.hpp"
#include "altiplan/kit/lattice/lattice_params.hpp"
#include "altiplan/kit/lattice/lattice_search.hpp"

namespace altiplan::kit {

/// Common parameters of searches over the cells of a lattice.
struct SearchParams {
  enum class Moves { automatic, exact, cells };

  SearchSettings search;
  int neighbours = 26;
  Moves moves = Moves::automatic;
  int max_memory_mb = 4096;

  void describe(Fields& f) {
    describe_lattice(f);
    f("heuristic", search.heuristic,
      {{"octile", Heuristic::octile},
       {"euclidean", Heuristic::euclidean},
       {"manhattan", Heuristic::manhattan},
       {"zero", Heuristic::zero}})
        .doc(
            "estimate of the cost-to-go: octile is the length on an empty lattice; manhattan is "
            "not admissible with 26 neighbours, nor octile with 6");
    f("weight_g", search.weight_g)
        .range(0, 1)
        .doc("weight of the cost-to-come g in f, paper 002 eq. (10)");
    f("weight_h", search.weight_h).range(0, 1).doc("weight of the heuristic in f");
    f.check(search.weight_g + search.weight_h > 0, "weight_g and weight_h must not both be 0");
    f.check(is_weight(search.weight_g) && is_weight(search.weight_h),
            "weight_g and weight_h must each be 0 or at least 1e-9");
    f("state", search.state,
      {{"auto", SearchState::automatic},
       {"parent", SearchState::parent},
       {"cell_and_heading", SearchState::cell_and_heading}})
        .doc(
            "search state for turn limits: a cell with a single parent, which can miss a route, or "
            "a cell and the direction into it; auto: the second if the first finds nothing");
    describe_costs(f);
    f("anytime", search.anytime)
        .doc("find a route fast, then better ones, the last as good as without this option");
    describe_memory(f);
  }

  void describe_lattice(Fields& f) {
    describe_cell(f, search.cell_m);
    f("neighbours", neighbours)
        .doc("neighbours of a cell: 26 (8 in level flight) or 6 (4 in level flight)")
        .range(6, 26);
    f.check(neighbours == 6 || neighbours == 26, "neighbours must be 6 or 26");
    f("corner", search.corner, {{"any", CornerRule::any}, {"free_box", CornerRule::free_box}})
        .doc(
            "with moves by cells: a step needs its two cells free (any), or every cell of its "
            "bounding box (free_box)");
    f("moves", moves,
      {{"auto", Moves::automatic}, {"exact", Moves::exact}, {"cells", Moves::cells}})
        .doc(
            "how a move is checked against obstacles: the straight leg against the exact world, or "
            "the cells that it crosses; auto: cells if every layer has its own cells and the "
            "vehicle needs no clearance, else exact");
  }

  void describe_memory(Fields& f) {
    f("max_memory_mb", max_memory_mb)
        .unit("MB")
        .at_least(1)
        .doc(
            "memory limit: a search ends where it has used it; where memory for the whole lattice "
            "is taken beforehand, one that needs more is refused");
  }

  void describe_costs(Fields& f) {
    CostWeights& cost = search.cost;
    f("weight_length", cost.length)
        .range(0, 1000)
        .doc("weight w_L of the length in the cost, paper 002 eq. (11)");
    f("weight_altitude", cost.altitude)
        .range(0, 1000)
        .doc("weight w_C of the altitude above sea, eq. (13)");
    f("weight_threat", cost.threat)
        .range(0, 1000)
        .doc(
            "weight w_T of the sum over threats of 10 / horizontal distance to the centre, eq. "
            "(14)");
    f("accumulate", cost.accumulate, {{"length", Accumulate::length}, {"none", Accumulate::none}})
        .doc(
            "altitude and threats count along the whole route (length), or as printed only at the "
            "node itself (none): they then order the search, but do not choose between paths");
    f("length_unit_m", cost.unit_m)
        .unit("m")
        .range(0.001, 1e6)
        .doc("unit of lengths, altitudes and distances in the cost");
    f.check(is_weight(cost.length) && is_weight(cost.altitude) && is_weight(cost.threat),
            "weight_length, weight_altitude and weight_threat must each be 0 or at least 1e-9");
    f.check(cost.length + cost.altitude + cost.threat > 0,
            "weight_length, weight_altitude and weight_threat must not all be 0");
  }

  /// Settings of the search for a planner with these parameters.
  SearchSettings settings() const {
    SearchSettings settings = search;
    settings.neighbours = neighbours == 26 ? Neighbourhood::all : Neighbourhood::faces;
    if (neighbours == 6 && search.heuristic == Heuristic::manhattan) {
      // On an empty lattice of faces the two are equal; octile also has the goal's straight last
      // leg.
      settings.heuristic = Heuristic::octile;
    }
    return settings;
  }
  SearchSettings settings(const Request& request) const {
    if (request.objective && !(search.cost.length_alone() && search.cost.length == 1)) {
      throw ParameterError(search.cost.altitude > 0 ? "weight_altitude"
                           : search.cost.threat > 0 ? "weight_threat"
                                                    : "weight_length",
                           "the weights of a cost are for problems without an objective: remove "
                           "them, or give objective: {length: {}}");
    }
    SearchSettings settings = this->settings();
    settings.moves = move_check(request);
    settings.max_bytes = std::min(max_bytes(), request.budget.max_memory_bytes);
    return settings;
  }
  std::size_t max_bytes() const { return std::size_t(max_memory_mb) * 1024 * 1024; }

  Traits traits() const {
    const SearchSettings s = settings();
    const bool shortest = s.cost.length_alone() && s.cost.length > 0;
    Traits traits;
    traits.complete = true;
    traits.optimal = shortest && s.weight_g > 0 && s.stretch() * s.weight_h <= s.weight_g &&
                     s.costs == StepCosts::Scale::fine;
    traits.anytime = s.anytime && shortest;
    traits.objectives = true;
    return traits;
  }

 private:
  /// Sums of costs must keep a digit of the smallest weight.
  static bool is_weight(double weight) { return weight == 0 || weight >= 1e-9; }

  MoveCheck move_check(const Request& request) const {
    if (moves != Moves::automatic) {
      return moves == Moves::exact ? MoveCheck::exact : MoveCheck::cells;
    }
    const bool all_cells = std::all_of(
        request.world->layers().begin(), request.world->layers().end(),
        [](const Layer& layer) { return layer.environment->info().native_grid.has_value(); });
    const bool no_clearance = request.limits.min_clearance <= 0 && request.vehicle.radius_m <= 0;
    return all_cells && no_clearance && request.vehicle.body == nullptr &&
                   !request.world->layers().empty()
               ? MoveCheck::cells
               : MoveCheck::exact;
  }
};

/// True if a search has to distinguish states by their heading from the start.
inline bool begins_by_heading(const SearchSettings& settings, const Request& request) {
  return settings.state == SearchState::cell_and_heading &&
         (request.limits.turns() || request.judges_pairs());
}

/// True if a search by (cell, heading) may find a route where one with a single parent per cell has
/// found none.
inline bool heading_may_help(const SearchSettings& settings, double best_cost,
                             const SearchResult& found) {
  return settings.state != SearchState::parent && found.result.status == PlanStatus::no_route &&
         found.parent_mattered && best_cost == kInfinity;
}

/// The second search's result, with the statistics of the first one added.
inline SearchResult after_one_parent(SearchResult second, const SearchResult& first) {
  add(second.result.counters, first.result.counters);
  second.result.message += ", after the search with one parent per cell found no route";
  return second;
}
}  // namespace altiplan::kit
