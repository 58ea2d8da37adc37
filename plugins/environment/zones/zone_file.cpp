// SPDX-License-Identifier: Apache-2.0
#include "zone_file.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "altiplan/error.hpp"
#include "altiplan/formats/geojson.hpp"
#include "altiplan/formats/input_file.hpp"
#include "altiplan/formats/iso_time.hpp"
#include "published.hpp"

namespace altiplan::zones {
namespace {

using formats::GeoFeature;
using formats::GeoJson;
using formats::Zone;
using Datum = formats::ZoneLimit::Datum;

void expect_sound(const Zone& zone) {
  if (zone.keeps_in() && !zone.problem.empty()) {
    throw Error(zone.problem);
  }
  const formats::ZoneLimit& lower = zone.volumes.front().lower;
  const formats::ZoneLimit& upper = zone.volumes.front().upper;
  if (lower.datum == Datum::sea && upper.datum == Datum::sea && !(lower.metres < upper.metres)) {
    throw Error("the floor must be below the ceiling");
  }
}

double seconds(const std::string& time) {
  const std::optional<double> result = formats::parse_iso_time(time);
  if (!result) {
    throw Error("expected a time such as 2026-06-17T05:00:00Z (ISO 8601), found '" + time + "'");
  }
  return *result;
}

const TypeRule* rule_for(const FileRules& rules, const std::string& type) {
  const auto found = std::find_if(rules.types.begin(), rules.types.end(),
                                  [&](const TypeRule& rule) { return rule.is == type; });
  return found == rules.types.end() ? nullptr : &*found;
}

/// "26 of type L, 2 of type R"
std::string counted(const std::map<std::string, std::size_t>& types) {
  std::string text;
  for (const auto& [type, count] : types) {
    text += (text.empty() ? "" : ", ") + std::to_string(count) +
            (type.empty() ? " without a type" : " of type " + type);
  }
  return text;
}

/// A limit of the property, else that of our own file, else that of the feature's type.
void set_limit(const std::optional<double>& property, const std::optional<double>& of_type,
               formats::ZoneLimit& limit) {
  if (property || limit.datum == Datum::none) {
    limit = formats::ZoneLimit::sea(property ? property : of_type);
  }
}

Zone zone_of(const GeoFeature& feature, const FileRules& rules, const TypeRule* rule) {
  Zone zone = formats::zone_of(feature);
  if (zone.restriction == formats::Restriction::unspecified) {
    zone.restriction = rules.kind;
  }
  const TypeRule none;
  const TypeRule& type = rule != nullptr ? *rule : none;
  set_limit(feature.metres(rules.floor), type.floor_m, zone.volumes.front().lower);
  set_limit(feature.metres(rules.ceiling), type.ceiling_m, zone.volumes.front().upper);
  expect_sound(zone);
  zone.periods = time_window(feature.text(rules.from), feature.text(rules.until));
  return zone;
}

/// Properties that are named like a scenario's limits are read automatically in our files alone.
void expect_limits_read(const std::string& file, const GeoJson& json, const FileRules& rules) {
  for (const auto& [name, key, property] : {std::tuple("floor_m", "floor_property", &rules.floor),
                                            {"ceiling_m", "ceiling_property", &rules.ceiling}}) {
    for (const GeoFeature& feature : json.features) {
      if (property->empty() && feature.properties.contains(name) &&
          formats::role_of(feature) == formats::Restriction::unspecified) {
        throw Error(file + ": '" + feature.id + "': has the property '" + name +
                    "', which is not read: expected " + key + ": " + name + " in the scenario");
      }
    }
  }
}

/// "closed wherever its rings may enclose, as they are no polygon: 'spike'", if there are such.
void add_problems(FileZones& file) {
  std::vector<std::string> names;
  for (const Zone& zone : file.zones) {
    if (!zone.problem.empty() && (names.empty() || names.back() != zone.name)) {
      names.push_back(zone.name);
    }
  }
  if (!names.empty()) {
    file.notes.push_back("rings that are no polygon, closed in all that they may enclose: " +
                         formats::names_text(names));
  }
}

FileZones read_features(const std::string& file, const FileRules& rules) {
  GeoJson json = formats::read_geojson(file);
  const std::size_t polygons = json.features.size();
  std::vector<std::string> surrounded;
  for (GeoFeature& feature : json.surroundings) {
    if (surrounded.empty() || surrounded.back() != feature.id) {
      surrounded.push_back(feature.id);
    }
    json.features.push_back(std::move(feature));
  }
  if (!json.features.empty()) {
    formats::expect_properties(file, json,
                               {rules.floor, rules.ceiling, rules.from, rules.until, rules.type});
  }
  expect_limits_read(file, json, rules);
  if (json.features.empty() && !json.flat.empty()) {
    throw Error(file + ": contains no zone: " + json.skipped_text());
  }
  FileZones result;
  std::map<std::string, std::size_t> types;
  std::size_t skipped = 0;
  for (const GeoFeature& feature : json.features) {
    const std::string type = feature.text(rules.type);
    const TypeRule* rule = rules.type.empty() ? nullptr : rule_for(rules, type);
    ++types[type];
    if (rule != nullptr && rule->skip) {
      ++skipped;
      continue;
    }
    try {
      result.zones.push_back(zone_of(feature, rules, rule));
    } catch (const Error& error) {
      throw Error(file + ": '" + feature.id + "': " + error.what());
    }
  }
  result.notes.push_back(std::to_string(polygons) + " polygons read" +
                         (rules.type.empty() ? "" : " (" + counted(types) + ")") + ", " +
                         json.skipped_text() +
                         (skipped > 0 ? ", " + std::to_string(skipped) + " by their type" : ""));
  for (const std::string& limit : {rules.floor, rules.ceiling}) {
    if (!limit.empty()) {
      result.notes.push_back("the property '" + limit + "' is read as metres above sea level");
    }
  }
  add_problems(result);
  if (!surrounded.empty()) {
    result.notes.push_back("closed as far as a property says around " +
                           formats::names_text(surrounded));
  }
  if (!json.places.empty()) {
    result.notes.push_back("points and lines without a width, skipped: " +
                           formats::names_text(json.places));
  }
  return result;
}

/// KML polygons and the fences of ground stations.
FileZones read_fence(const std::string& file, const FileRules& rules) {
  for (const std::string& name :
       {rules.floor, rules.ceiling, rules.from, rules.until, rules.type}) {
    if (!name.empty()) {
      throw Error(file + ": has no property '" + name + "': properties are GeoJSON's");
    }
  }
  const formats::MissionFile mission = formats::read_mission(file);
  if (mission.zones.empty()) {
    throw Error(file + ": contains no zone" +
                (mission.flat.empty() ? "" : ": no area in " + formats::names_text(mission.flat)));
  }
  FileZones result;
  result.zones = mission.zones;
  for (Zone& zone : result.zones) {
    if (zone.restriction == formats::Restriction::unspecified) {
      zone.restriction = rules.kind;
    }
    expect_sound(zone);
  }
  result.notes.push_back(
      std::to_string(mission.zones.size()) + " zones read, " +
      std::to_string(mission.items.size()) + " waypoints of a route ignored" +
      (mission.flat.empty() ? ""
                            : "; skipped, without an area: " + formats::names_text(mission.flat)));
  result.notes.insert(result.notes.end(), mission.notes.begin(), mission.notes.end());
  add_problems(result);
  return result;
}
/// Null for GeoJSON whose properties the scenario names, and for other kinds of files.
std::shared_ptr<const formats::Airspace> read_published(const std::string& file,
                                                        const FileRules& rules) {
  const std::string text = formats::read_file(file);
  const bool is_json = text.find_first_of("{<") == text.find_first_not_of("\xEF\xBB\xBF \t\r\n") &&
                       text.find('{') < text.find('<');
  if (is_json && rules.name_properties()) {
    return nullptr;
  }
  const auto airspace = formats::read_airspace(file, text);
  if (airspace && rules.name_properties()) {
    throw Error(file + ": has no property '" +
                (rules.floor + rules.ceiling + rules.from + rules.until + rules.type) +
                "': properties are GeoJSON's");
  }
  if (airspace && rules.kind == formats::Restriction::keep_in) {
    throw Error(file + ": is published airspace (" + formats::format_name(airspace->format) +
                "), expected file_kind: keep_out");
  }
  if (airspace && airspace->zones.empty()) {
    throw Error(file + ": contains no zone");
  }
  return airspace;
}
}  // namespace

void TypeRule::describe(Fields& f) {
  f("is", is).required().doc("value of the property");
  f("floor_m", floor_m).unit("m").doc("floor of zones of this type without one, above sea level");
  f("ceiling_m", ceiling_m)
      .unit("m")
      .doc("ceiling of zones of this type without one, above sea level");
  f("skip", skip).doc("ignore zones of this type");
  f.check(floor_m.value_or(-kInfinity) < ceiling_m.value_or(kInfinity),
          "floor_m must be below ceiling_m");
}

void FileRules::describe(Fields& f) {
  f("file_kind", kind,
    {{"keep_out", formats::Restriction::keep_out}, {"keep_in", formats::Restriction::keep_in}})
      .doc("kind of the zones of GeoJSON and KML; each zone of a fence file declares its own");
  f("floor_property", floor).doc("GeoJSON's property with the floor, m above sea level");
  f("ceiling_property", ceiling).doc("GeoJSON's property with the ceiling, m above sea level");
  f("from_property", from).doc("GeoJSON's property with the start of the time window");
  f("until_property", until).doc("GeoJSON's property with the end of the time window");
  f("type_property", type).doc("GeoJSON's property with a type that `types` explains");
  f("types", types).doc("meaning of the types; zones of other types are closed at every height");
  f.check(types.empty() || !type.empty(), "types needs type_property");
}

std::vector<formats::ZonePeriod> time_window(const std::string& from, const std::string& until) {
  if (from.empty() && until.empty()) {
    return {};
  }
  const formats::ZonePeriod period{
      from.empty() ? -kInfinity : seconds(from), until.empty() ? kInfinity : seconds(until), {}};
  if (period.from > period.until) {
    throw Error("the time window ends at " + until + ", before it starts at " + from);
  }
  return {period};
}

FileZones read_zone_file(const std::string& file, const FileRules& rules) {
  if (const auto airspace = read_published(file, rules)) {
    FileZones result;
    result.airspace = airspace;
    return result;
  }
  return formats::is_mission_file(file) ? read_fence(file, rules) : read_features(file, rules);
}

}  // namespace altiplan::zones
