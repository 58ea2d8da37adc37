// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check_plan.hpp"
#include "commands.hpp"

namespace altiplan::cli {

/// How a mission's file is to be judged, as options say it.
struct MissionOptions {
  PlanCheck plan;
  std::optional<std::string> autopilot;
  std::optional<std::string> vehicle;
};

/// Adds --terrain, which is returned, and what goes with it: the world, and who flies.
Option* add_mission_options(App& command, MissionOptions& mission);

/// --basemap FILE, of pages.
Option* add_basemap(App& command, std::optional<std::string>& file);

/// --permission [ZONE] and --buffer METRES, of zones.
Option* add_permission(App& command, std::vector<std::string>& permitted);
Option* add_buffer(App& command, double& buffer_m);
/// Throws UsageError for a permission that opens no zone of the files.
void expect_permissions(const std::vector<std::string>& permitted,
                        const std::vector<std::string>& files);

/// The mission in `file`, with these options; throws UsageError where they contradict each other.
PlanCheck checked_plan(const MissionOptions& mission, const std::string& file);

/// True if `file`, of a command that takes results too, is a mission. Throws UsageError for one
/// without --terrain.
bool is_mission(const MissionOptions& mission, const std::string& file);
}  // namespace altiplan::cli
