// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check_plan.hpp"
#include "commands.hpp"
#include "host/import_export/export.hpp"
#include "host/result/stored_result.hpp"

namespace altiplan::cli {

/// What `export` and `upload` have in common: a result's route as the items of a mission.
struct RouteExport {
  std::string result;
  std::optional<std::string> altitude;
  std::string arcs = "points";
  bool flight = false;
  host::ExportOptions options;
  host::Overrides overrides;
};

/// Adds the result and the options of its items.
void add_route_export(App& command, RouteExport& route, bool takes_missions);
/// Throws UsageError for options of a result's items, which a mission with commands has of its own.
void expect_no_item_options(const RouteExport& route, bool has_fence);
/// Ends the options; throws UsageError where they cannot be combined.
void finish_options(RouteExport& route);

/// A result as read, and its world.
struct LoadedRoute {
  host::StoredResult stored;
  host::Config config;
  host::Mission mission;
  host::ExportSource source;
};
/// None, which is reported: there is no route. `out`, if it is a file, must not be one of those
/// that are read.
std::optional<LoadedRoute> loaded(const RouteExport& route, const std::optional<std::string>& out);
/// Reports on stderr.
void say(const std::vector<std::string>& messages);
/// Judges and writes the route, and reports the verdict on stderr. None: it would not be valid as
/// written.
std::optional<host::Exported> exported(const LoadedRoute& loaded, const RouteExport& route);
/// Both.
std::optional<host::Exported> exported(const RouteExport& route,
                                       const std::optional<std::string>& out);
/// The route as the fewest items that pass as they are flown by the autopilot that the options
/// name, and the scenario's vehicle. None, which is reported: none pass, or not so few.
std::optional<host::Plan> fewest_plan(const LoadedRoute& loaded, const RouteExport& route,
                                      const PlanCheck& options);
/// The drawn line of a mission that passes, written as a result's route is, without times; reports
/// the verdict on stderr.
host::Exported exported_route(const JudgedPlan& judged, const RouteExport& route);
/// That as a plan of commands, which is judged as it is flown. None, which is reported: it does not
/// pass.
std::optional<host::Plan> plan_of_line(const JudgedPlan& judged, const RouteExport& route);
/// Reports that the mission does not pass, and why.
void tell_findings(const std::string& file, const JudgedPlan& judged);
}  // namespace altiplan::cli
