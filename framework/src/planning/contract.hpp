// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "altiplan/plan_result.hpp"
#include "altiplan/request.hpp"

namespace altiplan {

/// Runs a plugin's code: exceptions become PluginError, except the framework's own misuse errors,
/// which the user has to correct, and the end of a budget, which is a result.
PlanResult guarded(const std::function<PlanResult()>& call);

/// Checks a result against the contract on a route's ends; `start` and `goal` are those requested.
PlanResult held_to_contract(PlanResult result, const State& start, const Goal& goal,
                            const Budget& budget);

bool legs_are_well_formed(const Route& route);
inline constexpr const char* kMalformedLeg =
    "returns a leg with a number that is not finite, a turn without a radius above 0 or of more "
    "than a hundred circles, or a wait that has a length";
}  // namespace altiplan
