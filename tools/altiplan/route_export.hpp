// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "commands.hpp"
#include "host/import_export/export.hpp"
#include "host/result/stored_result.hpp"

namespace altiplan::cli {

/// What `export` and `upload` have in common: a result's route as the items of a mission.
struct RouteExport {
  std::string result;
  std::string altitude = "sea";
  std::string arcs = "points";
  bool flight = false;
  host::ExportOptions options;
  host::Overrides overrides;
};

/// Adds the result and the options of its items.
void add_route_export(App& command, RouteExport& route, bool takes_missions);
/// Throws UsageError for options of a result's items, which a mission has of its own.
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
/// Judges and writes the route, and reports the verdict on stderr. None: it would not be valid as
/// written.
std::optional<host::Exported> exported(const LoadedRoute& loaded, const RouteExport& route);
/// Both.
std::optional<host::Exported> exported(const RouteExport& route,
                                       const std::optional<std::string>& out);
}  // namespace altiplan::cli
