// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gate/plan_report.hpp"

namespace altiplan::host {

/// Throws Error if no position of the mission has ground below it.
void expect_on_ground(const formats::MissionFile& plan, const World& world);
/// A home off the ground, from which heights count.
void add_home(PlanReport& report, const formats::MissionFile& plan, const World& world);
/// A vehicle may be sent to a rally point from anywhere: the place alone is judged, not a way
/// there.
void add_rally(PlanReport& report, const formats::MissionFile& plan, const Request& request);
}  // namespace altiplan::host
