// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/formats/airspace.hpp"
#include "altiplan/formats/mission_file.hpp"
#include "host/plugins/registry.hpp"

namespace altiplan::host {

/// What a file of the world, or a mission, holds.
struct FileInfo {
  std::string kind;  ///< "elevation model"
  std::vector<std::string> facts;
  std::vector<std::string> scenario;  ///< lines of YAML that a scenario would take from it
};

/// Throws Error naming the file if no reader knows it, or its own reader refuses it. `crs` is for
/// an elevation model that names none.
FileInfo info_of(const std::filesystem::path& file, const std::string& crs, Registry& registry);

/// Limits by datum, hours, and extent of published airspace.
std::vector<std::string> facts_of(const formats::Airspace& airspace);
/// Items, heights, home and fence of a mission.
FileInfo info_of(const formats::MissionFile& mission, const std::string& file);
}  // namespace altiplan::host
