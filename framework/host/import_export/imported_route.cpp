// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/imported_route.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "altiplan/error.hpp"
#include "altiplan/kit/formats/input_file.hpp"
#include "host/config/mission_key.hpp"
#include "host/import_export/route_csv.hpp"
#include "host/result/stored_result.hpp"

namespace altiplan::host {
namespace {

using kit::AltitudeFrame;
using kit::MissionItem;
using kit::MissionPoint;

bool is_csv(const std::string& file) { return std::filesystem::path(file).extension() == ".csv"; }

const char* reference_of(AltitudeFrame frame) {
  return frame == AltitudeFrame::sea      ? "above sea level"
         : frame == AltitudeFrame::ground ? "above ground"
                                          : "relative to home";
}

void undo_rounding(Route& route, const Vec3& start) {
  if ((route.front() - start).norm() <= kRoundingReach) {
    Polyline points = route.waypoints();
    points.front() = start;
    route = std::move(points);
  }
}

void note_frames(const std::vector<MissionItem>& items, std::vector<std::string>& notes) {
  for (const auto frame : {AltitudeFrame::sea, AltitudeFrame::ground, AltitudeFrame::home}) {
    const auto count = std::count_if(items.begin(), items.end(),
                                     [&](const MissionItem& i) { return i.at.frame == frame; });
    if (count > 0) {
      notes.push_back(std::to_string(count) + " points with altitudes " + reference_of(frame));
    }
  }
}
}  // namespace

Vec3 to_local(const MissionPoint& point, const std::optional<MissionPoint>& home,
              const World& world) {
  if (!world.frame().has_position()) {
    throw Error(
        "longitude and latitude need a georeferenced world: add a georeferenced layer, or "
        "frame: {origin_lonlat: …}");
  }
  const auto [x, y] = world.frame().to_local(point.lon, point.lat);
  switch (point.frame) {
    case AltitudeFrame::sea:
      return {x, y, point.altitude_m};
    case AltitudeFrame::ground: {
      const std::optional<double> ground = world.ground(x, y);
      if (!ground) {
        throw Error("its altitude is above ground, and the world has no ground there");
      }
      return {x, y, *ground + point.altitude_m};
    }
    case AltitudeFrame::home:
      break;
  }
  if (!home) {
    throw Error("its altitude is relative to home, and the file has no home position");
  }
  return {x, y, home->altitude_m + point.altitude_m};
}

ImportedRoute route_in(const kit::MissionFile& mission, const World& world, const Vec3& start,
                       const std::string& file) {
  ImportedRoute result;
  result.notes = mission.notes;
  try {
    const std::vector<MissionItem> items = route_items(mission);
    if (items.size() < mission.items.size()) {
      result.notes.emplace_back(
          "the landing straight below the last point is not part of the route");
    }
    for (const MissionItem& item : items) {
      try {
        result.route.push_back(to_local(item.at, mission.home, world));
      } catch (const Error& error) {
        throw Error(item.place + ": " + error.what());
      }
    }
    note_frames(items, result.notes);
  } catch (const Error& error) {
    throw Error(file + ": " + error.what());
  }
  undo_rounding(result.route, start);
  return result;
}

ImportedRoute read_imported_route(const std::string& file, const std::string& text,
                                  const World& world, const Vec3& start) {
  if (!is_csv(file)) {
    return route_in(kit::read_mission(file, text), world, start, file);
  }
  ImportedRoute result;
  result.route = read_route_csv(file, text);
  expect_reachable(result.route.waypoints(), file);
  undo_rounding(result.route, start);
  return result;
}

ImportedRoute read_imported_route(const std::string& file, const Mission& mission) {
  const Vec3& start = mission.request.start.position;
  const World& world = mission.truth;
  if (is_csv(file)) {
    return read_imported_route(file, kit::read_file(file), world, start);
  }
  const std::filesystem::path ending = std::filesystem::path(file).extension();
  if (kit::is_mission_file(file) || ending == ".gpx" || ending == ".geojson" ||
      ending == ".mission") {
    return route_in(kit::read_mission(file), world, start, file);
  }
  const std::string expected =
      "a route as a list of [x, y, z] in metres, or a mission whose name ends in .plan, "
      ".waypoints, "
      ".kml, .gpx or .geojson";
  const Json json = read_json(file, expected);
  if (json.is_object() && !json.contains("route")) {
    throw Error(file + ": expected " + expected);
  }
  return {route_of(json, file), {}};
}
}  // namespace altiplan::host
