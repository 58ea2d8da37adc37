// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "host/base/json.hpp"
#include "host/import_export/format_functions.hpp"
#include "host/import_export/plan.hpp"

namespace altiplan::host {
namespace {

using SortedJson = nlohmann::json;  // keys in alphabetical order, as QGroundControl writes them

/// QGroundControl's number for the altitude frame.
int altitude_mode(int mav_frame) {
  constexpr int kHome = 1;
  constexpr int kSea = 2;
  constexpr int kGround = 4;
  return mav_frame == 3 || mav_frame == 6     ? kHome
         : mav_frame == 10 || mav_frame == 11 ? kGround
                                              : kSea;
}

SortedJson item_json(const PlanItem& item, std::size_t number) {
  SortedJson params = SortedJson::array();
  for (const double value : item.params) {
    params.push_back(std::isnan(value) ? SortedJson() : SortedJson(value));
  }
  SortedJson json{{"type", "SimpleItem"},    {"autoContinue", item.continues},
                  {"command", item.command}, {"doJumpId", number},
                  {"frame", item.frame},     {"params", params}};
  constexpr int kWithoutPlace = 2;  // MAV_FRAME_MISSION
  if (item.frame != kWithoutPlace) {
    json["AMSLAltAboveTerrain"] = nullptr;
    json["Altitude"] = item.params[6];
    json["AltitudeMode"] = altitude_mode(item.frame);
  }
  return json;
}

SortedJson lat_lon(const PlanItem& item) { return {item.params[4], item.params[5]}; }

/// `name` is our own key, which ground stations ignore.
SortedJson named(SortedJson zone, const std::string& name) {
  if (!name.empty()) {
    zone["name"] = name;
  }
  return zone;
}

SortedJson polygon_json(const std::vector<PlanItem>& fence, std::size_t first,
                        std::size_t corners) {
  SortedJson outline = SortedJson::array();
  for (std::size_t n = first; n < first + corners; ++n) {
    outline.push_back(lat_lon(fence[n]));
  }
  return named({{"inclusion", fence[first].command == Command::kFencePolygonIn},
                {"polygon", outline},
                {"version", 1}},
               fence[first].name);
}

SortedJson fence_json(const std::vector<PlanItem>& fence) {
  SortedJson polygons = SortedJson::array();
  SortedJson circles = SortedJson::array();
  for (std::size_t n = 0; n < fence.size();) {
    const PlanItem& item = fence[n];
    const bool keep_in = item.command == Command::kFenceCircleIn;
    if (keep_in || item.command == Command::kFenceCircleOut) {
      circles.push_back(named({{"circle", {{"center", lat_lon(item)}, {"radius", item.params[0]}}},
                               {"inclusion", keep_in},
                               {"version", 1}},
                              item.name));
      ++n;
    } else if (item.command == Command::kFencePolygonIn ||
               item.command == Command::kFencePolygonOut) {
      const double left = double(fence.size() - n);
      const auto corners = static_cast<std::size_t>(std::clamp(item.params[0], 1.0, left));
      polygons.push_back(polygon_json(fence, n, corners));
      n += corners;
    } else {
      ++n;
    }
  }
  return {{"circles", circles}, {"polygons", polygons}, {"version", 2}};
}

/// Ground stations need a home: without one it is below the first waypoint, at sea level.
formats::MissionPoint home_of(const Plan& plan) {
  if (plan.home || plan.items.empty()) {
    return plan.home.value_or(formats::MissionPoint());
  }
  const PlanItem& first = plan.items.front();
  return {first.params[5], first.params[4], 0};
}

/// QGroundControl has rally points above home alone.
SortedJson rally_json(const Plan& plan) {
  constexpr int kAboveSea = 0;
  constexpr int kAboveHome = 3;
  SortedJson points = SortedJson::array();
  for (const PlanItem& item : plan.rally) {
    if (item.frame != kAboveSea && item.frame != kAboveHome) {
      throw Error("rally point " + std::to_string(points.size() + 1) +
                  " is above the ground (frame " + std::to_string(item.frame) +
                  "), and a .plan has rally points above home alone");
    }
    const double height =
        item.frame == kAboveHome
            ? item.params[6]
            : rounded(item.params[6] - home_of(plan).altitude_m, plan.decimals.metres);
    points.push_back({item.params[4], item.params[5], height});
  }
  return {{"points", points}, {"version", 2}};
}

/// A line of QGC WPL 110: twelve columns.
std::string row(const PlanItem& item, std::size_t number, bool is_current,
                const Decimals& decimals) {
  std::string line = std::to_string(number) + (is_current ? "\t1\t" : "\t0\t") +
                     std::to_string(item.frame) + "\t" + std::to_string(item.command);
  for (std::size_t n = 0; n < item.params.size(); ++n) {
    const double value = std::isnan(item.params[n]) ? 0 : item.params[n];
    const bool is_degrees = n == 4 || n == 5;
    line += "\t" + rounded_text(value, is_degrees ? decimals.degrees : decimals.metres);
  }
  return line + (item.continues ? "\t1\n" : "\t0\n");
}
}  // namespace

std::string plan_text(const Plan& plan) {
  const Decimals& decimals = plan.decimals;
  const formats::MissionPoint home = home_of(plan);
  SortedJson items = SortedJson::array();
  for (const PlanItem& item : plan.items) {
    items.push_back(item_json(item, items.size() + 1));
  }
  const int frame = plan.items.empty() ? 0 : plan.items.front().frame;
  const SortedJson json{
      {"fileType", "Plan"},
      {"version", 1},
      {"groundStation", "QGroundControl"},
      {"mission",
       {{"version", 2},
        {"firmwareType", plan.autopilot},
        {"vehicleType", plan.vehicle},
        {"cruiseSpeed", plan.speed_mps},
        {"hoverSpeed", plan.speed_mps},
        {"globalPlanAltitudeMode", altitude_mode(frame)},
        {"plannedHomePosition",
         {rounded(home.lat, decimals.degrees), rounded(home.lon, decimals.degrees),
          rounded(home.altitude_m, decimals.metres)}},
        {"items", items}}},
      {"geoFence", fence_json(plan.fence)},
      {"rallyPoints", rally_json(plan)}};
  return json.dump(4, ' ', false, SortedJson::error_handler_t::replace) + "\n";
}

std::string waypoints_text(const Plan& plan) {
  const formats::MissionPoint home = home_of(plan);
  PlanItem first;
  first.params[4] = home.lat;
  first.params[5] = home.lon;
  first.params[6] = home.altitude_m;
  std::string result = "QGC WPL 110\n" + row(first, 0, true, plan.decimals);
  for (std::size_t n = 0; n < plan.items.size(); ++n) {
    result += row(plan.items[n], n + 1, false, plan.decimals);
  }
  return result;
}

std::string fence_text(const Plan& plan) {
  std::string result = "QGC WPL 110\n";
  for (std::size_t n = 0; n < plan.fence.size(); ++n) {
    result += row(plan.fence[n], n, false, plan.decimals);
  }
  return result;
}

std::string qgc_plan_text(const MissionText& text) { return plan_text(plan_of(text)); }
std::string waypoints_text(const MissionText& text) { return waypoints_text(plan_of(text)); }
}  // namespace altiplan::host
