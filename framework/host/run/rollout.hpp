// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/local_planner.hpp"

namespace altiplan::host {

/// Flies a local planner from start to goal in the known world, without a route: `plan: NAME` with
/// a local planner. One step is one iteration; `expanded` counts steps. If it does not arrive, the
/// result keeps the route so far.
PlanResult roll_out(const LocalPlanner& planner, const Request& request);
}  // namespace altiplan::host
