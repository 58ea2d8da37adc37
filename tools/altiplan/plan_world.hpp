// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/formats/mission_file.hpp"
#include "check_plan.hpp"
#include "host/config/config.hpp"

namespace altiplan::cli {

/// The files of --terrain, and all models in its folders.
std::vector<std::string> models_of(const PlanCheck& plan);

/// Where the mission may send the vehicle; 0, 0 stands for the place where it is.
std::vector<LonLat> positions_of(const formats::MissionFile& mission);

/// The scenario that the options of `altiplan check MISSION --terrain …` describe. Throws Error.
host::Config world_of(const PlanCheck& plan, const formats::MissionFile& mission,
                      const host::Overrides& overrides);

/// Names of the zones beside the line of a KML or GeoJSON file that the world of a check does not
/// have: nothing says whether they are closed.
std::vector<std::string> zones_not_judged(const PlanCheck& plan,
                                          const formats::MissionFile& mission);

/// A message about a file of that scenario, without its place in text that nobody has written.
std::string about_file(const Error& error);
}  // namespace altiplan::cli
