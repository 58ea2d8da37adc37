// SPDX-License-Identifier: Apache-2.0
#include "json_node.hpp"
#include "mission_parts.hpp"
#include "text_file.hpp"

namespace altiplan::formats {
namespace {

using Node = JsonNode;

/// The line of a GeoJSON file that is a route: three coordinates per point, and `altitude_frame`
/// among its properties (by default sea level, as in RFC 7946).
void read_line(const Node& feature, const Node& points, MissionFile& mission) {
  if (!mission.items.empty()) {
    mission.route_problem = "expected one LineString as the route, found more";
    mission.lacks_heights = false;
    return;
  }
  AltitudeFrame frame = AltitudeFrame::sea;
  if (feature.has("properties") && feature.at("properties").has("altitude_frame")) {
    const Node word = feature.at("properties").at("altitude_frame");
    const std::string text = word.text();
    if (text != "sea" && text != "ground" && text != "home") {
      word.wrong("sea, ground or home");
    }
    frame = text == "sea"      ? AltitudeFrame::sea
            : text == "ground" ? AltitudeFrame::ground
                               : AltitudeFrame::home;
  }
  if (frame == AltitudeFrame::home) {
    const Node home = feature.at("properties").at("home");
    if (home.size() != 3) {
      home.wrong("[longitude, latitude, altitude]");
    }
    mission.home = {home.at(std::size_t{0}).number(), home.at(1).number(), home.at(2).number(),
                    AltitudeFrame::sea};
    home.told([&] {
      expect_position(mission.home->lon, mission.home->lat);
      expect_altitude(mission.home->altitude_m);
    });
  }
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Node point = points.at(n);
    if (point.size() != 2 && point.size() != 3) {
      point.wrong("[longitude, latitude, altitude]");
    }
    if (point.size() == 2 && mission.route_problem.empty()) {
      mission.route_problem =
          "a route needs heights, three numbers per point: found two in " + point.place();
      mission.lacks_heights = true;
    }
    const MissionPoint p{point.at(std::size_t{0}).number(), point.at(1).number(),
                         point.size() == 3 ? point.at(2).number() : 0, frame};
    point.told([&] {
      expect_position(p.lon, p.lat);
      expect_altitude(p.altitude_m);
    });
    mission.items.push_back({MissionItem::Kind::waypoint, p, 0, point.place()});
  }
}

}  // namespace

MissionFile read_geojson_route(const nlohmann::json& json) {
  expect_wgs84(json);
  const JsonNode root(json, "");
  MissionFile mission;
  mission.format = MissionFile::Format::geojson;
  std::size_t others = 0;
  const auto read = [&](const Node& feature) {
    const Node geometry = feature.at("geometry");
    const std::string type = geometry.has("type") ? geometry.at("type").text() : "";
    if (type == "LineString") {
      read_line(feature, geometry.at("coordinates"), mission);
    } else if (type == "MultiLineString") {
      const Node lines = geometry.at("coordinates");
      for (std::size_t n = 0; n < lines.size(); ++n) {
        read_line(feature, lines.at(n), mission);
      }
    } else {
      ++others;
    }
  };
  if (root.at("type").text() == "Feature") {
    read(root);
  } else {
    const Node features = root.at("features");
    for (std::size_t n = 0; n < features.size(); ++n) {
      read(features.at(n));
    }
  }
  if (others > 0) {
    mission.notes.push_back(std::to_string(others) + " features other than lines skipped");
  }
  return mission;
}
}  // namespace altiplan::formats
