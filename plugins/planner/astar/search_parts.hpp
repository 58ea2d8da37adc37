// SPDX-License-Identifier: Apache-2.0
// What the two searches have in common: their settings, and what they say in the end.
#pragma once

#include <algorithm>
#include <string>

#include "altiplan/kit/lattice.hpp"
#include "altiplan/kit/move_rules.hpp"
#include "altiplan/kit/step_costs.hpp"
#include "altiplan/planner.hpp"

namespace altiplan::astar {

enum class Heuristic { octile, euclidean, manhattan, zero };

struct Settings {
  Vec3 cell_m{50, 50, 10};
  kit::Neighbourhood neighbours = kit::Neighbourhood::all;
  kit::CornerRule corner = kit::CornerRule::any;
  kit::MoveCheck moves = kit::MoveCheck::exact;
  kit::StepCosts::Scale costs = kit::StepCosts::Scale::fine;
  Heuristic heuristic = Heuristic::octile;
  double weight_g = 0.5;
  double weight_h = 0.5;
  std::size_t max_bytes = ~std::size_t{0};

  /// Whether no cell's best way is found only after the cell was closed.
  bool consistent() const { return weight_h <= weight_g && heuristic != Heuristic::manhattan; }
};

/// What a search has done so far.
struct Progress {
  std::uint64_t expanded = 0;
  std::int64_t generated = 0;
  Vec3 nearest{0, 0, 0};  ///< of the expanded cells to the goal
  bool memory_full = false;
  bool too_long = false;  ///< route_length refused something
};

inline Counters counters(const Progress& progress, const kit::Lattice& lattice,
                         const kit::MoveRules& rules) {
  return {{"expanded", std::int64_t(progress.expanded)},
          {"generated", progress.generated},
          {"moves_checked", rules.moves_checked()},
          {"lattice_cells", std::int64_t(lattice.size())}};
}

/// Says why there is no route: how far the search came, and what stopped it.
inline std::string explanation(Status status, const Progress& progress, const Request& request,
                               const kit::Lattice& lattice, const kit::MoveRules& rules) {
  std::string text = status == Status::no_route    ? "no route"
                     : status == Status::cancelled ? "cancelled"
                     : progress.memory_full        ? "the memory allowed was used up"
                                                   : "the budget was used up";
  text += ": " + std::to_string(progress.expanded) + " of " + std::to_string(lattice.size()) +
          " cells expanded";
  if (progress.expanded > 0) {
    const Vec3& at = progress.nearest;
    const auto whole = [](double value) { return std::to_string(std::llround(value)); };
    text += ", the nearest to the goal at (" + whole(at.x()) + ", " + whole(at.y()) + ", " +
            whole(at.z()) + "), " + whole((at - request.goal.position).norm()) + " m from it";
  } else if (status == Status::no_route) {
    text += ", the start cannot join the lattice";
  }
  const std::string refusals = rules.refusals();
  if (!refusals.empty()) {
    text += "; refused moves: " + refusals;
  }
  if (progress.too_long) {
    text += "; parts of the search left out by route_length";
  }
  return text;
}

/// The route from the start over the cells that led to `last`: `step_to(index, likely)` is the
/// direction of the step to a cell, kHere at a cell that is linked to the start, and `likely` that
/// of the step after it; `at_start(index)` is whether that link has no length.
template <class StepTo, class AtStart>
Route route_to(std::uint32_t last, const Request& request, const kit::Lattice& lattice,
               const StepTo& step_to, const AtStart& at_start) {
  Route route;
  std::uint32_t index = last;
  for (int d = step_to(index, kit::kHere); d != kit::kHere; d = step_to(index, d)) {
    route.push_back(lattice.position(lattice.cell(index)));
    index = std::uint32_t(std::int64_t(index) - lattice.stride(d));
  }
  if (!at_start(index)) {
    route.push_back(lattice.position(lattice.cell(index)));
  }
  route.push_back(request.start.position);
  std::reverse(route.begin(), route.end());
  return route;
}

/// Ends the route at the goal; `at_goal`: the last cell's centre is the goal but for rounding.
inline void end_at_goal(Route& route, const Vec3& goal, bool at_goal) {
  if (at_goal && route.size() > 1) {
    route.back() = goal;
  } else {
    route.push_back(goal);
  }
}

inline PlanResult solved(Route route, const Progress& progress, const kit::Lattice& lattice,
                         const kit::MoveRules& rules) {
  PlanResult result;
  result.status = Status::solved;
  result.route = std::move(route);
  result.message = "a route of " + std::to_string(length(result.route)) + " m, " +
                   std::to_string(progress.expanded) + " cells expanded";
  result.counters = counters(progress, lattice, rules);
  return result;
}
}  // namespace altiplan::astar
