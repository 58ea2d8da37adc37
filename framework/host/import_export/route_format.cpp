// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/route_format.hpp"

#include <algorithm>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "host/base/zip.hpp"
#include "host/import_export/format_functions.hpp"
#include "host/import_export/route_csv.hpp"

namespace altiplan::host {
namespace {

using Zones = RouteFormat::Zones;
constexpr auto kSea = formats::AltitudeFrame::sea;
constexpr auto kGround = formats::AltitudeFrame::ground;
constexpr auto kHome = formats::AltitudeFrame::home;

std::vector<RouteFormat> table() {
  return {{.name = "qgc-plan",
           .extension = ".plan",
           .description = "QGroundControl's `.plan` (version 1, mission 2, fence 2)",
           .frames = {kSea, kGround, kHome},
           .zones = Zones::fence,
           .write = qgc_plan_text,
           .write_plan = plan_text,
           .read = formats::read_mission},
          {.name = "waypoints",
           .extension = ".waypoints",
           .description = "`QGC WPL 110`: QGroundControl, Mission Planner, MAVProxy",
           .frames = {kSea, kGround, kHome},
           .write = waypoints_text,
           .write_plan = waypoints_text,
           .read = formats::read_mission},
          {.name = "wpml",
           .extension = ".kmz",
           .description = "DJI's WPML 1.0.2 in a KMZ: DJI Pilot 2, FlightHub 2",
           .frames = {kHome},
           .is_copters = true,
           .write = wpml_text,
           .read = read_kmz,
           .recognises = is_zip,
           .notes = wpml_notes},
          {.name = "litchi",
           .extension = ".csv",
           .description = "Litchi's CSV, in metres",
           .frames = {kHome},
           .is_copters = true,
           .write = litchi_text,
           .read = read_litchi,
           .recognises = is_litchi,
           .notes = litchi_notes},
          {.name = "kml",
           .extension = ".kml",
           .description = "KML 2.2: one LineString",
           .frames = {kSea, kGround},
           .zones = Zones::solids,
           .write = kml_text,
           .read = formats::read_mission},
          {.name = "kmz",
           .extension = ".kmz",
           .description = "the same in an archive, with a mark for each waypoint and its time",
           .frames = {kSea, kGround},
           .zones = Zones::solids,
           .write = kmz_text,
           .read = read_kmz,
           .recognises = is_zip},
          {.name = "geojson",
           .extension = ".geojson",
           .description = "RFC 7946: one LineString with three numbers per point",
           .frames = {kSea, kGround, kHome},
           .zones = Zones::solids,
           .write = geojson_text,
           .read = formats::read_mission},
          {.name = "gpx",
           .extension = ".gpx",
           .description = "GPX 1.1: one route",
           .frames = {kSea},
           .write = gpx_text,
           .read = formats::read_mission},
          {.name = "czml",
           .extension = ".czml",
           .description = "CZML 1.0 for Cesium: a flight in time, heights above the ellipsoid",
           .frames = {kSea},
           .write = czml_text,
           .read = read_czml,
           .recognises = is_czml},
          {.name = "mcap",
           .extension = ".mcap",
           .description = "`nav_msgs/Path` of ROS 2 in MCAP, in metres of the world's frame",
           .frames = {kSea},
           .write = mcap_text,
           .read_local = read_mcap,
           .recognises = is_mcap},
          {.name = "csv",
           .extension = ".csv",
           .description = "a table; works in a world without georeference",
           .frames = {kSea, kGround, kHome},
           .write = csv_text,
           .read_local = read_route_csv}};
}

/// The format that the content tells, none if only the file's name can.
const RouteFormat* recognised(std::string_view text) {
  for (const RouteFormat& format : route_formats()) {
    if (format.recognises != nullptr && format.recognises(text)) {
      return &format;
    }
  }
  return nullptr;
}
}  // namespace

const std::vector<RouteFormat>& route_formats() {
  static const std::vector<RouteFormat> kAll = table();
  return kAll;
}

const RouteFormat& format_named(std::string_view name) {
  for (const RouteFormat& format : route_formats()) {
    if (format.name == name) {
      return format;
    }
  }
  throw Error("expected the format " + format_names() + ", found '" + std::string(name) + "'");
}

const RouteFormat* format_by_extension(const std::string& file) {
  const std::string extension = formats::ending_of(file);
  // Of those that share one, the last is the general one.
  const auto& all = route_formats();
  const auto found = std::find_if(all.rbegin(), all.rend(), [&](const RouteFormat& format) {
    return format.extension == extension;
  });
  return found == all.rend() ? nullptr : &*found;
}

std::vector<std::string> format_words() {
  std::vector<std::string> words;
  for (const RouteFormat& format : route_formats()) {
    words.emplace_back(format.name);
  }
  return words;
}

std::string format_names() {
  std::string names;
  const std::vector<std::string> words = format_words();
  for (const std::string& word : words) {
    names += (names.empty() ? "" : word == words.back() ? " or " : ", ") + word;
  }
  return names;
}

std::vector<std::string> format_extensions() {
  std::vector<std::string> all;
  for (const RouteFormat& format : route_formats()) {
    if (std::find(all.begin(), all.end(), format.extension) == all.end()) {
      all.emplace_back(format.extension);
    }
  }
  return all;
}

formats::MissionFile read_mission_file(const std::string& file, const std::string& text) {
  const RouteFormat* format = recognised(text);
  return format != nullptr && !format->is_local() ? format->read(file, text)
                                                  : formats::read_mission(file, text);
}

formats::MissionFile read_mission_file(const std::string& file) {
  return read_mission_file(file, formats::read_file(file));
}

std::optional<LocalRoute> read_local_route(const std::string& file, const std::string& text) {
  const RouteFormat* format = recognised(text);
  if (format == nullptr) {
    format = format_by_extension(file);
  }
  return format != nullptr && format->is_local() ? std::optional(format->read_local(file, text))
                                                 : std::nullopt;
}

bool is_mission_name(const std::string& file) {
  const RouteFormat* format = format_by_extension(file);
  return (format != nullptr && !format->is_local()) || formats::ending_of(file) == ".txt";
}

bool holds_mission(const std::string& file, std::string_view text) {
  const RouteFormat* format = recognised(text);
  return (format != nullptr && !format->is_local()) || is_mission_name(file);
}
}  // namespace altiplan::host
