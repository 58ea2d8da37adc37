// SPDX-License-Identifier: Apache-2.0

#include "altiplan/formats/iso_time.hpp"
#include "host/base/json.hpp"
#include "host/import_export/mission_text.hpp"

namespace altiplan::host {
namespace {

using OrderedJson = nlohmann::ordered_json;
using formats::AltitudeFrame;
using formats::MissionItem;
using formats::MissionPoint;
using formats::Zone;

constexpr const char* kXml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool control = static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n';
    result += c == '&'   ? "&amp;"
              : c == '<' ? "&lt;"
              : c == '>' ? "&gt;"
              : control  ? "?"  // XML cannot represent it
                         : std::string(1, c);
  }
  return result;
}

const char* words_of(AltitudeFrame frame) {
  return frame == AltitudeFrame::sea      ? "above mean sea level"
         : frame == AltitudeFrame::ground ? "above the ground below each point"
                                          : "relative to the home position";
}

const char* role_of(const Zone& zone) { return zone.keeps_in() ? "keep_in" : "keep_out"; }

/// Metres above sea level; none: no limit.
std::optional<double> altitude_of(const formats::ZoneLimit& limit) {
  return limit.datum == formats::ZoneLimit::Datum::none ? std::nullopt
                                                        : std::optional(limit.metres);
}

/// Writes KML with the indentation of its element.
class KmlWriter {
 public:
  explicit KmlWriter(const MissionText& text) : decimals_(text.decimals) {
    const formats::MissionFile& mission = text.mission;
    const AltitudeFrame frame = mission.items.front().at.frame;
    out_ = kXml;
    out_ += "<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n";
    out_ += "  <name>" + escaped(mission.name) + "</name>\n";
    out_ +=
        "  <Style id=\"keep_out\"><PolyStyle><color>800000ff</color></PolyStyle></Style>\n"
        "  <Style id=\"keep_in\"><PolyStyle><color>4000ff00</color></PolyStyle></Style>\n";
    add_route(mission, frame);
    for (const Zone& zone : mission.zones) {
      add_zone(zone);
    }
    out_ += "</Document>\n</kml>\n";
  }
  const std::string& text() const { return out_; }

 private:
  std::string coordinate(const formats::Point2& p, double altitude) const {
    return rounded_text(p[0], decimals_.degrees) + "," + rounded_text(p[1], decimals_.degrees) +
           "," + rounded_text(altitude, decimals_.metres);
  }

  void add_route(const formats::MissionFile& mission, AltitudeFrame frame) {
    out_ += "  <Placemark>\n    <name>route</name>\n    <description>altitudes are metres " +
            std::string(words_of(frame)) +
            "</description>\n    <LineString>\n      <altitudeMode>" +
            (frame == AltitudeFrame::sea ? "absolute" : "relativeToGround") +
            "</altitudeMode>\n      <coordinates>\n";
    for (const MissionItem& item : mission.items) {
      out_ += "        " + coordinate({item.at.lon, item.at.lat}, item.at.altitude_m) + "\n";
    }
    out_ += "      </coordinates>\n    </LineString>\n  </Placemark>\n";
  }

  void add_ring(const char* element, const formats::Ring& ring, double altitude) {
    out_ += std::string("      <") + element + "><LinearRing><coordinates>\n";
    for (std::size_t n = 0; n <= ring.size(); ++n) {
      out_ += "        " + coordinate(ring[n % ring.size()], altitude) + "\n";
    }
    out_ += std::string("      </coordinates></LinearRing></") + element + ">\n";
  }

  void add_data(const char* key, const std::string& value) {
    out_ += std::string("      <Data name=\"") + key + "\"><value>" + value + "</value></Data>\n";
  }

  /// Extruded from its ceiling down to the ground; both limits are added as data.
  void add_zone(const Zone& zone) {
    const char* role = role_of(zone);
    const auto floor = altitude_of(zone.volumes.front().lower);
    const auto ceiling = altitude_of(zone.volumes.front().upper);
    out_ += "  <Placemark>\n    <name>" + escaped(zone.name.empty() ? role : zone.name) +
            "</name>\n    <styleUrl>#" + role + "</styleUrl>\n    <ExtendedData>\n";
    add_data("role", role);
    if (floor) {
      add_data("floor_m", rounded_text(*floor, decimals_.metres));
    }
    if (ceiling) {
      add_data("ceiling_m", rounded_text(*ceiling, decimals_.metres));
    }
    out_ += "    </ExtendedData>\n    <Polygon>\n";
    out_ += ceiling ? "      <extrude>1</extrude>\n      <altitudeMode>absolute</altitudeMode>\n"
                    : "      <altitudeMode>clampToGround</altitudeMode>\n";
    const formats::Polygon polygon = polygon_of(zone);
    const double altitude = ceiling.value_or(0);
    add_ring("outerBoundaryIs", polygon.outline, altitude);
    for (const formats::Ring& hole : polygon.holes) {
      add_ring("innerBoundaryIs", hole, altitude);
    }
    out_ += "    </Polygon>\n  </Placemark>\n";
  }

  Decimals decimals_;
  std::string out_;
};

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

/// When the route is at its n-th item, UTC; "" where no start time is given.
std::string iso_time(const MissionText& text, std::size_t n) {
  if (!text.start_time_s || n >= text.times_s.size()) {
    return "";
  }
  return formats::iso_time(*text.start_time_s + text.times_s[n]);
}
}  // namespace

std::string kml_text(const MissionText& text) { return KmlWriter(text).text(); }

std::string gpx_text(const MissionText& text) {
  const Decimals& decimals = text.decimals;
  std::string out = kXml;
  out +=
      "<gpx version=\"1.1\" creator=\"altiplan\" "
      "xmlns=\"http://www.topografix.com/GPX/1/1\">\n<rte>\n  <name>" +
      escaped(text.mission.name) +
      "</name>\n  <desc>ele is in metres above mean sea level</desc>\n";
  for (std::size_t n = 0; n < text.mission.items.size(); ++n) {
    const MissionItem& item = text.mission.items[n];
    const std::string time = iso_time(text, n);
    out += "  <rtept lat=\"" + rounded_text(item.at.lat, decimals.degrees) + "\" lon=\"" +
           rounded_text(item.at.lon, decimals.degrees) + "\"><ele>" +
           rounded_text(item.at.altitude_m, decimals.metres) + "</ele>" +
           (time.empty() ? "" : "<time>" + time + "</time>") + "</rtept>\n";
  }
  return out + "</rte>\n</gpx>\n";
}

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
