// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/formats/mission_file.hpp"
#include "check_plan.hpp"
#include "host/config/config.hpp"

namespace altiplan::cli {

/// The scenario that the options of `altiplan check MISSION --terrain …` describe. Throws Error.
host::Config world_of(const PlanCheck& plan, const formats::MissionFile& mission,
                      const host::Overrides& overrides);

/// A message about a file of that scenario, without its place in text that nobody has written.
std::string about_file(const std::string& message);

/// Seconds from take-off to the end of each item, at the mission's own speed, else the given one.
std::vector<double> flown_times(const PlanCheck& plan, const formats::MissionFile& mission);
/// Seconds in which the mission is flown, for zones with hours.
double flown_s(const PlanCheck& plan, const formats::MissionFile& mission);
}  // namespace altiplan::cli
