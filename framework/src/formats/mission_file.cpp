// SPDX-License-Identifier: Apache-2.0
#include "altiplan/formats/mission_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "altiplan/formats/earth_polygon.hpp"
#include "altiplan/formats/input_file.hpp"
#include "altiplan/geometry.hpp"
#include "mission_parts.hpp"
#include "text_file.hpp"

namespace altiplan::formats {
namespace {

constexpr double kMaxAltitude = 100'000;
constexpr double kMaxRadius = 100'000;  // of a circle
constexpr double kMaxTurns = 1000;      // more than an autopilot stores
/// Reached on a curve through its neighbours that autopilots lay differently.
constexpr int kSpline = 82;

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

/// The item kind of a command, none for one that is no position on the route. A landing start
/// carries a position, but marks where landing begins and is not flown to.
std::optional<MissionItem::Kind> kind_of(Task task) {
  using Kind = MissionItem::Kind;
  switch (task) {
    case Task::waypoint:
    case Task::spline:
      return Kind::waypoint;
    case Task::loiter_forever:
    case Task::loiter_turns:
    case Task::loiter_time:
    case Task::loiter_to_altitude:
      return Kind::loiter;
    case Task::take_off:
    case Task::vtol_take_off:
      return Kind::takeoff;
    case Task::land:
    case Task::vtol_land:
      return Kind::land;
    default:
      return std::nullopt;
  }
}

/// True for a command that flies the vehicle somewhere, but to no position of its own.
bool moves_vehicle(int command) {
  const CommandTask& row = command_task(command);
  switch (row.task) {
    case Task::return_home:
    case Task::change_altitude:
    case Task::arc:
    case Task::payload_place:
    case Task::jump:
    case Task::jump_to_tag:
      return true;
    case Task::other:  // flown by no autopilot, or decided by another program
      return row.number > 0;
    default:
      return false;
  }
}

/// The circle of a loiter's parameters as MAVLink numbers them; radii are positive clockwise.
std::optional<MissionCircle> circle_of(int command, const std::array<double, 4>& params) {
  using Until = MissionCircle::Until;
  const bool is_to_altitude = command == 31;
  const double radius = is_to_altitude ? params[1] : params[2];
  const bool is_left_by_tangent = params[3] == 1;  // "xtrack": from the location of the exit
  const bool is_circle = command == 17 || (command == 18 && params[0] >= 0 && is_left_by_tangent) ||
                         (is_to_altitude && is_left_by_tangent);
  if (!is_circle || !(std::abs(radius) > 0 && std::abs(radius) <= kMaxRadius)) {
    return std::nullopt;
  }
  MissionCircle circle;
  circle.until = command == 17 ? Until::forever : is_to_altitude ? Until::altitude : Until::turns;
  circle.radius_m = std::abs(radius);
  circle.sense = radius > 0 ? -1 : 1;
  circle.turns = command == 18 ? std::min(params[0], kMaxTurns) : 0;
  return circle;
}

MissionFile read_json_mission(const std::string& file, const std::string& text) {
  const nlohmann::json json = parse_json(file, text);
  try {
    const nlohmann::json type = json.is_object() ? json.value("type", nlohmann::json()) : json;
    if (type == "LineString" || type == "MultiLineString") {
      return read_geojson_route({{"type", "Feature"}, {"geometry", json}});
    }
    return type == "FeatureCollection" || type == "Feature" ? read_geojson_route(json)
                                                            : read_qgc_plan(json);
  } catch (const Error& error) {
    throw Error(file + ": " + error.what());
  }
}

}  // namespace

bool is_nowhere(double lon, double lat) {
  return (lon == 0 && lat == 0) || (std::isnan(lon) && std::isnan(lat));
}

void expect_position(double lon, double lat) {
  if (std::isfinite(lon) && std::isfinite(lat) && std::abs(lon) <= 180 && std::abs(lat) <= 90) {
    return;
  }
  const bool swapped = std::abs(lat) > 90 && std::abs(lat) <= 180 && std::abs(lon) <= 90;
  throw Error("expected longitude in [-180, 180] and latitude in [-90, 90], found longitude " +
              number_text(lon) + " and latitude " + number_text(lat) +
              (swapped ? ": are the axes swapped?" : ""));
}

void expect_altitude(double altitude_m) {
  if (!(std::abs(altitude_m) <= kMaxAltitude)) {
    throw Error("expected an altitude within 100 km of its reference, found " +
                (std::isnan(altitude_m) ? "none" : number_text(altitude_m) + " m"));
  }
}

AltitudeFrame frame_of(int mav_frame) {
  switch (mav_frame) {
    case 0:  // GLOBAL, and its integer form
    case 5:
      return AltitudeFrame::sea;
    case 3:  // GLOBAL_RELATIVE_ALT
    case 6:
      return AltitudeFrame::home;
    case 10:  // GLOBAL_TERRAIN_ALT
    case 11:
      return AltitudeFrame::ground;
    default:
      throw Error("expected the frame 0 (sea level), 3 (relative to home) or 10 (ground), found " +
                  std::to_string(mav_frame));
  }
}

void check_volume(ZoneVolume& volume) {
  if (volume.polygon.outline.empty()) {
    expect_position(volume.centre[0], volume.centre[1]);
    if (!(volume.radius_m > 0 && volume.radius_m <= 1e7)) {
      throw Error("expected a radius above 0 m, found " + number_text(volume.radius_m));
    }
    return;
  }
  volume.polygon.outline = without_repeats(volume.polygon.outline);
  for (Ring& hole : volume.polygon.holes) {
    hole = without_repeats(hole);
  }
  volume.polygon = unfolded(std::move(volume.polygon));
  if (const std::string problem = polygon_problem(volume.polygon); !problem.empty()) {
    throw Error(problem);
  }
}

MissionPoint CommandList::place_of(const MissionCommand& command) const {
  MissionPoint at{command.lon, command.lat, command.altitude_m, frame_of(command.frame)};
  if (is_nowhere(at.lon, at.lat)) {
    // Autopilots take off, loiter and land at the vehicle's current position.
    const MissionPoint* here = !mission_.items.empty() ? &mission_.items.back().at
                               : mission_.home         ? &*mission_.home
                                                       : nullptr;
    if (here == nullptr) {
      throw Error("begins at the vehicle's position, but the file has no home position");
    }
    at.lon = here->lon;
    at.lat = here->lat;
  }
  expect_position(at.lon, at.lat);
  expect_altitude(at.altitude_m);
  return at;
}

void CommandList::add(const MissionCommand& command) {
  mission_.commands.push_back(command);
  const Task task = command_task(command.number).task;
  if (task == Task::speed || task == Task::delay || task == Task::condition) {
    return;  // says how the others are flown
  }
  const auto kind = kind_of(task);
  if (!kind) {
    if (moves_vehicle(command.number)) {
      mission_.moves.push_back(command.place);
      ++moves_;
      moves_numbers_.insert(command.number);
    } else {
      ++skipped_;
      skipped_numbers_.insert(command.number);
    }
    return;
  }
  if (*kind == MissionItem::Kind::waypoint && is_nowhere(command.lon, command.lat)) {
    if (mission_.route_problem.empty()) {
      mission_.route_problem = command.place + ": a waypoint needs a position, found longitude " +
                               number_text(command.lon) + " and latitude " +
                               number_text(command.lat);
    }
    return;  // what an autopilot does then is for those who judge commands
  }
  const double acceptance = command.number == 16 && command.params[1] > 0 ? command.params[1] : 0;
  MissionItem item{*kind, place_of(command), acceptance, command.place,
                   circle_of(command.number, command.params)};
  item.number = command.item;
  mission_.items.push_back(std::move(item));
  if (command.number == kSpline) {
    mission_.moves.push_back(command.place);
  }
}

void CommandList::skip_complex(const std::string& place) {
  ++complex_;
  mission_.commands.push_back({});
  mission_.commands.back().place = place;
  mission_.moves.push_back(place);
}

void CommandList::finish() {
  const auto note = [&](std::size_t count, const char* what, const std::set<int>& numbers) {
    std::string list;
    for (const int number : numbers) {
      list += (list.empty() ? "" : ", ") + std::to_string(number);
    }
    if (count > 0) {
      mission_.notes.push_back(std::to_string(count) + what + " (" + list + ")");
    }
  };
  note(moves_, " commands that fly to no position of their own", moves_numbers_);
  note(skipped_, " commands that fly nowhere skipped", skipped_numbers_);
  if (taken_ > 0) {
    mission_.notes.push_back(std::to_string(taken_) + " commands taken out of survey items");
  }
  if (complex_ > 0) {
    mission_.notes.push_back(std::to_string(complex_) +
                             " complex items skipped: they contain no waypoints");
  }
}

bool is_mission_file(const std::string& file) {
  const std::string ending = ending_of(file);
  return ending == ".plan" || ending == ".waypoints" || ending == ".txt" || ending == ".kml";
}

MissionFile read_mission(const std::string& file) { return read_mission(file, read_file(file)); }

MissionFile read_mission(const std::string& file, const std::string& text) {
  const std::string mark = "\xEF\xBB\xBF";  // some editors put it before UTF-8
  const std::string body = text.starts_with(mark) ? text.substr(mark.size()) : text;
  const std::size_t first = body.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) {
    throw Error(file + ": is empty, expected a mission (.plan, QGC WPL 110, KML, GPX, GeoJSON)");
  }
  if (body[first] == '{' || body[first] == '[') {
    return read_json_mission(file, body);
  }
  if (body[first] == '<') {
    return read_kml_or_gpx(file, body);
  }
  return read_waypoints(file, body);
}
}  // namespace altiplan::formats
