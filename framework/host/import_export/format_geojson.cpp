// SPDX-License-Identifier: Apache-2.0
#include "host/base/json.hpp"
#include "host/import_export/format_functions.hpp"
#include "host/import_export/map_parts.hpp"

namespace altiplan::host {
namespace {

using OrderedJson = nlohmann::ordered_json;
using formats::AltitudeFrame;
using formats::MissionItem;
using formats::MissionPoint;
using formats::Zone;

OrderedJson ring_json(const formats::Ring& ring, int decimals) {
  OrderedJson corners = OrderedJson::array();
  for (std::size_t n = 0; n <= ring.size(); ++n) {
    const formats::Point2& p = ring[n % ring.size()];
    corners.push_back({rounded(p[0], decimals), rounded(p[1], decimals)});
  }
  return corners;
}

OrderedJson zone_json(const Zone& zone, const Decimals& decimals) {
  const formats::Polygon polygon = polygon_of(zone);
  OrderedJson rings = OrderedJson::array({ring_json(polygon.outline, decimals.degrees)});
  for (const formats::Ring& hole : polygon.holes) {
    rings.push_back(ring_json(hole, decimals.degrees));
  }
  const auto height = [&](const formats::ZoneLimit& limit) {
    const std::optional<double> value = altitude_of(limit);
    return value ? OrderedJson(rounded(*value, decimals.metres)) : OrderedJson(nullptr);
  };
  return {{"type", "Feature"},
          {"properties",
           {{"name", zone.name},
            {"role", role_of(zone)},
            {"floor_m", height(zone.volumes.front().lower)},
            {"ceiling_m", height(zone.volumes.front().upper)}}},
          {"geometry", {{"type", "Polygon"}, {"coordinates", rings}}}};
}
}  // namespace

std::string geojson_text(const MissionText& text) {
  const Decimals& decimals = text.decimals;
  const formats::MissionFile& mission = text.mission;
  const AltitudeFrame frame = mission.items.front().at.frame;
  OrderedJson line = OrderedJson::array();
  for (const MissionItem& item : mission.items) {
    line.push_back({rounded(item.at.lon, decimals.degrees), rounded(item.at.lat, decimals.degrees),
                    rounded(item.at.altitude_m, decimals.metres)});
  }
  OrderedJson properties{{"name", mission.name},
                         {"role", "route"},
                         {"altitude_frame", name(frame)},
                         {"altitudes", std::string("metres ") + words_of(frame)}};
  OrderedJson times = OrderedJson::array();
  for (const double time_s : text.times_s) {
    times.push_back(rounded(time_s, 3));
  }
  if (!times.empty()) {
    properties["times_s"] = times;
  }
  if (const std::string time = iso_time(text, 0); !time.empty()) {
    properties["start_time"] = time;
  }
  if (frame == AltitudeFrame::home) {
    const MissionPoint& home = mission.home.value();
    properties["home"] = {rounded(home.lon, decimals.degrees), rounded(home.lat, decimals.degrees),
                          rounded(home.altitude_m, decimals.metres)};
  }
  OrderedJson features =
      OrderedJson::array({{{"type", "Feature"},
                           {"properties", properties},
                           {"geometry", {{"type", "LineString"}, {"coordinates", line}}}}});
  for (const Zone& zone : mission.zones) {
    features.push_back(zone_json(zone, decimals));
  }
  const OrderedJson json{{"type", "FeatureCollection"}, {"features", features}};
  return json_text(json, 1) + "\n";
}
}  // namespace altiplan::host
