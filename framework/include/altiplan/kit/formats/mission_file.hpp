// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/kit/layers/polygon.hpp"

/// \file What ground stations write, in one form: QGroundControl's `.plan`, the `QGC WPL 110` text
/// of `.waypoints` and `.txt`, KML, and the routes of GPX and GeoJSON.
namespace altiplan::kit {

/// What a height is counted from: mean sea level, the ground below the point, or the home position.
enum class AltitudeFrame { sea, ground, home };

struct MissionPoint {
  double lon = 0;  ///< degrees
  double lat = 0;
  double altitude_m = 0;
  AltitudeFrame frame = AltitudeFrame::sea;
};

struct MissionItem {
  enum class Kind { takeoff, waypoint, loiter, land };
  Kind kind = Kind::waypoint;
  MissionPoint at;
  double acceptance_m = 0;  ///< the item counts as passed within it; 0 where the file says nothing
  std::string place;        ///< in the file, for messages: "mission.items.3", "line 5"
};

/// An area that must not be left (`keep_in`) or entered: a polygon, or a circle where the outline
/// is empty.
struct MissionZone {
  bool keep_in = false;
  bool has_role = true;  ///< false: the file does not say which of the two (KML)
  Polygon polygon;       ///< longitude, latitude
  Point2 centre{0, 0};
  double radius_m = 0;
  std::optional<double> floor_m;  ///< above sea level
  std::optional<double> ceiling_m;
  std::string name;
};

struct MissionFile {
  enum class Format { qgc_plan, waypoints, kml, gpx, geojson };
  Format format = Format::qgc_plan;
  std::string name;
  std::optional<MissionPoint> home;  ///< above sea level
  std::vector<MissionItem> items;
  std::string route_problem;  ///< what keeps the items from being a route, "" where nothing
  std::vector<MissionZone> zones;
  std::vector<std::string> flat;  ///< names of KML's polygons without an area, which are skipped
  /// What was left out, a line each ("4 commands that are no places were skipped: 177, 178").
  std::vector<std::string> notes;
};

/// Reads a mission file; which format it is in is told by what it holds. Throws Error, with the
/// file and the line or item to blame, for what is damaged, of another version or another format.
ALTIPLAN_API MissionFile read_mission(const std::string& file);
/// The same from a text that is at hand; `file` is for messages.
ALTIPLAN_API MissionFile read_mission(const std::string& file, const std::string& text);

/// Whether the file's ending is one of those that read_mission is for: plan, waypoints, txt, kml.
ALTIPLAN_API bool is_mission_file(const std::string& file);
}  // namespace altiplan::kit
