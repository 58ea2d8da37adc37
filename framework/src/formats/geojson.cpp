// SPDX-License-Identifier: Apache-2.0
#include "altiplan/formats/geojson.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "airspace_parts.hpp"
#include "altiplan/error.hpp"
#include "altiplan/formats/earth_polygon.hpp"
#include "altiplan/formats/input_file.hpp"
#include "last_read.hpp"
#include "text_file.hpp"

namespace altiplan::formats {
namespace {

using Json = nlohmann::json;

std::string property_text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

Point2 read_position(const Json& point) {
  if (!point.is_array() || point.size() < 2 || !point[0].is_number() || !point[1].is_number()) {
    throw Error("expected a position [longitude, latitude], found " + short_text(point));
  }
  const Point2 p{point[0].get<double>(), point[1].get<double>()};
  if (!(std::abs(p[0]) <= 180 && std::abs(p[1]) <= 90)) {
    throw Error("expected longitude in [-180, 180] and latitude in [-90, 90], found " +
                short_text(point));
  }
  return p;
}

Ring read_ring(const Json& points) {
  if (!points.is_array()) {
    throw Error("a ring needs a list of positions, found " + short_text(points));
  }
  Ring ring;
  for (const Json& point : points) {
    ring.push_back(read_position(point));
  }
  if (!ring.empty() && ring.front() != ring.back()) {
    throw Error("a ring must end where it starts, " + short_text(points.front()) + "; it ends at " +
                short_text(points.back()));
  }
  return without_repeats(ring);
}

/// No polygon if it is degenerate.
Enclosed read_polygon(const Json& rings) {
  if (!rings.is_array()) {
    throw Error("a Polygon needs a list of rings, found " + short_text(rings));
  }
  Polygon polygon;
  for (std::size_t n = 0; n < rings.size(); ++n) {
    Ring ring = read_ring(rings[n]);
    if (n == 0) {
      polygon.outline = std::move(ring);
    } else {
      polygon.holes.push_back(std::move(ring));
    }
  }
  polygon = unfolded(std::move(polygon));
  if (is_flat(polygon)) {
    return {};
  }
  return enclosed_by(polygon);
}

std::map<std::string, std::string> properties_of(const Json& feature) {
  std::map<std::string, std::string> properties;
  if (feature.contains("properties") && feature["properties"].is_object()) {
    for (const auto& [name, value] : feature["properties"].items()) {
      if (!value.is_null()) {
        properties[name] = value.dump(-1, ' ', false, Json::error_handler_t::replace);
      }
    }
  }
  return properties;
}

/// The feature's id or name, else its number.
std::string id_of(const Json& feature, std::size_t n) {
  const Json* id = feature.contains("id") ? &feature["id"] : nullptr;
  if (id == nullptr && feature.contains("properties") && feature["properties"].is_object()) {
    const Json& properties = feature["properties"];
    for (const char* key : {"name", "title"}) {
      const auto name = properties.find(key);
      id = id == nullptr && name != properties.end() && !name->is_null() ? &*name : id;
    }
  }
  const std::string text = id == nullptr || id->is_null() ? "" : property_text(*id);
  return text.empty() ? std::to_string(n) : text;
}

/// Points and lines have an area if a property says how far they reach.
bool read_surroundings(const Json& feature, const std::string& id, const std::string& type,
                       GeoJson& to) {
  const Json none;
  const Json& geometry = feature["geometry"];
  const Json& coordinates = geometry.contains("coordinates") ? geometry["coordinates"] : none;
  std::vector<Ring> lines;
  if (type == "Point") {
    lines.push_back({read_position(coordinates)});
  } else if (!coordinates.is_array()) {
    throw Error("a " + type + " needs a list, found " + short_text(coordinates));
  } else if (type == "MultiPoint" || type == "LineString") {
    for (const Json& position : coordinates) {
      const bool begins = lines.empty() || type == "MultiPoint";
      begins ? lines.push_back({read_position(position)})
             : lines.back().push_back(read_position(position));
    }
  } else {
    for (const Json& line : coordinates) {
      if (!line.is_array()) {
        throw Error("a line needs a list of positions, found " + short_text(line));
      }
      lines.emplace_back();
      for (const Json& position : line) {
        lines.back().push_back(read_position(position));
      }
    }
  }
  double reach = 0;
  if (feature.contains("properties") && feature["properties"].is_object()) {
    for (const auto& [name, value] : feature["properties"].items()) {
      reach = std::max(reach, value.is_null() ? 0 : reach_of(name, property_text(value)));
    }
  }
  for (const Ring& line : lines) {
    if (type == "LineString" || type == "MultiLineString") {
      to.lines.push_back(line);
    } else {
      to.points.push_back({id, line.front()});
    }
    if (reach > 0) {
      for (Polygon& part : corridor_of(line, reach)) {
        to.surroundings.push_back({id, std::move(part), properties_of(feature)});
      }
    }
  }
  if (reach == 0) {
    const auto first =
        std::find_if(lines.begin(), lines.end(), [](const Ring& r) { return !r.empty(); });
    to.places.push_back(first == lines.end() ? id
                                             : id + " at " + short_text((*first)[0][0]) + ", " +
                                                   short_text((*first)[0][1]));
  }
  return reach > 0;
}

// Reads the feature's areas; false if it has none.
bool read_feature(const Json& feature, const std::string& id, GeoJson& to) {
  const auto geometry = feature.find("geometry");
  if (geometry == feature.end() || geometry->is_null()) {
    return false;
  }
  if (!geometry->is_object() || !geometry->contains("type") || !(*geometry)["type"].is_string()) {
    throw Error("expected a geometry with a type, found " + short_text(*geometry));
  }
  const std::string type = (*geometry)["type"].get<std::string>();
  const bool is_point = type == "Point" || type == "MultiPoint";
  if (is_point || type == "LineString" || type == "MultiLineString") {
    return read_surroundings(feature, id, type, to);
  }
  if (type != "Polygon" && type != "MultiPolygon") {
    throw Error("expected a Polygon or MultiPolygon, found the geometry type '" + type + "'");
  }
  const Json none;
  const Json& coordinates = geometry->contains("coordinates") ? (*geometry)["coordinates"] : none;
  const std::size_t before = to.features.size();
  bool has_flat = false;
  const auto take = [&](const Json& rings) {
    Enclosed area = read_polygon(rings);
    for (Polygon& polygon : area.polygons) {
      to.features.push_back({id, std::move(polygon), properties_of(feature), area.problem});
    }
    has_flat = has_flat || area.polygons.empty();
  };
  if (type == "Polygon") {
    take(coordinates);
  } else if (coordinates.is_array()) {
    std::for_each(coordinates.begin(), coordinates.end(), take);
  } else {
    throw Error("a MultiPolygon needs a list of polygons, found " + short_text(coordinates));
  }
  const bool has_area = to.features.size() > before;
  if (has_flat || !has_area) {
    to.flat.push_back(id);
  }
  return has_area;
}

}  // namespace

std::string GeoFeature::text(const std::string& property) const {
  const auto found = properties.find(property);
  return found == properties.end() ? "" : property_text(Json::parse(found->second));
}

std::optional<double> GeoFeature::metres(const std::string& property) const {
  if (!properties.contains(property)) {
    return std::nullopt;
  }
  const std::string value = text(property);
  double number = NAN;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc() || end != value.data() + value.size() || !std::isfinite(number)) {
    throw Error("expected metres in the property '" + property + "', found " +
                short_text(Json::parse(properties.at(property))));
  }
  return number;
}

