// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "altiplan/geometry.hpp"
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

int command_of(const MissionItem& item) {
  using Until = kit::MissionCircle::Until;
  switch (item.kind) {
    case MissionItem::Kind::takeoff:
      return 22;
    case MissionItem::Kind::land:
      return 21;
    case MissionItem::Kind::loiter:
      return !item.circle || item.circle->until == Until::forever ? 17
             : item.circle->until == Until::turns                 ? 18
                                                                  : 31;
    case MissionItem::Kind::waypoint:
      break;
  }
  return 16;
}

/// The radius that MAVLink gives, positive clockwise, rounded up: a smaller one would be too tight.
double radius_of(const kit::MissionCircle& circle, int decimals) {
  const double nearest = rounded(circle.radius_m, decimals);
  const bool is_tighter = nearest < circle.radius_m - kLengthTolerance / 10;
  const double radius = is_tighter ? nearest + std::pow(10, -decimals) : nearest;
  return -circle.sense * rounded(radius, decimals);
}

/// The first four parameters of MAVLink; NaN: left to the autopilot. Circles
/// are left when heading for the next item, toward it from that place ("xtrack" 1).
std::array<double, 4> params_of(const MissionItem& item, int decimals) {
  using Until = kit::MissionCircle::Until;
  const double unset = std::nan("");
  if (!item.circle) {
    return {0, 0, 0, unset};  // hold time, acceptance radius, pass-by distance, heading
  }
  const double radius = radius_of(*item.circle, decimals);
  switch (item.circle->until) {
    case Until::turns:
      return {item.circle->turns, 1, radius, 1};
    case Until::altitude:
      return {1, radius, 0, 1};
    case Until::forever:
      break;
  }
  return {0, 0, radius, unset};
}

Json item_json(const MissionItem& item, std::size_t number, const Decimals& decimals) {
  const FrameNumbers frame = numbers_of(item.at.frame);
  const double altitude = rounded(item.at.altitude_m, decimals.metres);
  Json params = Json::array();
  for (const double value : params_of(item, decimals.metres)) {
    params.push_back(std::isnan(value) ? Json() : Json(rounded(value, decimals.metres)));
  }
  params.push_back(rounded(item.at.lat, decimals.degrees));
  params.push_back(rounded(item.at.lon, decimals.degrees));
  params.push_back(altitude);
  return {{"type", "SimpleItem"},
          {"autoContinue", true},
          {"command", command_of(item)},
          {"doJumpId", number},
          {"frame", frame.mav_frame},
          {"AMSLAltAboveTerrain", nullptr},
          {"Altitude", altitude},
          {"AltitudeMode", frame.altitude_mode},
          {"params", params}};
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
  constexpr int kArduPilot = 3;              // of MAV_AUTOPILOT: supports all three altitude frames
  const int vehicle = text.is_wing ? 1 : 2;  // of MAV_TYPE: fixed wing, quadrotor
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
                    {"vehicleType", vehicle},
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
  const auto add = [&](const MissionItem& item) {
    result += std::to_string(number) + (number == 0 ? "\t1\t" : "\t0\t") +
              std::to_string(numbers_of(item.at.frame).mav_frame) + "\t" +
              std::to_string(command_of(item));
    for (const double value : params_of(item, decimals.metres)) {
      result += "\t" + rounded_text(std::isnan(value) ? 0 : value, decimals.metres);
    }
    result += "\t" + rounded_text(item.at.lat, decimals.degrees) + "\t" +
              rounded_text(item.at.lon, decimals.degrees) + "\t" +
              rounded_text(item.at.altitude_m, decimals.metres) + "\t1\n";
    ++number;
  };
  MissionItem home;
  home.at = text.mission.home.value();
  add(home);
  for (const MissionItem& item : text.mission.items) {
    add(item);
  }
  return result;
}
}  // namespace altiplan::host
