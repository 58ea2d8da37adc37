// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/formats/mission_commands.hpp"
#include "altiplan/formats/zone.hpp"

/// \file Missions of ground stations in one representation: QGroundControl's `.plan`, the `QGC WPL
/// 110` text of `.waypoints` and `.txt`, KML, and the routes of GPX and GeoJSON.
namespace altiplan::formats {

/// Reference of an altitude: mean sea level, the ground below the point, or the home position.
enum class AltitudeFrame { sea, ground, home };

struct MissionPoint {
  double lon = 0;  ///< degrees
  double lat = 0;
  double altitude_m = 0;
  AltitudeFrame frame = AltitudeFrame::sea;
};

/// The circle of a loiter around its item's position. It is left along the tangent to the next item
/// that is reached first after a condition.
struct MissionCircle {
  enum class Until { turns, altitude, forever };
  Until until = Until::altitude;
  double radius_m = 0;  ///< positive
  int sense = 1;        ///< 1: counter-clockwise, -1: clockwise
  double turns = 0;     ///< full circles, of Until::turns

  bool operator==(const MissionCircle&) const = default;
};

struct MissionItem {
  enum class Kind { takeoff, waypoint, loiter, land };
  Kind kind = Kind::waypoint;
  MissionPoint at;
  double acceptance_m = 0;  ///< acceptance radius; 0 where the file gives none
  std::string place;        ///< position in the file, for messages: "mission.items.3", "line 5"
  /// Of a loiter whose radius the file gives, and which is left along a tangent or never.
  std::optional<MissionCircle> circle{};
  double speed_mps = 0;  ///< on the way to it, of a mission that is written; 0: the vehicle's
  int number = 0;        ///< as ground stations show it; 0: the format numbers nothing
};

struct MissionFile {
  enum class Format { qgc_plan, waypoints, kml, gpx, geojson, other };
  Format format = Format::qgc_plan;
  std::string name;
  std::optional<MissionPoint> home;      ///< above sea level
  int firmware = 0;                      ///< MAV_AUTOPILOT; 0: not said
  int vehicle_type = 0;                  ///< MAV_TYPE; 0: not said
  double cruise_mps = 0;                 ///< of an aeroplane, as the file has it
  std::vector<MissionCommand> commands;  ///< all items, of `.plan` and `.waypoints`
  std::vector<MissionItem> items;
  /// Places of the commands that fly otherwise than to a position: a return, a jump, a scan.
  std::vector<std::string> moves;
  std::string route_problem;   ///< why the items are not a route, "" where they are
  bool lacks_heights = false;  ///< that is why: no commands, and a point without a height
  std::vector<Zone> zones;
  /// Where the vehicle may return to instead of home: of a .plan, and of QGC WPL 110 (MAV_CMD
  /// 5100).
  std::vector<MissionPoint> rally;
  std::vector<NamedPoint> points;  ///< of KML, by the names of their Placemarks
  std::vector<std::string> flat;   ///< names of KML polygons without an area, which are skipped
  /// Skipped parts, one per line ("4 commands that fly nowhere skipped (178, 203)").
  std::vector<std::string> notes;
};

/// Reads a mission file; the format is detected from its content. Throws Error, naming the file and
/// the line or item, for damaged data or another version or format.
ALTIPLAN_API MissionFile read_mission(const std::string& file);
/// The same from a text in memory; `file` is for messages.
ALTIPLAN_API MissionFile read_mission(const std::string& file, const std::string& text);

/// True if the file's extension is one that read_mission reads: plan, waypoints, txt, kml.
ALTIPLAN_API bool is_mission_file(const std::string& file);
}  // namespace altiplan::formats
