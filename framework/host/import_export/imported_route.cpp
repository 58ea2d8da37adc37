// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/imported_route.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "host/config/mission_key.hpp"
#include "host/import_export/joined_route.hpp"
#include "host/import_export/route_format.hpp"
#include "host/result/stored_result.hpp"

namespace altiplan::host {
namespace {

using formats::AltitudeFrame;
using formats::MissionItem;
using formats::MissionPoint;

const char* reference_of(AltitudeFrame frame) {
  return frame == AltitudeFrame::sea      ? "above sea level"
         : frame == AltitudeFrame::ground ? "above ground"
                                          : "relative to home";
}

void undo_rounding(Vec3& first, const Vec3& start) {
  if ((first - start).norm() <= kRoundingReach) {
    first = start;
  }
}

/// The same of the circle of a start or goal.
void undo_rounding(MissionPlace& place, const Vec3& centre, const std::optional<Loiter>& loiter) {
  if (loiter && place.circle && place.circle->sense == loiter->sense &&
      std::abs(place.circle->radius_m - loiter->radius) <= kRoundingReach &&
      (place.at - centre).norm() <= kRoundingReach) {
    place.at = centre;
    place.circle->radius_m = loiter->radius;
  }
}

/// The same of a point on the loiter circle of a start or goal.
void undo_rounding(Vec3& p, const Vec3& centre, const std::optional<Loiter>& loiter) {
  const Vec3 off(p.x() - centre.x(), p.y() - centre.y(), 0);
  if (loiter && std::abs(off.norm() - loiter->radius) <= kRoundingReach &&
      std::abs(p.z() - centre.z()) <= kRoundingReach) {
    p = centre + loiter->radius * off.normalized();
  }
}

/// The route past the items; reports those whose circle cannot be flown tangentially.
JoinedRoute join(const std::vector<MissionPlace>& places, const Request& request,
                 std::vector<std::string>& notes) {
  std::optional<double> heading;
  if (has_heading(request.start.velocity)) {
    heading = std::atan2(request.start.velocity.y(), request.start.velocity.x());
  }
  JoinedRoute joined = joined_route(places, heading, request.limits);
  if (joined.circles > 0) {
    notes.push_back(std::to_string(joined.circles) + " loiters read as circles");
  }
  if (joined.unjoined > 0) {
    notes.push_back(std::to_string(joined.unjoined) +
                    " loiters read as positions: no tangent leads to their circle or from it");
  }
  return joined;
}

void note_frames(const std::vector<MissionItem>& items, std::vector<std::string>& notes) {
  for (const auto frame : {AltitudeFrame::sea, AltitudeFrame::ground, AltitudeFrame::home}) {
    const auto count = std::count_if(items.begin(), items.end(),
                                     [&](const MissionItem& i) { return i.at.frame == frame; });
    if (count > 0) {
      notes.push_back(std::to_string(count) + " points with altitudes " + reference_of(frame));
    }
  }
}
}  // namespace

Vec3 to_local(const MissionPoint& point, const std::optional<MissionPoint>& home,
              const World& world) {
  if (!world.frame().has_position()) {
    throw Error(
        "longitude and latitude need a georeferenced world: add a georeferenced layer, or "
        "frame: {origin_lonlat: …}");
  }
  const auto [x, y] = world.frame().to_local(point.lon, point.lat);
  switch (point.frame) {
    case AltitudeFrame::sea:
      return {x, y, point.altitude_m};
    case AltitudeFrame::ground: {
      const std::optional<double> ground = world.ground(x, y);
      if (!ground) {
        throw Error("its altitude is above ground, and the world has no ground there");
      }
      return {x, y, *ground + point.altitude_m};
    }
    case AltitudeFrame::home:
      break;
  }
  if (!home) {
    throw Error("its altitude is relative to home, and the file has no home position");
  }
  return {x, y, home->altitude_m + point.altitude_m};
}

ImportedRoute route_in(const formats::MissionFile& mission, const World& world,
                       const Request& request, const std::string& file) {
  ImportedRoute result;
  result.notes = mission.notes;
  std::vector<MissionPlace> places;
  std::vector<MissionItem> items;
  try {
    items = route_items(mission);
    if (items.size() < mission.items.size()) {
      result.notes.emplace_back(
          "the landing straight below the last point is not part of the route");
    }
    for (const MissionItem& item : items) {
      try {
        places.push_back({to_local(item.at, mission.home, world), item.circle});
      } catch (const Error& error) {
        throw Error(item.place + ": " + error.what());
      }
    }
    note_frames(items, result.notes);
  } catch (const Error& error) {
    throw Error(file + ": " + error.what());
  }
  if (!places.front().circle) {
    undo_rounding(places.front().at, request.start.position);
  }
  const auto of_end = [](MissionPlace& place, const auto& end) {
    place.circle ? undo_rounding(place, end.position, end.loiter)
                 : undo_rounding(place.at, end.position, end.loiter);
  };
  of_end(places.front(), request.start);
  of_end(places.back(), request.goal);
  if (places.size() > 1) {  // where a circle that is written is left or joined
    of_end(places[1], request.start);
    of_end(places[places.size() - 2], request.goal);
  }
  JoinedRoute joined = join(places, request, result.notes);
  result.route = std::move(joined.route);
  for (const std::size_t place : joined.places) {
    result.items.push_back(items[place]);
  }
  return result;
}

namespace {
/// From the start to the goal past points whose heights are above ground.
Polyline between_ends(Polyline points, const World& world, const Request& request,
                      const std::string& file) {
  for (std::size_t i = 0; i < points.size() && world.has_ground(); ++i) {
    const std::optional<double> ground = world.ground(points[i].x(), points[i].y());
    if (!ground) {
      throw Error(file + ": waypoint " + std::to_string(i + 1) +
                  " has a height above ground, and the world has no ground there");
    }
    points[i].z() += *ground;
  }
  points.insert(points.begin(), request.start.position);
  points.push_back(request.goal.position);
  return points;
}
}  // namespace

ImportedRoute read_imported_route(const std::string& file, const std::string& text,
                                  const World& world, const Request& request,
                                  const std::optional<MissionPoint>& home) {
  std::optional<LocalRoute> read = read_local_route(file, text);
  if (!read) {
    formats::MissionFile mission = read_mission_file(file, text);
    if (!mission.home) {
      mission.home = home;
    }
    return route_in(mission, world, request, file);
  }
  Polyline& points = read->points;
  expect_reachable(points, file);
  if (read->is_inner) {
    return {between_ends(std::move(points), world, request, file),
            {"waypoints between start and goal, with heights above ground"}};
  }
  undo_rounding(points.front(), request.start.position);
  undo_rounding(points.front(), request.start.position, request.start.loiter);
  undo_rounding(points.back(), request.goal.position, request.goal.loiter);
  return {std::move(points), {}};
}

ImportedRoute read_imported_route(const std::string& file, const Mission& mission) {
  if (format_by_extension(file) != nullptr || is_mission_name(file) ||
      std::filesystem::path(file).extension() == ".mission") {
    return read_imported_route(file, formats::read_file(file), mission.truth, mission.request);
  }
  const std::string expected =
      "a route as a list of [x, y, z] in metres, or a mission whose name ends in .plan, "
      ".waypoints, "
      ".kml, .gpx or .geojson";
  const Json json = read_json(file, expected);
  if (json.is_object() && !json.contains("route")) {
    throw Error(file + ": expected " + expected);
  }
  return {route_of(json, file), {}};
}
}  // namespace altiplan::host
