// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/export.hpp"

#include "altiplan/error.hpp"
#include "host/import_export/fence.hpp"
#include "host/import_export/imported_route.hpp"
#include "host/import_export/thinning.hpp"
#include "host/judge/judge.hpp"

namespace altiplan::host {
namespace {

using kit::AltitudeFrame;
using kit::MissionItem;
using kit::MissionPoint;
using Format = kit::MissionFile::Format;

/// The first suits autopilots, which store degrees to seven decimals (1 cm); the last matches the
/// judge's tolerance.
constexpr Decimals kDecimals[] = {{7, 3}, {9, 5}, {13, 8}};

/// Height of home above sea level, if known.
std::optional<double> home_altitude(const Mission& mission, const ExportOptions& options,
                                    const Vec3& start) {
  return options.home_altitude_m ? options.home_altitude_m
                                 : mission.truth.ground(start.x(), start.y());
}

/// Throws Error if the options need something that the world does not have.
void expect_possible(const Mission& mission, const ExportOptions& options, const Vec3& start) {
  if (options.format && !mission.truth.frame().has_position()) {
    throw Error(
        "the scenario's world is not georeferenced: add a georeferenced layer, or "
        "frame: {origin_lonlat: …}; csv needs neither");
  }
  if (options.altitude == AltitudeFrame::ground && !mission.truth.has_ground()) {
    throw Error("--altitude ground needs a world with ground");
  }
  const std::optional<double> home = home_altitude(mission, options, start);
  if (!home && (options.altitude == AltitudeFrame::home || options.takeoff || options.land)) {
    throw Error(
        "--altitude home, --takeoff and --land need the altitude of home, and the world has no "
        "ground below the start: give --home-altitude M, in metres above sea level");
  }
  if (options.takeoff && *home >= start.z()) {
    throw Error("--takeoff: the start, " + rounded_text(start.z(), 3) +
                " m above sea level, is not above home, " + rounded_text(*home, 3) + " m");
  }
}

double ground_at(const World& world, const Vec3& p) {
  const std::optional<double> ground = world.ground(p.x(), p.y());
  if (!ground) {
    throw Error("the world has no ground below the route");
  }
  return *ground;
}

/// Converts local points to points of a file; without a georeference, only their heights.
class Placing {
 public:
  Placing(const Mission& mission, const ExportOptions& options, const Vec3& start)
      : world_(mission.truth), frame_(options.altitude) {
    const auto at = lonlat(start);
    home_ = {at[0], at[1], home_altitude(mission, options, start).value_or(start.z()),
             AltitudeFrame::sea};
  }
  const MissionPoint& home() const { return home_; }
  MissionPoint operator()(const Vec3& p) const {
    const double reference = frame_ == AltitudeFrame::sea      ? 0
                             : frame_ == AltitudeFrame::ground ? ground_at(world_, p)
                                                               : home_.altitude_m;
    const auto at = lonlat(p);
    return {at[0], at[1], p.z() - reference, frame_};
  }
  std::string in_words() const {
    switch (frame_) {
      case AltitudeFrame::sea:
        return "altitudes above sea level";
      case AltitudeFrame::ground:
        return "altitudes above the ground below each point";
      case AltitudeFrame::home:
        break;
    }
    return "altitudes relative to home, which is " + rounded_text(home_.altitude_m, 3) +
           " m above sea level";
  }

 private:
  std::array<double, 2> lonlat(const Vec3& p) const {
    const Frame& frame = world_.frame();
    return frame.has_position() ? frame.to_lonlat(p.x(), p.y()) : std::array<double, 2>{0, 0};
  }

