// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>

#include "json_node.hpp"
#include "mission_parts.hpp"

namespace altiplan::formats {
namespace {

using Json = nlohmann::json;
using Node = JsonNode;

/// Latitude, longitude and altitude are the last three params, or a `coordinate` beside four params
/// in files from before 2017.
void read_simple_item(const Node& item, CommandList& commands) {
  const Node params = item.at("params");
  const bool old_form = item.has("coordinate");
  const std::size_t expected = old_form ? 4 : 7;
  if (params.size() != expected) {
    params.wrong("a list of " + std::to_string(expected) + " numbers");
  }
  const Node places = old_form ? item.at("coordinate") : params;
  const std::size_t first = old_form ? 0 : 4;
  if (places.size() != first + 3) {
    places.wrong("[latitude, longitude, altitude]");
  }
  MissionCommand command;
  for (std::size_t n = 0; n < expected; ++n) {
    const double value = params.at(n).number_or_nan();
    if (n < command.params.size()) {
      command.params[n] = value;
    }
  }
  command.auto_continue = item.at("autoContinue").boolean();
  command.number = item.at("command").whole(65535);
  command.frame = item.at("frame").whole(21);
  command.lat = places.at(first).number_or_nan();
  command.lon = places.at(first + 1).number_or_nan();
  command.altitude_m = places.at(first + 2).number_or_nan();
  command.place = item.place();
  command.item = item.at("doJumpId").whole(1'000'000);
  item.told([&] { commands.add(command); });
}

/// A survey contains the commands that the ground station made from it; a structure scan does not.
void read_complex_item(const Node& item, CommandList& commands) {
  item.at("complexItemType").text();
  if (!item.has("TransectStyleComplexItem") || !item.at("TransectStyleComplexItem").has("Items")) {
    commands.skip_complex(item.place());
    return;
  }
  const Node items = item.at("TransectStyleComplexItem").at("Items");
  if (items.size() == 0) {  // the ground station has not made them yet
    commands.skip_complex(item.place());
    return;
  }
  for (std::size_t n = 0; n < items.size(); ++n) {
    read_simple_item(items.at(n), commands);
  }
  commands.take_complex(items.size());
}

/// How QGroundControl shows another height than the autopilot gets with an item that was read; ""
/// where it does not.
std::string shown_otherwise(const Node& item) {
  constexpr double kSame = 0.1;  // metres
  constexpr int kAboveTerrain = 3;
  const auto number = [&](const char* key) {
    return item.has(key) && item.at(key).json().is_number() ? std::optional(item.at(key).number())
                                                            : std::nullopt;
  };
  const int mode = int(number("AltitudeMode").value_or(0));
  const char* key = mode == kAboveTerrain ? "AMSLAltAboveTerrain" : "Altitude";
  const auto shown = number(key);
  const std::size_t last = item.at("params").size() - 1;
  if (shown && last == 6 &&
      !(std::abs(*shown - item.at("params").at(last).number_or_nan()) <= kSame)) {
    return std::string("its ") + key + " is " + short_text(*shown) + " m, but its params say " +
           short_text(item.at("params").at(last).json()) + " m, which is flown";
  }
  const int frame = item.at("frame").whole(21);
  const bool is_sea = frame == 0 || frame == 5;
  const bool is_home = frame == 3 || frame == 6;
  const bool is_ground = frame == 10 || frame == 11;
  if ((is_sea && (mode == 1 || mode == 4)) || (is_home && mode >= 2 && mode <= 4) ||
      (is_ground && mode >= 1 && mode <= 3)) {
    return "its AltitudeMode is " + std::to_string(mode) + ", but its frame is " +
           std::to_string(frame) + ", which is flown";
  }
  return "";
}

void read_items(const Node& items, MissionFile& mission) {
  CommandList commands(mission);
  std::string shown;
  std::size_t others = 0;
  for (std::size_t n = 0; n < items.size(); ++n) {
    const Node item = items.at(n);
    const std::string type = item.at("type").text();
    if (type == "SimpleItem") {
      read_simple_item(item, commands);
      if (const std::string how = shown_otherwise(item); !how.empty()) {
        others += shown.empty() ? 0 : 1;
        shown = shown.empty() ? "item " + std::to_string(item.at("doJumpId").whole(1'000'000)) +
                                    " is not flown as QGroundControl shows it: " + how
                              : shown;
      }
    } else if (type == "ComplexItem") {
      read_complex_item(item, commands);
    } else {
      item.at("type").wrong("SimpleItem or ComplexItem");
    }
  }
  commands.finish();
  if (!shown.empty()) {
    mission.notes.push_back(shown + (others > 0 ? "; " + std::to_string(others) + " more" : ""));
  }
}

Ring read_corners(const Node& corners) {
  Ring ring;
  for (std::size_t n = 0; n < corners.size(); ++n) {
    ring.push_back(corners.at(n).place_on_earth());
  }
  return ring;
}

/// `name` is our own key beside those of ground stations, which ignore it.
void add_zone(const Node& from, bool keep_in, ZoneVolume volume, MissionFile& mission) {
  from.told([&] { check_volume(volume); });
  const bool is_named = from.has("name") && from.at("name").json().is_string();
  Zone zone;
  zone.name = is_named ? from.at("name").text() : from.place();
  zone.restriction = keep_in ? Restriction::keep_in : Restriction::keep_out;
  zone.volumes.push_back(std::move(volume));
  mission.zones.push_back(std::move(zone));
}

void read_fence(const Node& fence, MissionFile& mission) {
  fence.at("version").expect_version(1, 2);
  if (fence.at("version").whole(2) == 1) {  // one polygon, keep-in
    const Node polygon = fence.at("polygon");
    if (polygon.size() > 0) {
      add_zone(polygon, true, {{read_corners(polygon), {}}, {}, {}}, mission);
    }
    return;
  }
  const Node polygons = fence.at("polygons");
  for (std::size_t n = 0; n < polygons.size(); ++n) {
    const Node polygon = polygons.at(n);
    polygon.at("version").expect_version(1, 1);
    const bool keep_in = polygon.at("inclusion").boolean();
    Ring outline = read_corners(polygon.at("polygon"));
    if (outline.size() < 3) {
      polygon.at("polygon").wrong("three corners or more");
    }
    add_zone(polygon, keep_in, {{std::move(outline), {}}, {}, {}}, mission);
  }
  const Node circles = fence.at("circles");
  for (std::size_t n = 0; n < circles.size(); ++n) {
    const Node circle = circles.at(n);
    circle.at("version").expect_version(1, 1);
    const bool keep_in = circle.at("inclusion").boolean();
    const Point2 centre = circle.at("circle").at("center").place_on_earth();
    add_zone(circle, keep_in, {{}, {}, {}, centre, circle.at("circle").at("radius").number()},
             mission);
  }
}

void read_rally_points(const Node& rally, MissionFile& mission) {
  rally.at("version").expect_version(1, 2);
  const Node points = rally.at("points");
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Node point = points.at(n);
    if (point.size() != 3) {
      point.wrong("[latitude, longitude, altitude]");
    }
    const Point2 at = point.place_on_earth();
    mission.rally.push_back({at[0], at[1], point.at(2).number(), AltitudeFrame::home});
    point.told([&] { expect_altitude(mission.rally.back().altitude_m); });
  }
}

/// Throws Error naming what a JSON file that is no plan may be instead.
void expect_plan(const Node& root, const Json& json) {
  if (!root.has("fileType")) {
    if (root.has("items") && root.has("groundStation")) {
      throw Error("this is a mission in the old format (.mission), expected a .plan");
    }
    throw Error("expected a plan (\"fileType\": \"Plan\"), found " + short_text(json));
  }
  if (root.at("fileType").text() != "Plan") {
    root.at("fileType").wrong("\"Plan\"");
  }
  root.at("groundStation").text();
  root.at("version").expect_version(1, 1);
}

MissionFile read_plan(const Node& root) {
  MissionFile mission;
  mission.format = MissionFile::Format::qgc_plan;
  const Node body = root.at("mission");
  body.at("version").expect_version(2, 2);
  mission.firmware = body.at("firmwareType").whole(255);
  mission.vehicle_type = body.at("vehicleType").whole(255);
  mission.cruise_mps = body.at("cruiseSpeed").number();
  body.at("hoverSpeed").number();
  const Node home = body.at("plannedHomePosition");
  if (home.size() != 3) {
    home.wrong("[latitude, longitude, altitude]");
  }
  const Point2 at = home.place_on_earth();
  const double altitude_m = home.at(2).number();
  home.told([&] { expect_altitude(altitude_m); });
  if (!is_nowhere(at[0], at[1])) {
    mission.home = {at[0], at[1], altitude_m, AltitudeFrame::sea};
  }
  read_items(body.at("items"), mission);
  read_fence(root.at("geoFence"), mission);
  read_rally_points(root.at("rallyPoints"), mission);
  return mission;
}

}  // namespace

MissionFile read_qgc_plan(const nlohmann::json& json) {
  const JsonNode root(json, "");
  expect_plan(root, json);
  return read_plan(root);
}
}  // namespace altiplan::formats
