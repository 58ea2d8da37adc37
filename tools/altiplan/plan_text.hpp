// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/base/json.hpp"
#include "host/gate/plan_report.hpp"
#include "host/mission/mission.hpp"

namespace altiplan::cli {

/// "item 3 (waypoint) to item 4 (waypoint)", of what is wrong with a plan.
std::string items_of(const host::Finding& finding);
/// "mission.plan, 16 waypoints, 10.713 km, at least 53.1 m above ground, 17.9 to 21.7 min"
std::string figures_of(const host::PlanReport& report);
/// The verdict on the returns, and for each stretch that is refused a line.
std::vector<std::string> lines_of_returns(const host::PlanReport& report);
void print_plan(const host::PlanReport& report, const host::Mission& world);
host::Json plan_json(const host::PlanReport& report, const host::Mission& world);
}  // namespace altiplan::cli
