// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "altiplan/formats/mission_file.hpp"
#include "altiplan/value.hpp"

namespace altiplan::host {

/// If the scenario has the key `mission`, adds the start, via points and goal of that file to the
/// tree unless the scenario gives them itself: later stages treat them as if written in the
/// scenario, with their location in the mission file. The file is added to `files`. Returns a line
/// for each item that was ignored. Throws ConfigError at the key.
std::vector<std::string> add_mission(Value& scenario, std::vector<std::filesystem::path>& files);

/// The items as the points of a route, without a landing straight below the last one. Throws Error
/// if the file has none, or if they do not form a route.
std::vector<formats::MissionItem> route_items(const formats::MissionFile& mission);
}  // namespace altiplan::host
