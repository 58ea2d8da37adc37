// SPDX-License-Identifier: Apache-2.0
//
// Features of ED-269 and ED-318 (EUROCAE: UAS geographical zones) and of the UAS facility maps of
// the FAA.
#include <algorithm>
#include <cmath>

#include "airspace_parts.hpp"
#include "altiplan/geometry.hpp"
#include "json_node.hpp"

namespace altiplan::formats {
namespace {

using Json = nlohmann::json;
using Format = Airspace::Format;

std::string text_at(const JsonNode& node, const char* key) {
  const auto value = node.json().find(key);
  if (value == node.json().end()) {
    return "";
  }
  if (value->is_string()) {
    return printable(value->get_ref<const std::string&>());
  }
  return value->is_number() ? value->dump() : "";
}

/// A name, or the first of a list of names in several languages.
std::string name_at(const JsonNode& node, const char* key) {
  if (node.has(key) && node.at(key).json().is_array() && node.at(key).size() > 0) {
    return text_at(node.at(key).at(std::size_t{0}), "text");
  }
  return text_at(node, key);
}

/// Keeps the place of the feature as its name if it has neither.
void set_names(Zone& zone, const std::string& id, const std::string& name) {
  zone.id = id;
  zone.name = id.empty() && name.empty() ? zone.name : name;
}

LimitText limit_at(const JsonNode& node, const char* key, const char* reference, const char* unit) {
  LimitText limit{{}, text_at(node, unit), text_at(node, reference), ""};
  if (const auto value = node.json().find(key); value != node.json().end()) {
    limit.found = short_text(*value);
    if (value->is_number()) {
      limit.value = value->get<double>();
    }
  }
  return limit;
}

Point2 position(const JsonNode& node) {
  if (node.size() < 2) {
    node.wrong("a position [longitude, latitude]");
  }
  const Point2 p{node.at(std::size_t{0}).number(), node.at(1).number()};
  node.told([&] { expect_lonlat(p); });
  return p;
}

Outline ring_outline(const JsonNode& node) {
  Ring ring;
  for (std::size_t n = 0; n < node.size(); ++n) {
    const Json& point = node.json()[n];
    const bool is_read = point.is_array() && point.size() >= 2 && point[0].is_number() &&
                         point[1].is_number() && std::abs(point[0].get<double>()) <= 180 &&
                         std::abs(point[1].get<double>()) <= 90;
    // A node's place in the file takes longer to write down than its numbers to read.
    ring.push_back(is_read ? Point2{point[0].get<double>(), point[1].get<double>()}
                           : position(node.at(n)));
  }
  if (ring.size() < 4 || ring.front() != ring.back()) {
    node.wrong("a ring of four positions or more that ends where it starts");
  }
  return {ring.begin(), ring.end()};
}

/// What a feature is read into.
struct Target {
  Zone& zone;
  Doubts& doubts;

