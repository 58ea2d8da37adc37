// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "host/import_export/mission_text.hpp"

namespace altiplan::host {
namespace {

using Json = nlohmann::json;  // keys in alphabetical order, as QGroundControl writes them
using kit::AltitudeFrame;
using kit::MissionItem;
using kit::MissionPoint;
using kit::MissionZone;

/// MAV_FRAME, and QGroundControl's number for it.
struct FrameNumbers {
  int mav_frame;
  int altitude_mode;
};

FrameNumbers numbers_of(AltitudeFrame frame) {
  switch (frame) {
    case AltitudeFrame::sea:
      return {0, 2};
    case AltitudeFrame::home:
      return {3, 1};
    case AltitudeFrame::ground:
      break;
  }
  return {10, 4};
}

int command_of(MissionItem::Kind kind) {
  switch (kind) {
    case MissionItem::Kind::takeoff:
      return 22;
    case MissionItem::Kind::land:
      return 21;
    case MissionItem::Kind::loiter:
      return 17;
    case MissionItem::Kind::waypoint:
      break;
  }
  return 16;
}

Json item_json(const MissionItem& item, std::size_t number, const Decimals& decimals) {
  const FrameNumbers frame = numbers_of(item.at.frame);
  const double altitude = rounded(item.at.altitude_m, decimals.metres);
  return {{"type", "SimpleItem"},
          {"autoContinue", true},
          {"command", command_of(item.kind)},
          {"doJumpId", number},
          {"frame", frame.mav_frame},
          {"AMSLAltAboveTerrain", nullptr},
          {"Altitude", altitude},
          {"AltitudeMode", frame.altitude_mode},
          // Hold time, acceptance radius, pass-by distance, heading: left to the autopilot.
          {"params",
           {0, 0, 0, nullptr, rounded(item.at.lat, decimals.degrees),
            rounded(item.at.lon, decimals.degrees), altitude}}};
}

Json corners_json(const kit::Ring& ring, int decimals) {
  Json corners = Json::array();
  for (const kit::Point2& p : ring) {
    corners.push_back({rounded(p[1], decimals), rounded(p[0], decimals)});
  }
  return corners;
}

/// Holes of a keep-in zone become keep-out zones; those of a keep-out zone cannot be written.
Json fence_json(const std::vector<MissionZone>& zones, const Decimals& decimals) {
  Json polygons = Json::array();
  Json circles = Json::array();
  const auto add = [&](const kit::Ring& ring, bool keep_in) {
    polygons.push_back({{"inclusion", keep_in},
                        {"polygon", corners_json(ring, decimals.degrees)},
                        {"version", 1}});
  };
  for (const MissionZone& zone : zones) {
    if (zone.polygon.outline.empty()) {
      circles.push_back({{"circle",
                          {{"center",
                            {rounded(zone.centre[1], decimals.degrees),
                             rounded(zone.centre[0], decimals.degrees)}},
                           {"radius", rounded(zone.radius_m, decimals.metres)}}},
                         {"inclusion", zone.keep_in},
                         {"version", 1}});
      continue;
    }
    add(zone.polygon.outline, zone.keep_in);
    if (zone.keep_in) {
      for (const kit::Ring& hole : zone.polygon.holes) {
        add(hole, false);
      }
    }
  }
  return {{"circles", circles}, {"polygons", polygons}, {"version", 2}};
}
}  // namespace

std::string qgc_plan_text(const MissionText& text) {
  constexpr int kArduPilot = 3;  // of MAV_AUTOPILOT: supports all three altitude frames
  constexpr int kMultirotor = 2;
  const Decimals& decimals = text.decimals;
  const MissionPoint& home = text.mission.home.value();
  Json items = Json::array();
  for (const MissionItem& item : text.mission.items) {
    items.push_back(item_json(item, items.size() + 1, decimals));
  }
  const AltitudeFrame frame = text.mission.items.front().at.frame;
  const Json plan{{"fileType", "Plan"},
                  {"version", 1},
                  {"groundStation", "QGroundControl"},
                  {"mission",
                   {{"version", 2},
                    {"firmwareType", kArduPilot},
                    {"vehicleType", kMultirotor},
                    {"cruiseSpeed", text.speed_mps},
                    {"hoverSpeed", text.speed_mps},
                    {"globalPlanAltitudeMode", numbers_of(frame).altitude_mode},
                    {"plannedHomePosition",
                     {rounded(home.lat, decimals.degrees), rounded(home.lon, decimals.degrees),
                      rounded(home.altitude_m, decimals.metres)}},
                    {"items", items}}},
                  {"geoFence", fence_json(text.mission.zones, decimals)},
                  {"rallyPoints", {{"points", Json::array()}, {"version", 2}}}};
  return plan.dump(4) + "\n";
}

std::string waypoints_text(const MissionText& text) {
  const Decimals& decimals = text.decimals;
  std::string result = "QGC WPL 110\n";
  std::size_t number = 0;
  const auto add = [&](const MissionPoint& at, int command) {
    result += std::to_string(number) + (number == 0 ? "\t1\t" : "\t0\t") +
              std::to_string(numbers_of(at.frame).mav_frame) + "\t" + std::to_string(command) +
              "\t0\t0\t0\t0\t" + rounded_text(at.lat, decimals.degrees) + "\t" +
              rounded_text(at.lon, decimals.degrees) + "\t" +
              rounded_text(at.altitude_m, decimals.metres) + "\t1\n";
    ++number;
  };
  add(text.mission.home.value(), command_of(MissionItem::Kind::waypoint));
  for (const MissionItem& item : text.mission.items) {
    add(item.at, command_of(item.kind));
  }
  return result;
}
}  // namespace altiplan::host
