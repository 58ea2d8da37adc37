// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "airspace_parts.hpp"
#include "altiplan/formats/earth_polygon.hpp"
#include "altiplan/map_system.hpp"
#include "xml_parts.hpp"

namespace altiplan::formats {
namespace {

/// A position of a KML file; the altitude is optional.
struct Coordinate {
  Point2 lonlat{0, 0};
  double altitude_m = 0;
  bool has_altitude = false;
};

Coordinate coordinate_of(std::string_view tuple) {
  double parts[3] = {0, 0, 0};
  std::size_t count = 0;
  for (std::size_t at = 0; at <= tuple.size();) {
    const std::size_t comma = std::min(tuple.find(',', at), tuple.size());
    if (count == 3) {
      throw Error("expected longitude,latitude[,altitude], found '" +
                  std::string(tuple.substr(0, 60)) + "'");
    }
    parts[count++] = number_of(tuple.substr(at, comma - at));
    at = comma + 1;
  }
  if (count < 2) {
    throw Error("expected longitude,latitude[,altitude], found '" +
                std::string(tuple.substr(0, 60)) + "'");
  }
  expect_position(parts[0], parts[1]);
  expect_altitude(parts[2]);
  return {{parts[0], parts[1]}, parts[2], count == 3};
}

std::vector<Coordinate> coordinates_of(const pugi::xml_node& geometry) {
  const pugi::xml_node node = only_child(geometry, "coordinates");
  if (!node) {
    throw Error("the element 'coordinates' is missing");
  }
  const std::string_view text = node.text().get();
  std::vector<Coordinate> all;
  constexpr const char* kSpace = " \t\r\n";
  for (std::size_t at = text.find_first_not_of(kSpace); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kSpace, at), text.size());
    all.push_back(coordinate_of(text.substr(at, end - at)));
    at = text.find_first_not_of(kSpace, end);
  }
  return all;
}

std::string_view altitude_mode(const pugi::xml_node& geometry) {
  const std::string_view mode = text_of(geometry, "altitudeMode");
  if (mode.empty()) {
    return "clampToGround";  // KML's default
  }
  if (mode != "absolute" && mode != "relativeToGround" && mode != "clampToGround") {
    throw Error("expected the altitudeMode absolute, relativeToGround or clampToGround, found '" +
                std::string(mode.substr(0, 40)) + "'");
  }
  return mode;
}

/// The height of a waypoint of DJI's WPML, whose Point has none, and what it counts from: of its
/// waylines, or of the template from which DJI Pilot makes these. Empty of any other Placemark.
std::pair<std::string_view, std::string_view> wpml_height(const pugi::xml_node& placemark) {
  // The first of its Folder, which may hold thousands of others to look through.
  const auto in_folder = [&](const char* name) { return child(placemark.parent(), name); };
  const auto text = [](const pugi::xml_node& node) { return trimmed(node.text().get()); };
  if (const std::string_view height = text_of(placemark, "executeHeight"); !height.empty()) {
    const std::string_view mode = text(in_folder("executeHeightMode"));
    if (mode != "WGS84" && mode != "relativeToStartPoint") {
      throw Error("expected the executeHeightMode relativeToStartPoint or WGS84, found '" +
                  std::string(mode.substr(0, 40)) + "'");
    }
    return {height, mode};
  }
  const std::string_view mode = text(child(in_folder("waylineCoordinateSysParam"), "heightMode"));
  return {mode.empty()                                   ? mode
          : text_of(placemark, "useGlobalHeight") == "1" ? text(in_folder("globalHeight"))
                                                         : text_of(placemark, "height"),
          mode};
}

std::optional<MissionPoint> wpml_point(const pugi::xml_node& geometry, const Coordinate& at) {
  const auto [height, mode] = wpml_height(geometry.parent());
  if (height.empty()) {
    return std::nullopt;
  }
  const auto [lon, lat] = at.lonlat;
  MissionPoint point{lon, lat, number_of(height), AltitudeFrame::ground};
  if (mode == "relativeToStartPoint") {
    point.frame = AltitudeFrame::home;
  } else if (mode == "WGS84" || mode == "EGM96") {
    point.altitude_m -= mode == "WGS84" ? geoid_height(lon, lat) : 0;
    point.frame = AltitudeFrame::sea;
  }
  expect_altitude(point.altitude_m);
  return point;
}

