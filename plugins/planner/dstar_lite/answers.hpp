// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "altiplan/check.hpp"
#include "problem.hpp"

namespace altiplan::dstar_lite {

/// The constraint that a leg of the route violates, or "".
inline std::string first_broken(const Polyline& route, const Request& request) {
  std::optional<Approach> before = request.before_start();
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    if (!leg_ok(before, route[i], route[i + 1], request)) {
      return leg_violations(before, route[i], route[i + 1], request, i).front().constraint;
    }
    before = onward(before, route[i]);
  }
  return "";
}

/// Explains why there is no route: the search's progress and what stopped it.
inline std::string explanation(PlanStatus status, const kit::SearchStats& progress,
                               const Problem& problem, const kit::MoveRules& rules) {
  std::string text = status == PlanStatus::no_route    ? "no route"
                     : status == PlanStatus::cancelled ? "cancelled"
                     : progress.memory_full            ? "max_memory_mb or within_mb is used up"
                                                       : "the budget was used up";
  text += ": " + std::to_string(progress.expanded) + " vertices expanded on " +
          std::to_string(problem.lattice.size()) + " cells";
  if (progress.expanded > 0) {
    const Vec3& at = progress.nearest;
    text += ", from the goal, the nearest to the start at " + problem.request.place_text(at) +
            ", " + std::to_string(std::llround((at - problem.request.start.position).norm())) +
            " m from it";
  }
  const std::string refusals = rules.refusals();
  return refusals.empty() ? text : text + "; refused moves: " + refusals;
}
}  // namespace altiplan::dstar_lite
