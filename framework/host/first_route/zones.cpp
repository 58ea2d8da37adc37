// SPDX-License-Identifier: Apache-2.0
#include "host/first_route/zones.hpp"

#include <algorithm>
#include <iterator>
#include <tuple>

#include "altiplan/error.hpp"
#include "altiplan/formats/airspace.hpp"
#include "altiplan/formats/geojson.hpp"
#include "altiplan/formats/input_file.hpp"
#include "altiplan/formats/mission_file.hpp"
#include "host/result/result_json.hpp"

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

/// ", ask: skip" for all zones, ", permitted: ["TMA", "CTR"]" for those of a file.
std::string permissions_text(const formats::Airspace& airspace,
                             const std::vector<std::string>& permitted) {
  std::string names;
  for (const std::string& called : permitted) {
    if (called == kEveryZone) {
      return ", ask: skip";
    }
    if (formats::permission_problem(airspace.zones, called).empty()) {
      names += (names.empty() ? "" : ", ") + exact_json_text(called);
    }
  }
  return names.empty() ? "" : ", permitted: [" + names + "]";
}

/// All that have a name, whatever the file's format.
std::vector<formats::Zone> zones_of(const std::filesystem::path& file) {
  const std::string text = formats::read_file(file.string());
  if (const auto airspace = formats::read_airspace(file.string(), text)) {
    return airspace->zones;
  }
  if (formats::is_mission_file(file.string())) {
    return formats::read_mission(file.string(), text).zones;
  }
  std::vector<formats::Zone> zones;
  const formats::GeoJson json = read_features(file, text);
  std::transform(json.features.begin(), json.features.end(), std::back_inserter(zones),
                 formats::zone_of);
  return zones;
}
}  // namespace

std::string permission_problem(const std::vector<std::string>& permitted,
                               const std::vector<std::filesystem::path>& files) {
  if (permitted.empty()) {
    return "";
  }
  std::vector<formats::Zone> zones;
  for (const std::filesystem::path& file : files) {
    const std::vector<formats::Zone> more = zones_of(file);
    zones.insert(zones.end(), more.begin(), more.end());
  }
  for (const std::string& called : permitted) {
    const std::string why = called == kEveryZone ? "" : formats::permission_problem(zones, called);
    if (!why.empty()) {
      return why;
    }
  }
  return "";
}

std::string zone_parameters(const std::filesystem::path& file, const ZoneUse& use) {
  const std::string buffer = use.buffer_m > 0 ? ", buffer_m: " + exact_json_text(use.buffer_m) : "";
  const std::string text = formats::read_file(file.string());
  if (const auto airspace = formats::read_airspace(file.string(), text)) {
    return permissions_text(*airspace, use.permitted) + buffer;  // it says its limits and hours
  }
  if (formats::is_mission_file(file.string())) {
    // Autopilots want to be in all zones of a fence; polygons of a map are areas of their own.
    const formats::MissionFile mission = formats::read_mission(file.string(), text);
    return (mission.format == formats::MissionFile::Format::kml ? "" : ", keep_in: all") + buffer;
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
    if ((!is_time || use.has_start_time) && parameters.find(key) == parameters.npos &&
        std::any_of(json.features.begin(), json.features.end(), has)) {
      parameters += std::string(", ") + key + ": " + property;
    }
  }
  return parameters + buffer;
}
}  // namespace altiplan::host
