// SPDX-License-Identifier: Apache-2.0
#include "host/first_route/zones.hpp"

#include <algorithm>
#include <tuple>

#include "altiplan/error.hpp"
#include "altiplan/formats/airspace.hpp"
#include "altiplan/formats/geojson.hpp"
#include "altiplan/formats/input_file.hpp"
#include "altiplan/formats/mission_file.hpp"

namespace altiplan::host {

namespace {

/// GeoJSON, which is what is left where the content tells of no other kind.
formats::GeoJson read_features(const std::filesystem::path& file, const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first == text.npos || text[first] != '{') {
    throw Error(file.string() +
                ": expected zones: published airspace (ED-269, ED-318, AIXM 5.1, OpenAir, UAS "
                "facility maps), GeoJSON, KML, or a fence (.plan, .waypoints)");
  }
  return formats::read_geojson(file.string());
}
}  // namespace

std::string zone_parameters(const std::filesystem::path& file, bool has_start_time) {
  const std::string text = formats::read_file(file.string());
  if (formats::read_airspace(file.string(), text)) {
    return "";  // it says what its limits and hours are
  }
  if (formats::is_mission_file(file.string())) {
    // Autopilots want to be in all zones of a fence; polygons of a map are areas of their own.
    const formats::MissionFile mission = formats::read_mission(file.string(), text);
    return mission.format == formats::MissionFile::Format::kml ? "" : ", keep_in: all";
  }
  const formats::GeoJson json = read_features(file, text);
  if (json.features.empty() && json.surroundings.empty()) {
    throw Error(file.string() + ": contains no zone: " + json.skipped_text() +
                (json.places.empty()
                     ? ""
                     : "; points and lines without a width: " + formats::names_text(json.places)));
  }
  std::string parameters;
  for (const auto& [key, property, is_time] : {std::tuple("floor_property", "floor_m", false),
                                               {"ceiling_property", "ceiling_m", false},
                                               {"from_property", "from", true},
                                               {"until_property", "until", true},
                                               {"from_property", "timeBegin", true},
                                               {"until_property", "timeEnd", true}}) {
    const auto has = [property = property](const formats::GeoFeature& feature) {
      return feature.properties.contains(property);
    };
    if ((!is_time || has_start_time) && parameters.find(key) == parameters.npos &&
        std::any_of(json.features.begin(), json.features.end(), has)) {
      parameters += std::string(", ") + key + ": " + property;
    }
  }
  return parameters;
}
}  // namespace altiplan::host
