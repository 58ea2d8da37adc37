// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "altiplan/kit/formats/mission_file.hpp"
#include "altiplan/value.hpp"

namespace altiplan::host {

/// Where a scenario has the key `mission`, adds the start, via points and goal of that file to the
/// tree, as far as the scenario does not write them itself: what is read later cannot tell the
/// difference, and says where each came from. The file is added to `files`. Returns what of it was
/// left out, a line each. Throws ConfigError at the key.
std::vector<std::string> add_mission(Value& scenario, std::vector<std::filesystem::path>& files);

/// The items as the points of a route: without a landing straight below the last of them. Throws
/// Error where the file has none, or they are no route.
std::vector<kit::MissionItem> route_items(const kit::MissionFile& mission);
}  // namespace altiplan::host
