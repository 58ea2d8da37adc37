// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gate/plan_report.hpp"

namespace altiplan::host {

/// Throws Error if no position of the mission has ground below it.
void expect_on_ground(const formats::MissionFile& plan, const World& world);
/// The ground's height at a home that is off it, from which heights count; none where home is none
/// such.
std::optional<double> height_of_home(const formats::MissionFile& plan, const World& world);
formats::MissionFile with_home_at(formats::MissionFile plan, double altitude_m);
/// A home off the ground, from which heights count.
void add_home(PlanReport& report, const formats::MissionFile& plan, const World& world);
/// A vehicle may be sent to a rally point from anywhere: the place alone is judged, not a way
/// there.
/// With a cure where another height is one.
void add_rally(PlanReport& report, const formats::MissionFile& plan, const Request& request);
/// The mission with rally points at heights that are valid, where there are any near theirs.
formats::MissionFile with_rally_raised(formats::MissionFile plan, const Request& request);
}  // namespace altiplan::host