/// The place of take-off of WPML, above sea level: latitude, longitude, height above the ellipsoid.
MissionPoint take_off_place(std::string_view text) {
  double parts[3] = {0, 0, 0};
  for (std::size_t n = 0; n < 3; ++n) {
    const std::size_t comma = std::min(text.find(','), text.size());
    parts[n] = number_of(trimmed(text.substr(0, comma)));
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  expect_position(parts[1], parts[0]);
  expect_altitude(parts[2]);
  return {parts[1], parts[0], parts[2] - geoid_height(parts[1], parts[0]), AltitudeFrame::sea};
}

/// Data of a Placemark apart from its geometry: its name, and our own limits of a zone.
struct Placemark {
  std::string name;
  std::map<std::string, std::string, std::less<>> data;

  explicit Placemark(pugi::xml_node geometry) {
    while (geometry && local_name(geometry) != "Placemark") {
      geometry = geometry.parent();
    }
    name = text_of(geometry, "name");
    for (const pugi::xml_node& entry : child(geometry, "ExtendedData").children()) {
      if (local_name(entry) == "Data") {
        data[entry.attribute("name").value()] = text_of(entry, "value");
      }
    }
  }
  std::optional<double> metres(std::string_view key) const {
    const auto found = data.find(key);
    return found == data.end() ? std::nullopt : std::optional(number_of(found->second));
  }
};

/// Content of a KML file: routes as lines or points, zones as polygons.
class KmlReader {
 public:
  explicit KmlReader(MissionFile& mission) : mission_(mission) {}

  /// True if the content of the element has been read.
  bool take(const pugi::xml_node& node) {
    const std::string_view name = local_name(node);
    if (name == "Polygon") {
      add_polygon(node);
    } else if ((name == "LineString" || name == "Point") && add_surroundings(node)) {
      return true;
    } else if (name == "LineString") {
      ++lines_;
      add_points(node, line_);
    } else if (name == "Point") {
      add_points(node, points_);
      mission_.points.push_back({Placemark(node).name, coordinates_of(node).front().lonlat});
    } else if (name == "LinearRing") {  // not of a Polygon: those are taken with it
      mission_.route_problem =
          "a LinearRing by itself is neither a route nor a zone: expected a "
          "LineString or a Polygon";
    } else if (name == "takeOffRefPoint") {
      const MissionPoint place = take_off_place(trimmed(node.text().get()));
      if (place.lon != 0 || place.lat != 0) {  // else none is known
        mission_.home = place;
      }
    } else if (name == "takeOffSecurityHeight") {
      security_m_ = number_of(trimmed(node.text().get()));
    } else if (name == "waypointTurnMode") {
      expect_flown_as_drawn(node, kStops);
    } else if (name == "useGlobalTurnParam" && trimmed(node.text().get()) == "1") {
      expect_flown_as_drawn(child(node.parent().parent(), "globalWaypointTurnMode"), kStops);
    } else if (name == "templateType") {
      is_template_ = true;
    } else if (name == "finishAction") {
      expect_flown_as_drawn(node, "noAction");
    } else {
      links_ += name == "NetworkLink";
      tracks_ += name == "Track";  // of Google's extension
      return false;
    }
    return true;
  }

  void finish() {
    if (is_template_ && mission_.route_problem.empty()) {
      mission_.route_problem =
          "a template of DJI, from which DJI Pilot makes what is flown: expected the KMZ, or the "
          "waylines.wpml in it";
    }
    expect_climb_to_first();
    if (lines_ > 1) {
      mission_.route_problem =
          "expected one LineString as the route, found " + std::to_string(lines_);
    } else if (const Points& route = lines_ > 0 ? line_ : points_;
               !route.without_height.empty() && mission_.route_problem.empty()) {
      mission_.route_problem =
          "a route needs heights, three numbers per point and the altitudeMode absolute or "
          "relativeToGround: found " +
          route.without_height;
      mission_.lacks_heights = true;
    }
    mission_.items = lines_ > 0 ? std::move(line_.items) : std::move(points_.items);
    if (lines_ > 0 && !points_.items.empty()) {
      mission_.notes.push_back(std::to_string(points_.items.size()) +
                               " points beside the LineString skipped");
    }
    if (flat_ > 0) {
      mission_.notes.push_back(std::to_string(flat_) +
                               " polygons without altitude limits: they apply at every altitude");
    }
    if (tracks_ > 0) {
      mission_.route_problem =
          "a gx:Track records a flight and is not read: expected a LineString as the route";
      mission_.lacks_heights = false;
    }
    if (is_template_) {  // its polygons are areas to be surveyed
      mission_.zones.clear();
      mission_.lacks_heights = false;
    }
    if (links_ > 0) {
      mission_.notes.push_back(std::to_string(links_) + " network links not followed");
    }
  }

 private:
  struct Points {
    std::vector<MissionItem> items;
    std::string without_height;  ///< why, "" if all have one
  };

  static constexpr const char* kStops = "toPointAndStopWithDiscontinuityCurvature";

  /// Other words of WPML cut corners or fly on: what is flown is then not what the points say.
  void expect_flown_as_drawn(const pugi::xml_node& node, std::string_view word) {
    const std::string_view found = trimmed(node.text().get());
    if (found != word && mission_.route_problem.empty()) {
      mission_.route_problem = "how DJI flies the " + std::string(local_name(node)) + " '" +
                               std::string(found.substr(0, 60)) + "' is not judged, only " +
                               std::string(word);
    }
  }

  /// DJI climbs to that height above its start before it flies to the first point.
  void expect_climb_to_first() {
    constexpr double kLowest = 1.2;  // metres that it may be
    if (points_.items.empty() || points_.items.front().at.frame != AltitudeFrame::home) {
      return;
    }
    const double first = std::max(points_.items.front().at.altitude_m, kLowest);
    if (security_m_ > first + 0.01 && mission_.route_problem.empty()) {
      mission_.route_problem = "DJI climbs to the takeOffSecurityHeight of " +
                               std::to_string(std::lround(security_m_)) +
                               " m first, above its first point, which is not judged";
    }
  }

  /// True for the first point of a Folder of WPML.
  static bool begins_wayline(const pugi::xml_node& geometry) {
    pugi::xml_node before = geometry.parent().previous_sibling();
    while (before && local_name(before) != "Placemark") {
      before = before.previous_sibling();
    }
    return !before;
  }

  void add_points(const pugi::xml_node& geometry, Points& points) {
    if (const std::string_view offset = text_of(geometry, "altitudeOffset");
        !offset.empty() && number_of(offset) != 0) {
      throw Error("a gx:altitudeOffset is not read: expected heights without one");
    }
    const std::string_view mode = altitude_mode(geometry);
    const AltitudeFrame frame =
        mode == "relativeToGround" ? AltitudeFrame::ground : AltitudeFrame::sea;
    for (const Coordinate& c : coordinates_of(geometry)) {
      const std::optional<MissionPoint> wayline = wpml_point(geometry, c);
      if (wayline && !points.items.empty() && begins_wayline(geometry) &&
          (wayline->lon != points.items.back().at.lon ||
           wayline->lat != points.items.back().at.lat)) {
        mission_.route_problem =
            "a wayline begins elsewhere than the one before it ends, and how "
            "DJI flies there is not judged";
      }
      if (wayline && !points.items.empty() && wayline->lon == points.items.back().at.lon &&
          wayline->lat == points.items.back().at.lat &&
          wayline->altitude_m == points.items.back().at.altitude_m) {
        continue;  // where the next wayline begins
      }
      if (!wayline && points.without_height.empty()) {
        const std::string number = std::to_string(points.items.size() + 1);
        points.without_height = !c.has_altitude           ? "two numbers in point " + number
                                : mode == "clampToGround" ? "clampToGround, or no altitudeMode"
                                                          : "";
      }
      const double altitude = mode == "clampToGround" ? 0 : c.altitude_m;  // which has none
      points.items.push_back(
          {MissionItem::Kind::waypoint,
           wayline.value_or(MissionPoint{c.lonlat[0], c.lonlat[1], altitude, frame}), 0,
           "point " + std::to_string(points.items.size() + 1)});
    }
  }

  /// A point or a line is a zone if its data say how far it reaches.
  bool add_surroundings(const pugi::xml_node& geometry) {
    const Placemark placemark(geometry);
    double reach = 0;
    for (const auto& [name, value] : placemark.data) {
      reach = std::max(reach, reach_of(name, value));
    }
    if (reach == 0) {
      return false;
    }
    Ring line;
    for (const Coordinate& c : coordinates_of(geometry)) {
      line.push_back(c.lonlat);
    }
    for (Polygon& part : corridor_of(line, reach)) {
      Zone zone;
      zone.name = placemark.name;
      zone.restriction = Restriction::unspecified;
      zone.volumes.push_back({std::move(part), {}, {}});
      mission_.zones.push_back(std::move(zone));
    }
    return true;
  }

  static Ring ring_of(const pugi::xml_node& boundary, std::vector<double>& heights) {
    const std::vector<Coordinate> corners = coordinates_of(only_child(boundary, "LinearRing"));
    if (!corners.empty() && corners.front().lonlat != corners.back().lonlat) {
      throw Error("a ring must end where it starts");
    }
    Ring ring;
    for (const Coordinate& c : corners) {
      ring.push_back(c.lonlat);
      heights.push_back(c.altitude_m);
    }
    return ring;
  }

  /// An extruded polygon above sea level extends up to its corners; others apply at every height.
  void add_polygon(const pugi::xml_node& node) {
    const Placemark placemark(node);
    Zone zone;
    zone.name = placemark.name;
    ZoneVolume volume;
    std::vector<double> heights;
    bool has_outline = false;
    for (const pugi::xml_node& boundary : node.children()) {
      if (local_name(boundary) == "outerBoundaryIs") {
        if (has_outline) {
          throw Error("a Polygon has one outerBoundaryIs");
        }
        has_outline = true;
        volume.polygon.outline = ring_of(boundary, heights);
      } else if (local_name(boundary) == "innerBoundaryIs") {
        volume.polygon.holes.push_back(ring_of(boundary, heights));
      }
    }
    if (!has_outline) {
      throw Error("the Polygon has no outerBoundaryIs");
    }
    if (is_flat(unfolded(volume.polygon))) {
      return add_flat(zone);
    }
    volume.lower = ZoneLimit::sea(placemark.metres("floor_m"));
    volume.upper = ZoneLimit::sea(placemark.metres("ceiling_m"));
    const bool extruded = text_of(node, "extrude") == "1" || text_of(node, "extrude") == "true";
    const auto role = placemark.data.find("role");
    zone.restriction = role == placemark.data.end() ? Restriction::unspecified
                       : role->second == "keep_in"  ? Restriction::keep_in
                                                    : Restriction::keep_out;
    if (role != placemark.data.end()) {
      if (role->second != "keep_in" && role->second != "keep_out") {
        throw Error("expected the role keep_in or keep_out, found '" + role->second + "'");
      }
    } else if (extruded && altitude_mode(node) == "absolute") {
      const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
      if (*high - *low > 0.01) {
        throw Error("the polygon's corners have different altitudes: a zone has one ceiling");
      }
      volume.upper = ZoneLimit::sea(*high);
    }
    flat_ += volume.lower == ZoneLimit{} && volume.upper == ZoneLimit{};
    add_enclosed(zone, volume);
  }

  void add_flat(const Zone& zone) {
    mission_.flat.push_back(zone.name.empty() ? "a Polygon without a name" : zone.name);
  }

  void add_enclosed(Zone& zone, ZoneVolume& volume) {
    if (zone.keeps_in()) {
      check_volume(volume);
    }
    Polygon rings{without_repeats(volume.polygon.outline), {}};
    for (const Ring& hole : volume.polygon.holes) {
      rings.holes.push_back(without_repeats(hole));
    }
    Enclosed area = enclosed_by(unfolded(std::move(rings)));
    zone.problem = area.problem;
    if (area.polygons.empty()) {
      add_flat(zone);
    }
    for (Polygon& polygon : area.polygons) {
      volume.polygon = std::move(polygon);
      zone.volumes = {volume};
      mission_.zones.push_back(zone);
    }
  }

  MissionFile& mission_;
  Points line_;
  Points points_;
  std::size_t lines_ = 0;
  std::size_t flat_ = 0;
  std::size_t links_ = 0;
  std::size_t tracks_ = 0;
  bool is_template_ = false;
  double security_m_ = 0;
};
}  // namespace

MissionFile read_kml(const pugi::xml_node& root, const std::string& file, const std::string& text) {
  MissionFile mission;
  mission.format = MissionFile::Format::kml;
  read_elements<KmlReader>(mission, root, file, text);
  return mission;
}
}  // namespace altiplan::formats