  const World& world_;
  AltitudeFrame frame_;
  MissionPoint home_;
};

/// The end point of the landing below the last point.
Vec3 landing(const Mission& mission, const Polyline& route, const Placing& place) {
  Vec3 down = route.back();
  down.z() = mission.truth.ground(down.x(), down.y()).value_or(place.home().altitude_m);
  return down;
}

/// The problem of the vertical climb and descent, which are not part of the route: a layer that
/// they come too near to, except the ground, where they begin and end; "" if none.
std::string column_problem(const Mission& mission, const Polyline& route, const Placing& place,
                           const ExportOptions& options) {
  Vec3 home = route.front();
  home.z() = place.home().altitude_m;
  const Vec3 down = landing(mission, route, place);
  for (const Layer& layer : mission.truth.layers()) {
    const auto blocked = [&](const Vec3& foot, const Vec3& top) {
      return layer.environment->ground() == nullptr &&
             layer.environment->blocked(foot, top, mission.request.vehicle.radius_m);
    };
    if (options.takeoff && blocked(home, route.front())) {
      return "the climb from home to the start passes too close to '" + layer.id + "'";
    }
    if (options.land && blocked(down, route.back())) {
      return "the descent from the last point passes too close to '" + layer.id + "'";
    }
  }
  return "";
}

kit::MissionFile mission_of(const Mission& mission, const ExportSource& source,
                            const Placing& place, const ExportOptions& options) {
  const Polyline& route = source.route;
  kit::MissionFile file;
  file.format = options.format.value();
  file.name = source.name;
  file.home = place.home();
  for (const Vec3& p : route) {
    file.items.push_back({MissionItem::Kind::waypoint, place(p), 0, ""});
  }
  if (options.takeoff) {
    file.items.front().kind = MissionItem::Kind::takeoff;
  }
  if (options.land) {
    file.items.push_back({MissionItem::Kind::land, place(landing(mission, route, place)), 0, ""});
  }
  return file;
}

std::string csv_text(const ExportSource& source, const Placing& place, bool placed,
                     const Decimals& decimals) {
  const bool timed = !source.times.empty();
  std::string out = std::string(timed ? "time_s," : "") + "x_m,y_m,z_m" +
                    (placed ? ",longitude_deg,latitude_deg" : "") + ",altitude_m,altitude_frame\n";
  for (std::size_t n = 0; n < source.route.size(); ++n) {
    const Vec3& p = source.route[n];
    const MissionPoint at = place(p);
    if (timed) {
      out += rounded_text(source.times[n], 3) + ",";
    }
    for (int axis = 0; axis < 3; ++axis) {
      out += rounded_text(p[axis], decimals.metres) + ",";
    }
    if (placed) {
      out += rounded_text(at.lon, decimals.degrees) + "," + rounded_text(at.lat, decimals.degrees) +
             ",";
    }
    out += rounded_text(at.altitude_m, decimals.metres) + "," + name(at.frame) + "\n";
  }
  return out;
}

/// The first violation of the route as written and read back; "" if it is valid.
std::string problem_of(const Mission& mission, const ExportSource& source, const Polyline& route) {
  CheckResult check;
  if (source.times.empty()) {
    check = judge(route, mission.request, mission.via);
  } else {
    Track track;
    for (std::size_t n = 0; n < route.size(); ++n) {
      track.emplace_back(source.times[n], route[n]);
    }
    FlightSetup setup;
    setup.request = mission.track_request;
    setup.truth = mission.truth;
    setup.events = source.events;
    check = judge_track(track, setup).check;
  }
  if (check.ok()) {
    return "";
  }
  const Violation& first = check.violations.front();
  return "point " + std::to_string(first.at) + ", " + first.constraint + ": " + first.message;
}

/// Drops points, and their times, to fit max_items, and reports it. False if the route cannot be
/// thinned that far.
bool thin(const Mission& mission, ExportSource& source, const ExportOptions& options,
          std::vector<std::string>& messages) {
  const std::size_t extra = options.land ? 1 : 0;
  if (!options.max_items || source.route.size() + extra <= *options.max_items) {
    return true;
  }
  const bool flown = !source.times.empty();
  const std::size_t most = *options.max_items > extra ? *options.max_items - extra : 0;
  const std::vector<std::size_t> kept =
      thinned(source.route, most, flown ? mission.track_request : mission.request,
              flown ? std::vector<Goal>() : mission.via);
  if (kept.size() > most) {
    messages.push_back("not written: the route needs " + std::to_string(kept.size() + extra) +
                       " items to stay valid, more than --max-items " +
                       std::to_string(*options.max_items));
    return false;
  }
  messages.push_back(std::to_string(source.route.size() - kept.size()) + " of " +
                     std::to_string(source.route.size()) +
                     " points dropped: the route stays valid without them");
  ExportSource less{source.name, {}, {}, source.events};
  for (const std::size_t n : kept) {
    less.route.push_back(source.route[n]);
    if (flown) {
      less.times.push_back(source.times[n]);
    }
  }
  source = std::move(less);
  return true;
}

/// Adds the zones; reports it if the format cannot hold them.
void add_zones(const Mission& mission, const Polyline& route, kit::MissionFile& file,
               std::vector<std::string>& messages) {
  const World& world = mission.known;
  const bool flat = file.format == Format::qgc_plan;
  Fence fence = flat ? flat_fence_of(world, route) : zones_of(world);
  messages.insert(messages.end(), fence.notes.begin(), fence.notes.end());
  if (fence.zones.empty()) {
    return;
  }
  const std::string count = std::to_string(fence.zones.size()) + " zones ";
  if (file.format == Format::waypoints || file.format == Format::gpx) {
    messages.push_back(count + "are not written: the format cannot hold them beside a route");
    return;
  }
  messages.push_back(count + (flat ? "written as the fence" : "written"));
  file.zones = std::move(fence.zones);
}

const char* file_name(const std::optional<Format>& format) {
  if (!format) {
    return "route.csv";
  }
  switch (*format) {
    case Format::qgc_plan:
      return "route.plan";
    case Format::waypoints:
      return "route.waypoints";
    case Format::kml:
      return "route.kml";
    case Format::gpx:
      return "route.gpx";
    case Format::geojson:
      break;
  }
  return "route.geojson";
}
}  // namespace

std::string ExportOptions::problem() const {
  if (format == Format::gpx && altitude != AltitudeFrame::sea) {
    return "gpx only has heights above sea level: give --altitude sea";
  }
  if (format == Format::kml && altitude == AltitudeFrame::home) {
    return "kml only has heights above sea level or ground: give --altitude sea or ground";
  }
  if ((takeoff || land) && format != Format::qgc_plan && format != Format::waypoints) {
    return "--takeoff and --land need qgc-plan or waypoints: other formats have no commands";
  }
  return "";
}

namespace {

/// Writes the route with as few decimals as keep it valid when read back; returns the text and its
/// messages.
Exported written_soundly(const Mission& mission, const ExportSource& source, const Placing& place,
                         const ExportOptions& options, MissionText text) {
  Exported result;
  std::string problem;
  for (const Decimals& decimals : kDecimals) {
    text.decimals = decimals;
    const std::string written =
        options.format ? mission_text(text)
                       : csv_text(source, place, mission.truth.frame().has_position(), decimals);
    const ImportedRoute read = read_imported_route(file_name(options.format), written,
                                                   mission.truth, mission.request.start.position);
    const std::string now = problem_of(mission, source, read.route.waypoints());
    if (now.empty()) {
      result.messages.push_back(std::to_string(source.route.size()) + " points" +
                                (options.land ? " and a landing" : "") + ", " + place.in_words() +
                                "; read back and judged: valid with " +
                                std::to_string(decimals.degrees) + " decimals of a degree and " +
                                std::to_string(decimals.metres) + " of a metre" +
                                (problem.empty() ? "" : " (with fewer: " + problem + ")"));
      result.text = written;
      return result;
    }
    problem = now;
  }
  result.messages.push_back(
      "not written: rounded to the format's precision, the route is not valid: " + problem);
  return result;
}
}  // namespace

Exported export_route(const Mission& mission, const ExportSource& wanted,
                      const ExportOptions& options) {
  expect_possible(mission, options, wanted.route.front());
  Exported result;
  ExportSource source = wanted;
  std::vector<std::string> notes;
  if (const std::string problem = problem_of(mission, source, source.route); !problem.empty()) {
    result.messages.push_back("not written: the route is not valid: " + problem);
    return result;
  }
  if (!thin(mission, source, options, notes)) {
    result.messages = std::move(notes);
    return result;
  }
  const Placing place(mission, options, source.route.front());
  if (const std::string problem = column_problem(mission, source.route, place, options);
      !problem.empty()) {
    result.messages.push_back("not written: " + problem);
    return result;
  }
  if (options.format && !home_altitude(mission, options, source.route.front())) {
    notes.emplace_back(
        "the world has no ground below the start: home is written at the start's own height "
        "(--home-altitude overrides it)");
  }
  MissionText text;
  text.speed_mps = mission.request.vehicle.speed_mps;
  if (options.format) {
    text.mission = mission_of(mission, source, place, options);
    add_zones(mission, source.route, text.mission, notes);
  }
  result = written_soundly(mission, source, place, options, std::move(text));
  if (result.text) {
    result.messages.insert(result.messages.end(), notes.begin(), notes.end());
    if (options.altitude == AltitudeFrame::ground) {
      result.messages.emplace_back(
          "warning: judged with straight legs; a vehicle that follows the ground between the "
          "points deviates from them");
    }
  }
  return result;
}
}  // namespace altiplan::host
