// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/local_planner.hpp"

namespace altiplan::host {

/// Flies a local planner from start to goal in the known world, without a route: what `plan: NAME`
/// does when NAME is a local planner. One step is one iteration; `expanded` counts steps. The route
/// so far stays in the result when it does not arrive.
PlanResult roll_out(const LocalPlanner& planner, const Request& request);
}  // namespace altiplan::host