Restriction role_of(const GeoFeature& feature) {
  const std::string role = feature.text("role");
  return role == "keep_in"    ? Restriction::keep_in
         : role == "keep_out" ? Restriction::keep_out
                              : Restriction::unspecified;
}

Zone zone_of(const GeoFeature& feature) {
  Zone zone;
  zone.name = feature.id;
  zone.restriction = role_of(feature);
  zone.problem = feature.problem;
  zone.volumes.push_back({feature.polygon, {}, {}});
  if (zone.restriction != Restriction::unspecified) {
    zone.volumes.front().lower = ZoneLimit::sea(feature.metres("floor_m"));
    zone.volumes.front().upper = ZoneLimit::sea(feature.metres("ceiling_m"));
  }
  return zone;
}

std::string GeoJson::skipped_text() const {
  return std::to_string(skipped) + " features without an area skipped" +
         (flat.empty() ? "" : " (" + names_text(flat) + ")");
}

void expect_properties(const std::string& file, const GeoJson& json,
                       const std::vector<std::string>& names) {
  std::set<std::string> present;
  for (const GeoFeature& feature : json.features) {
    for (const auto& [name, value] : feature.properties) {
      present.insert(name);
    }
  }
  std::string list;
  for (const std::string& name : present) {
    list += (list.empty() ? "" : ", ") + name;
  }
  for (const std::string& name : names) {
    if (!name.empty() && !present.contains(name)) {
      throw Error(file + ": no feature has the property '" + name +
                  "'; present: " + (list.empty() ? "none" : list));
    }
  }
}

namespace {
GeoJson parse_geojson(const std::string& file, const std::string& text) {
  Json document = parse_json(file, text);
  const std::string type = document.is_object() && document.contains("type")
                               ? property_text(document["type"])
                               : short_text(document);
  Json::array_t list;
  if (type == "FeatureCollection" && document.contains("features") &&
      document["features"].is_array()) {
    list = std::move(document["features"].get_ref<Json::array_t&>());
  } else if (type == "Feature") {
    list.push_back(document);
  } else if (document.is_object() && document.contains("coordinates")) {
    list.push_back({{"type", "Feature"}, {"geometry", document}});
  } else if (type == "FeatureCollection") {
    throw Error(file + ": the FeatureCollection has no list of features");
  } else {
    throw Error(file + ": expected a GeoJSON FeatureCollection, Feature or geometry, found " +
                type);
  }
  try {
    expect_wgs84(document);
  } catch (const Error& error) {
    throw Error(file + ": " + error.what());
  }
  GeoJson result;
  for (std::size_t n = 0; n < list.size(); ++n) {
    const Json& feature = list[n];
    if (!feature.is_object()) {
      throw Error(file + ": features." + std::to_string(n) + ": expected a Feature, found " +
                  short_text(feature));
    }
    const std::string id = id_of(feature, n);
    try {
      result.skipped += !read_feature(feature, id, result);
    } catch (const std::exception& error) {
      throw Error(file + ": features." + std::to_string(n) + " ('" + id + "'): " + error.what());
    }
  }
  if (document.contains("copyright") && document["copyright"].is_string()) {
    result.copyright = document["copyright"].get<std::string>();
  }
  return result;
}
}  // namespace

GeoJson read_geojson(const std::string& file) {
  static LastRead<GeoJson> last;
  return *last.get(file, read_file(file), parse_geojson);
}
}  // namespace altiplan::formats
