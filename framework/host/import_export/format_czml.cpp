// SPDX-License-Identifier: Apache-2.0
// CZML 1.0: a route in time, as Cesium shows it. Its heights are above the ellipsoid.
#include <cmath>

#include "altiplan/error.hpp"
#include "altiplan/formats/iso_time.hpp"
#include "altiplan/map_system.hpp"
#include "host/base/json.hpp"
#include "host/import_export/format_functions.hpp"

namespace altiplan::host {
namespace {

using formats::MissionItem;

/// The next item's position: longitude and latitude in degrees, height above the ellipsoid.
MissionItem czml_item(const Json& numbers, std::size_t at) {
  const auto number = [&](std::size_t n) { return numbers[at + n].get<double>(); };
  const double lon = number(1);
  const double lat = number(2);
  if (std::abs(lon) > 180 || std::abs(lat) > 90 || !std::isfinite(number(3))) {
    throw Error("expected a longitude in [-180, 180] and a latitude in [-90, 90]");
  }
  return {MissionItem::Kind::waypoint,
          {lon, lat, number(3) - geoid_height(lon, lat), formats::AltitudeFrame::sea},
          0,
          "position " + std::to_string(at / 4 + 1)};
}
}  // namespace

bool is_czml(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '[' &&
         text.find("\"document\"") != std::string_view::npos;
}

std::string czml_text(const MissionText& text) {
  const Decimals& decimals = text.decimals;
  const double start = text.start_time_s.value_or(0);
  const double epoch = std::round(start);
  Json positions = Json::array();
  for (std::size_t n = 0; n < text.mission.items.size(); ++n) {
    const formats::MissionPoint& at = text.mission.items[n].at;
    positions.push_back(rounded(text.times_s.at(n) + start - epoch, 3));
    positions.push_back(rounded(at.lon, decimals.degrees));
    positions.push_back(rounded(at.lat, decimals.degrees));
    positions.push_back(rounded(at.altitude_m + geoid_height(at.lon, at.lat), decimals.metres));
  }
  const std::string begin = formats::iso_time(epoch);
  const std::string span = begin + "/" + formats::iso_time(std::ceil(start + text.times_s.back()));
  const Json color{{"solidColor", {{"color", {{"rgba", {230, 60, 30, 255}}}}}}};
  const Json document{{"id", "document"},
                      {"name", text.mission.name},
                      {"version", "1.0"},
                      {"clock", {{"interval", span}, {"currentTime", begin}, {"multiplier", 10}}}};
  const Json route{{"id", "route"},
                   {"name", text.mission.name},
                   {"availability", span},
                   {"position",
                    {{"epoch", begin},
                     {"interpolationAlgorithm", "LINEAR"},
                     {"interpolationDegree", 1},
                     {"cartographicDegrees", positions}}},
                   {"point", {{"pixelSize", 10}, {"color", {{"rgba", {230, 60, 30, 255}}}}}},
                   {"path", {{"width", 3}, {"material", color}}}};
  return json_text(Json::array({document, route}), 1) + "\n";
}

formats::MissionFile read_czml(const std::string& file, const std::string& text) {
  std::optional<formats::MissionFile> mission;
  try {
    for (const Json& packet : parse_json(text)) {
      if (!packet.is_object() || !packet.contains("position") ||
          !packet["position"].contains("cartographicDegrees")) {
        continue;
      }
      const Json& numbers = packet["position"]["cartographicDegrees"];
      if (!numbers.is_array() || numbers.size() % 4 != 0) {
        throw Error("expected positions of four numbers each in cartographicDegrees");
      }
      if (mission) {
        mission->route_problem = "expected one packet with positions as the route, found more";
        continue;
      }
      mission.emplace();
      mission->format = formats::MissionFile::Format::other;
      const Json& position = packet["position"];
      if (position.value("interpolationAlgorithm", "LINEAR") != "LINEAR" &&
          position.value("interpolationDegree", 1) != 1) {
        mission->route_problem =
            "expected positions joined by straight lines (LINEAR), found the interpolation " +
            position["interpolationAlgorithm"].get<std::string>();
      }
      for (std::size_t at = 0; at < numbers.size(); at += 4) {
        mission->items.push_back(czml_item(numbers, at));
      }
    }
  } catch (const Json::exception& error) {
    throw Error(file + ": is not CZML: " + error.what());
  } catch (const Error& error) {
    throw Error(file + ": " + error.what());
  }
  if (!mission) {
    throw Error(file + ": no packet has a position with cartographicDegrees");
  }
  return std::move(*mission);
}
}  // namespace altiplan::host
