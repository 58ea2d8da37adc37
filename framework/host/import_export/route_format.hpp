// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/import_export/mission_text.hpp"
#include "host/import_export/plan.hpp"
#include "host/import_export/route_csv.hpp"

namespace altiplan::host {

/// A format of files that hold routes: how it is written and read, and what it can hold.
struct RouteFormat {
  enum class Zones { none, fence, solids };

  const char* name = "";                         ///< of --to
  const char* extension = "";                    ///< with its dot
  const char* description = "";                  ///< for people
  std::vector<formats::AltitudeFrame> frames{};  ///< of its heights, the default first
  Zones zones = Zones::none;
  bool is_copters = false;  ///< those that fly it are copters
  /// The file's content. What it cannot hold is left out.
  std::string (*write)(const MissionText&) = nullptr;
  /// The same of a vehicle's plan; null of a format without commands, such as take-offs.
  std::string (*write_plan)(const Plan&) = nullptr;
  /// Throws Error, which begins with the file's name, for damaged content. Null of a format that
  /// holds the route in metres of the world's frame.
  formats::MissionFile (*read)(const std::string& file, const std::string& text) = nullptr;
  LocalRoute (*read_local)(const std::string& file, const std::string& text) = nullptr;
  /// True of content in this format, none where the file's name tells.
  bool (*recognises)(std::string_view text) = nullptr;
  /// What its programs make of the route otherwise than it was judged; none: nothing is known.
  std::vector<std::string> (*notes)(const MissionText&) = nullptr;

  bool has_commands() const { return write_plan != nullptr; }
  /// True of a format that needs no georeference.
  bool is_local() const { return read_local != nullptr; }
};

/// The table of all formats: --to, the documentation and the editor's list are made from it.
const std::vector<RouteFormat>& route_formats();
/// The format of that name. Throws Error if there is none.
const RouteFormat& format_named(std::string_view name);
/// The format with the file's extension, of several the more general one; none if there is none.
const RouteFormat* format_by_extension(const std::string& file);
/// All names, and the same as "qgc-plan, waypoints or csv".
std::vector<std::string> format_words();
std::string format_names();
/// All extensions, each once.
std::vector<std::string> format_extensions();

/// A mission in any of the formats but the local ones. Throws Error for others.
formats::MissionFile read_mission_file(const std::string& file, const std::string& text);
formats::MissionFile read_mission_file(const std::string& file);
/// The route of content in a local format, none for other content.
std::optional<LocalRoute> read_local_route(const std::string& file, const std::string& text);
/// True if the file's extension is one of missions alone.
bool is_mission_name(const std::string& file);
/// Likewise, or if its content tells, as that of Litchi's tables does.
bool holds_mission(const std::string& file, std::string_view text);
}  // namespace altiplan::host
