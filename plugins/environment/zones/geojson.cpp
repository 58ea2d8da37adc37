// SPDX-License-Identifier: Apache-2.0
#include "geojson.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "altiplan/error.hpp"

namespace altiplan::zones {
namespace {

using Json = nlohmann::json;

constexpr int kMaxDepth = 64;

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string short_text(const Json& value) {
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() > 40 ? text.substr(0, 40) + "…" : text;
}

Ring read_ring(const Json& points) {
  if (!points.is_array() || points.size() < 4) {
    throw Error("a ring needs at least four positions, found " + short_text(points));
  }
  Ring ring;
  for (const Json& point : points) {
    if (!point.is_array() || point.size() < 2 || !point[0].is_number() || !point[1].is_number()) {
      throw Error("expected a position [longitude, latitude], found " + short_text(point));
    }
    const Point2 p{point[0].get<double>(), point[1].get<double>()};
    if (!(std::abs(p[0]) <= 180 && std::abs(p[1]) <= 90)) {
      throw Error("expected longitude in [-180, 180] and latitude in [-90, 90], found " +
                  short_text(point));
    }
    ring.push_back(p);
  }
  if (ring.front() != ring.back()) {
    throw Error("a ring must end where it starts, " + short_text(points.front()) + "; it ends at " +
                short_text(points.back()));
  }
  return without_repeats(ring);
}

Polygon read_polygon(const Json& rings) {
  if (!rings.is_array() || rings.empty()) {
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
  if (const std::string problem = polygon_problem(polygon); !problem.empty()) {
    throw Error(problem);
  }
  return polygon;
}

const Json* property(const Json& feature, const std::string& name) {
  if (name.empty() || !feature.contains("properties") || !feature["properties"].is_object()) {
    return nullptr;
  }
  const auto found = feature["properties"].find(name);
  return found == feature["properties"].end() || found->is_null() ? nullptr : &*found;
}

std::optional<double> height(const Json& feature, const std::string& name) {
  const Json* value = property(feature, name);
  if (value == nullptr) {
    return std::nullopt;
  }
  double number = NAN;
  if (value->is_number()) {
    number = value->get<double>();
  } else if (value->is_string()) {
    const std::string& text = value->get_ref<const std::string&>();
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) {
      number = NAN;
    }
  }
  if (!std::isfinite(number)) {
    throw Error("expected metres in the property '" + name + "', found " + short_text(*value));
  }
  return number;
}

std::string text_property(const Json& feature, const std::string& name) {
  const Json* value = property(feature, name);
  return value == nullptr ? "" : text_of(*value);
}

// Takes the feature's areas; false where it has none.
bool read_feature(const Json& feature, const std::string& id, const PropertyNames& names,
                  std::vector<Feature>& features) {
  const auto geometry = feature.find("geometry");
  if (geometry == feature.end() || geometry->is_null()) {
    return false;
  }
  if (!geometry->is_object() || !geometry->contains("type") || !(*geometry)["type"].is_string()) {
    throw Error("expected a geometry with a type, found " + short_text(*geometry));
  }
  const std::string type = (*geometry)["type"].get<std::string>();
  for (const char* without_area : {"Point", "MultiPoint", "LineString", "MultiLineString"}) {
    if (type == without_area) {
      return false;
    }
  }
  if (type != "Polygon" && type != "MultiPolygon") {
    throw Error("expected a Polygon or MultiPolygon, found the geometry type '" + type + "'");
  }
  const Json none;
  const Json& coordinates = geometry->contains("coordinates") ? (*geometry)["coordinates"] : none;
  std::vector<Polygon> polygons;
  if (type == "Polygon") {
    polygons.push_back(read_polygon(coordinates));
  } else {
    if (!coordinates.is_array()) {
      throw Error("a MultiPolygon needs a list of polygons, found " + short_text(coordinates));
    }
    for (const Json& rings : coordinates) {
      polygons.push_back(read_polygon(rings));
    }
  }
  for (Polygon& polygon : polygons) {
    features.push_back({id, std::move(polygon), height(feature, names.floor),
                        height(feature, names.ceiling), text_property(feature, names.from),
                        text_property(feature, names.until)});
  }
  return true;
}

Json parse(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw Error(file + ": cannot be read");
  }
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  // Printing a value, and freeing it, goes down as many calls as it has levels.
  const auto shallow = [&](int depth, Json::parse_event_t, const Json&) {
    if (depth > kMaxDepth) {
      throw Error(file + ": lists and objects are nested over " + std::to_string(kMaxDepth) +
                  " levels deep");
    }
    return true;
  };
  try {
    return Json::parse(text, shallow);
  } catch (const Json::parse_error& error) {
    const auto end = text.begin() + std::ptrdiff_t(std::min(error.byte, text.size()));
    const auto line = 1 + std::count(text.begin(), end, '\n');
    throw Error(file + ": is not JSON: it breaks off or goes wrong in line " +
                std::to_string(line));
  } catch (const Json::out_of_range&) {
    throw Error(file + ": holds a number that is too large (beyond 1.8e308)");
  }
}

// A name that stands nowhere is a slip: the zones would silently hold at all heights and times.
void expect_properties(const std::string& file, const Json::array_t& features,
                       const PropertyNames& names) {
  std::set<std::string> present;
  for (const Json& feature : features) {
    if (feature.contains("properties") && feature["properties"].is_object()) {
      for (const auto& [name, value] : feature["properties"].items()) {
        present.insert(name);
      }
    }
  }
  std::string list;
  for (const std::string& name : present) {
    list += (list.empty() ? "" : ", ") + name;
  }
  for (const std::string& name : {names.floor, names.ceiling, names.from, names.until}) {
    if (!name.empty() && !present.contains(name)) {
      throw Error(file + ": no feature has the property '" + name +
                  "'; present: " + (list.empty() ? "none" : list));
    }
  }
}
}  // namespace

GeoJson read_geojson(const std::string& file, const PropertyNames& names) {
  const Json document = parse(file);
  const std::string type = document.is_object() && document.contains("type")
                               ? text_of(document["type"])
                               : short_text(document);
  Json::array_t list;
  if (type == "FeatureCollection" && document.contains("features") &&
      document["features"].is_array()) {
    list = document["features"].get_ref<const Json::array_t&>();
  } else if (type == "Feature") {
    list.push_back(document);
  } else {
    throw Error(file + ": expected a GeoJSON FeatureCollection or Feature, found " + type);
  }
  GeoJson result;
  for (std::size_t n = 0; n < list.size(); ++n) {
    const Json& feature = list[n];
    if (!feature.is_object()) {
      throw Error(file + ": features." + std::to_string(n) + ": expected a Feature, found " +
                  short_text(feature));
    }
    std::string id =
        feature.contains("id") ? text_of(feature["id"]) : text_property(feature, "name");
    id = id.empty() ? std::to_string(n) : id;
    try {
      result.skipped += !read_feature(feature, id, names, result.features);
    } catch (const std::exception& error) {
      throw Error(file + ": features." + std::to_string(n) + " ('" + id + "'): " + error.what());
    }
  }
  if (!result.features.empty()) {
    expect_properties(file, list, names);
  }
  return result;
}
}  // namespace altiplan::zones