  void add(Polygon polygon, const ZoneLimit& lower, const ZoneLimit& upper) const {
    zone.volumes.push_back({std::move(polygon), lower, upper});
    settle(zone.volumes.back(), zone.label(), doubts);
  }
  void add_polygon(const JsonNode& rings, const ZoneLimit& lower, const ZoneLimit& upper) const {
    if (rings.size() == 0) {
      rings.wrong("a list of rings");
    }
    std::vector<Ring> holes;
    for (std::size_t n = 1; n < rings.size(); ++n) {
      holes.push_back(ring_within(ring_outline(rings.at(n))));
    }
    const JsonNode first = rings.at(std::size_t{0});
    std::vector<Polygon> cover;
    first.told([&] { cover = cover_of(ring_outline(first), zone.label(), doubts); });
    for (Polygon& polygon : cover) {
      cut_holes(polygon, holes, zone.label(), doubts);
      add(std::move(polygon), lower, upper);
    }
  }
  void add_circle(const Point2& centre, const JsonNode& radius, const ZoneLimit& lower,
                  const ZoneLimit& upper) const {
    Ring ring;
    radius.told([&] { ring = circle_ring(centre, radius.number()); });
    add({std::move(ring), {}}, lower, upper);
  }
  void add_polygons(const JsonNode& geometry, const ZoneLimit& lower,
                    const ZoneLimit& upper) const {
    const JsonNode coordinates = geometry.at("coordinates");
    if (text_at(geometry, "type") == "Polygon") {
      add_polygon(coordinates, lower, upper);
      return;
    }
    if (coordinates.size() == 0) {
      coordinates.wrong("a list of polygons");
    }
    for (std::size_t n = 0; n < coordinates.size(); ++n) {
      add_polygon(coordinates.at(n), lower, upper);
    }
  }
};

/// One end of the hours of a day; none if it is unreadable.
std::optional<DailyHours::Edge> edge_at(const JsonNode& node, const char* time, const char* event) {
  if (node.has(event)) {
    const auto found = sun_event(text_at(node, event));
    return found ? std::optional(DailyHours::Edge{*found, 0}) : std::nullopt;
  }
  const auto seconds = clock_time(text_at(node, time));
  return seconds ? std::optional(DailyHours::Edge{DailyHours::Event::clock, *seconds})
                 : std::nullopt;
}

/// Days of "MON" or ["MON", "TUE"]; none if there is another word among them.
std::optional<unsigned> days_at(const JsonNode& node) {
  if (!node.has("day")) {
    return 127;
  }
  const JsonNode list = node.at("day");
  if (list.json().is_string()) {
    return day_bits(list.text());
  }
  unsigned days = 0;
  for (std::size_t n = 0; list.json().is_array() && n < list.size(); ++n) {
    const JsonNode item = list.at(n);
    const auto day = item.json().is_string() ? day_bits(item.text()) : std::nullopt;
    if (!day) {
      return std::nullopt;
    }
    days |= *day;
  }
  return days == 0 ? std::nullopt : std::optional(days);
}

std::optional<std::vector<DailyHours>> hours_at(const JsonNode& schedule) {
  std::vector<DailyHours> hours;
  for (std::size_t n = 0; schedule.json().is_array() && n < schedule.size(); ++n) {
    const JsonNode item = schedule.at(n);
    const auto days = days_at(item);
    const auto from = edge_at(item, "startTime", "startEvent");
    const auto until = edge_at(item, "endTime", "endEvent");
    if (!days || !from || !until) {
      return std::nullopt;
    }
    hours.push_back({*days, *from, *until});
  }
  return hours.empty() ? std::nullopt : std::optional(hours);
}

ZonePeriod period_of(const JsonNode& node, const Target& to) {
  const std::string label = to.zone.label();
  ZonePeriod period{-kInfinity, kInfinity, {}};
  if (upper_case(text_at(node, "permanent")) != "YES") {
    period.from = period_start(text_at(node, "startDateTime"), label, to.doubts);
    period.until = period_end(text_at(node, "endDateTime"), label, to.doubts);
  }
  if (node.has("schedule") && !node.at("schedule").json().empty()) {
    if (auto hours = hours_at(node.at("schedule"))) {
      period.hours = std::move(*hours);
    } else {
      to.doubts.add(
          "hours that are not read (expected days MON to SUN or ANY, and times in UTC "
          "such as 06:00Z or SR, SS, BMCT, EECT), active all day",
          label);
    }
  }
  settle(period, label, to.doubts);
  return period;
}

void read_periods(const JsonNode& node, const char* key, const Target& to) {
  if (!node.has(key) || node.at(key).json().is_null()) {
    return;
  }
  const JsonNode list = node.at(key);
  if (!list.json().is_array()) {
    to.doubts.add(
        "times that are not read (expected a list '" + std::string(key) + "'), always active",
        to.zone.label());
    return;
  }
  for (std::size_t n = 0; n < list.size(); ++n) {
    to.zone.periods.push_back(period_of(list.at(n), to));
  }
}

/// A volume; within GeoJSON its outline may be the geometry of the feature.
void read_ed269_volume(const JsonNode& volume, const JsonNode& feature, const Target& to) {
  const std::string label = to.zone.label();
  const ZoneLimit lower = lower_limit(
      limit_at(volume, "lowerLimit", "lowerVerticalReference", "uomDimensions"), label, to.doubts);
  const ZoneLimit upper = upper_limit(
      limit_at(volume, "upperLimit", "upperVerticalReference", "uomDimensions"), label, to.doubts);
  const bool has_own = volume.has("horizontalProjection") || !feature.has("properties");
  const JsonNode projection = has_own ? volume.at("horizontalProjection") : feature.at("geometry");
  const std::string type = text_at(projection, "type");
  if (type == "Circle") {
    to.add_circle(position(projection.at("center")), projection.at("radius"), lower, upper);
  } else if (type == "Polygon" || type == "MultiPolygon") {
    to.add_polygons(projection, lower, upper);
  } else {
    projection.wrong(has_own ? "a horizontalProjection of type Circle, Polygon or MultiPolygon"
                             : "a geometry of type Polygon or MultiPolygon");
  }
}

/// A zone of ED-269, as its own JSON or in the properties of GeoJSON, which national files have.
void read_ed269(const JsonNode& feature, const Target& to) {
  const JsonNode fields = feature.has("properties") ? feature.at("properties") : feature;
  Zone& zone = to.zone;
  set_names(zone, text_at(fields, "identifier"), name_at(fields, "name"));
  zone.type = text_at(fields, "restriction");
  read_periods(fields, "applicability", to);
  if (fields.has("geometry") && fields.at("geometry").json().is_array()) {
    const JsonNode volumes = fields.at("geometry");
    if (volumes.size() == 0) {
      volumes.wrong("a list of volumes");
    }
    for (std::size_t n = 0; n < volumes.size(); ++n) {
      read_ed269_volume(volumes.at(n), feature, to);
    }
  } else {
    static const Json kNone = Json::object();
    read_ed269_volume(
        fields.has("geometry") ? fields.at("geometry") : JsonNode(kNone, fields.place()), feature,
        to);
  }
}

void read_ed318_geometry(const JsonNode& geometry, const Json& outer, const Target& to) {
  static const Json kNone = Json::object();
  const Json& json = geometry.has("layer") ? geometry.at("layer").json() : outer;
  const std::string type = text_at(geometry, "type");
  if (type == "GeometryCollection") {
    const JsonNode list = geometry.at("geometries");
    if (list.size() == 0) {
      list.wrong("a list of geometries");
    }
    for (std::size_t n = 0; n < list.size(); ++n) {
      read_ed318_geometry(list.at(n), json, to);
    }
    return;
  }
  const JsonNode layer(json.is_object() ? json : kNone, geometry.place() + ".layer");
  const ZoneLimit lower =
      lower_limit(limit_at(layer, "lower", "lowerReference", "uom"), to.zone.label(), to.doubts);
  const ZoneLimit upper =
      upper_limit(limit_at(layer, "upper", "upperReference", "uom"), to.zone.label(), to.doubts);
  if (type == "Polygon" || type == "MultiPolygon") {
    to.add_polygons(geometry, lower, upper);
  } else if (type == "Point") {
    const JsonNode extent = geometry.at("extent");
    if (text_at(extent, "subType") != "Circle") {
      extent.wrong("an extent of subType Circle");
    }
    to.add_circle(position(geometry.at("coordinates")), extent.at("radius"), lower, upper);
  } else {
    geometry.wrong("a geometry of type Polygon, MultiPolygon, Point or GeometryCollection");
  }
}

void read_ed318(const JsonNode& feature, const Target& to) {
  static const Json kNone = Json::object();
  const JsonNode properties =
      feature.has("properties") ? feature.at("properties") : JsonNode(kNone, "properties");
  set_names(to.zone, text_at(properties, "identifier"), name_at(properties, "name"));
  to.zone.type = text_at(properties, "type");
  read_periods(properties, "limitedApplicability", to);
  read_ed318_geometry(feature.at("geometry"), kNone, to);
}

/// A cell is closed above its ceiling; below it, the FAA authorises automatically.
void read_faa(const JsonNode& feature, const Target& to) {
  const JsonNode properties = feature.at("properties");
  set_names(to.zone, text_at(properties, "OBJECTID"), text_at(properties, "APT1_ICAO"));
  to.zone.type = "UASFM";
  LimitText ceiling = limit_at(properties, "CEILING", "", "");
  ceiling.unit = "FT";
  ceiling.reference = "AGL";
  if (ceiling.value && *ceiling.value < 0) {
    ceiling.value = std::nullopt;
  }
  const JsonNode geometry = feature.at("geometry");
  const std::string type = text_at(geometry, "type");
  if (type != "Polygon" && type != "MultiPolygon") {
    geometry.wrong("a geometry of type Polygon or MultiPolygon");
  }
  to.add_polygons(geometry, lower_limit(ceiling, to.zone.label(), to.doubts), {});
}
}  // namespace

void read_json_feature(const JsonNode& feature, Airspace::Format format, Airspace& to,
                       Doubts& doubts) {
  Zone zone;
  zone.name = feature.place();  // unless it has one
  const Target target{zone, doubts};
  const auto read = [&] {
    switch (format) {
      case Format::ed269:
        return read_ed269(feature, target);
      case Format::ed318:
        return read_ed318(feature, target);
      default:
        return read_faa(feature, target);
    }
  };
  try {
    read();
  } catch (const Error& error) {
    const std::string label = zone.label();
    throw Error(error.what() + (label.empty() ? "" : " (zone '" + label + "')"));
  }
  if (zone.volumes.empty()) {
    return;
  }
  zone.restriction = restriction_of(zone.type, zone.label(), doubts);
  to.zones.push_back(std::move(zone));
}
}  // namespace altiplan::formats
