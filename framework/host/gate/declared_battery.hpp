// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/gate/plan_report.hpp"

namespace altiplan::host {

/// Takes the battery of a declared vehicle, with the least and the greatest power of its steady
/// flight at the speeds and rates of climb and sink that the autopilots may fly a mission at, in
/// the wind; or why these are not known. Nothing where options have a battery, or the vehicle
/// declares none.
void take_battery(const Vehicle& vehicle, const formats::MissionFile& plan, GateOptions& options);
}  // namespace altiplan::host
