// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/export.hpp"

#include <algorithm>

#include "altiplan/error.hpp"
#include "host/import_export/export_notes.hpp"
#include "host/import_export/fence.hpp"
#include "host/import_export/imported_route.hpp"
#include "host/import_export/placing.hpp"
#include "host/import_export/thinning.hpp"
#include "host/import_export/written_route.hpp"
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

/// Of points that stand for turns: finer where an obstacle or the ground is too near beside them.
constexpr double kTolerances[] = {kArcTolerance, kArcTolerance / 5, kArcTolerance / 25};

/// The end point of the landing below the last point.
Vec3 landing(const Mission& mission, const Route& route, const Placing& place) {
  Vec3 down = route.back();
  down.z() = mission.truth.ground(down.x(), down.y()).value_or(place.home().altitude_m);
  return down;
}

/// The problem of the vertical climb and descent, which are not part of the route: a layer that
/// they come too near to, except the ground, where they begin and end; "" if none.
std::string column_problem(const Mission& mission, const Route& route, const Placing& place,
                           const ExportOptions& options) {
  Vec3 home = route.front();
  home.z() = place.home().altitude_m;
  const Vec3 down = landing(mission, route, place);
  for (const Layer& layer : mission.truth.layers()) {
    const auto blocked = [&](const Vec3& foot, const Vec3& top) {
      return layer.environment->ground() == nullptr &&
             layer.environment->blocked(foot, top, mission.request.vehicle.reach_m());
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

/// The mission without its items.
kit::MissionFile frame_of(const ExportSource& source, const Placing& place, Format format) {
  kit::MissionFile file;
  file.format = format;
  file.name = source.name;
  file.home = place.home();
  return file;
}

std::vector<MissionItem> items_of(const std::vector<MissionPlace>& places, const Mission& mission,
                                  const Placing& place, const ExportOptions& options) {
  std::vector<MissionItem> items;
  for (const auto& [at, circle] : places) {
    const auto kind = circle ? MissionItem::Kind::loiter : MissionItem::Kind::waypoint;
    items.push_back({kind, place(at), 0, "", circle});
  }
  if (options.takeoff) {
    if (items.front().circle) {
      throw Error("--takeoff: the route begins on a loiter circle, give --arcs points");
    }
    items.front().kind = MissionItem::Kind::takeoff;
  }
  if (options.land) {
    const Vec3 down = landing(mission, {places.back().at}, place);
    items.push_back({MissionItem::Kind::land, place(down), 0, ""});
  }
  return items;
}

std::string csv_text(const ExportSource& source, const std::vector<MissionPlace>& places,
                     const Placing& place, bool placed, const Decimals& decimals) {
  const bool timed = !source.times.empty();
  std::string out = std::string(timed ? "time_s," : "") + "x_m,y_m,z_m" +
                    (placed ? ",longitude_deg,latitude_deg" : "") + ",altitude_m,altitude_frame\n";
  for (std::size_t n = 0; n < places.size(); ++n) {
    const Vec3& p = places[n].at;
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

/// The request without what a turn satisfies and the legs between its points do not: those have
/// corners, and are a little longer.
Request beside_turns(Request request) {
  Limits& limits = request.limits;
  limits.min_turn_radius = limits.min_leg = 0;
  limits.max_turn_horizontal = limits.max_turn_space = kPi;
  limits.max_climb = kPi / 2;
  limits.max_sink.reset();
  limits.max_route_length = kInfinity;
  request.start.velocity = Vec3::Zero();
  request.goal.heading.reset();
  return request;
}

/// The request with the ends of a route that lie on its loiter circles: a file has no tangents.
Request ending_with(Request request, const Route& route) {
  if (request.start.loiter && request.start.starts_at(route.front())) {
    request.start = {0, route.front(), Vec3::Zero(), std::nullopt};
  }
  if (request.goal.loiter && request.goal.reached_at(route.back())) {
    request.goal = {route.back(), 0, std::nullopt, std::nullopt};
  }
  return request;
}

/// The first violation of the route as written and read back; "" if it is valid.
std::string problem_of(const Mission& mission, const ExportSource& source, const Route& route,
                       const Request& request) {
  CheckResult check;
  if (source.times.empty()) {
    check = judge(route, request, mission.via);
  } else {
    Track track;
    for (std::size_t n = 0; n < route.size(); ++n) {
      track.emplace_back(source.times[n], route[n]);
    }
    FlightSetup setup;
    setup.request = mission.track_request;
    setup.truth = mission.truth;
    setup.events = source.events;
    setup.telemetry = source.telemetry;
    check = judge_track(track, setup).check;
  }
  if (check.ok()) {
    return "";
  }
  const Violation& first = check.violations.front();
  return "point " + std::to_string(first.at) + ", " + first.constraint + ": " + first.message;
}

WrittenRoute places_of(const Mission& mission, const Route& route, const ExportOptions& options,
                       double tolerance = kArcTolerance) {
  return written_route(route, {options.loiters, tolerance}, mission.via, mission.request);
}

std::size_t item_count(const WrittenRoute& written, const ExportOptions& options) {
  return written.places.size() + (options.land ? 1 : 0);
}

/// Drops waypoints, and their times, to fit max_items, and reports it. False if the route cannot be
/// thinned that far.
bool thin(const Mission& mission, ExportSource& source, const ExportOptions& options,
          std::vector<std::string>& messages) {
  const std::size_t items = item_count(places_of(mission, source.route, options), options);
  if (!options.max_items || items <= *options.max_items) {
    return true;
  }
  const bool flown = !source.times.empty();
  const std::size_t count = source.route.size();
  const std::size_t most = count - std::min(count, items - *options.max_items);
  const std::vector<std::size_t> kept =
      thinned(source.route, most, flown ? mission.track_request : mission.request,
              flown ? std::vector<Goal>() : mission.via);
  ExportSource less{source.name, part_of(source.route, kept), {}, source.events, source.telemetry};
  const std::size_t left = item_count(places_of(mission, less.route, options), options);
  if (left > *options.max_items) {
    messages.push_back("not written: the route needs " + std::to_string(left) +
                       " items to stay valid, more than --max-items " +
                       std::to_string(*options.max_items));
    return false;
  }
  messages.push_back(std::to_string(count - kept.size()) + " of " + std::to_string(count) +
                     " points dropped: the route stays valid without them");
  for (const std::size_t n : kept) {
    if (flown) {
      less.times.push_back(source.times[n]);
    }
  }
  source = std::move(less);
  return true;
}

/// Adds the zones; reports it if the format cannot hold them.
void add_zones(const Mission& mission, const Route& route, kit::MissionFile& file,
               std::vector<std::string>& messages) {
  const World& world = mission.known;
  const bool flat = file.format == Format::qgc_plan;
  Fence fence = flat ? flat_fence_of(world, route.chords(kChordTolerance)) : zones_of(world);
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
  const bool has_commands = format == Format::qgc_plan || format == Format::waypoints;
  if (loiters && !has_commands) {
    return "--arcs loiter needs qgc-plan or waypoints: other formats have no commands";
  }
  if (loiters && altitude == AltitudeFrame::ground) {
    return "--arcs loiter needs --altitude sea or home: the ground below a circle has many heights";
  }
  if ((takeoff || land) && !has_commands) {
    return "--takeoff and --land need qgc-plan or waypoints: other formats have no commands";
  }
  return "";
}

namespace {

/// The route as text, in the ways that may be tried.
struct Attempt {
  const Mission& mission;
  const ExportSource& source;
  const Placing& place;
  const ExportOptions& options;
  MissionText text;  ///< without items
  WrittenRoute written;
  std::string problem;  ///< of the last one; "" before the first

  /// Writes with as few decimals as make the route, read back, satisfy the request.
  std::optional<std::string> with_decimals(const Request& request, bool without_tangents,
                                           Decimals& decimals) {
    for (const Decimals& each : kDecimals) {
      decimals = text.decimals = each;
      const std::string now = as_text();
      const ImportedRoute read =
          read_imported_route(file_name(options.format), now, mission.truth, mission.request);
      const std::string problem_now =
          problem_of(mission, source, read.route,
                     without_tangents ? ending_with(request, read.route) : request);
      if (problem_now.empty()) {
        return now;
      }
      problem = problem_now;
    }
    return std::nullopt;
  }

  std::string as_text() {
    if (!options.format) {
      const bool placed = mission.truth.frame().has_position();
      return csv_text(source, written.places, place, placed, text.decimals);
    }
    text.mission.items = items_of(written.places, mission, place, options);
    return mission_text(text);
  }

  Exported exported(std::string now, const Decimals& decimals) const {
    const std::size_t points = written.places.size() - written.loiters;
    Exported result;
    result.messages.push_back(
        std::to_string(points) + " points" +
        (written.loiters > 0 ? " and " + counted(written.loiters, "loiter") : "") +
        (options.land ? " and a landing" : "") + ", " + place.in_words() +
        "; read back and judged: valid with " + std::to_string(decimals.degrees) +
        " decimals of a degree and " + std::to_string(decimals.metres) + " of a metre" +
        (problem.empty() ? "" : " (with fewer: " + problem + ")"));
    result.text = std::move(now);
    result.mission = text;
    return result;
  }
};

/// Writes the route so that it is valid when read back; returns the text and its messages.
Exported written_soundly(const Mission& mission, const ExportSource& source, const Placing& place,
                         const ExportOptions& options, MissionText text) {
  Attempt attempt{mission, source, place, options, std::move(text), {}, ""};
  Decimals decimals;
  for (const double tolerance : kTolerances) {
    attempt.written = places_of(mission, source.route, options, tolerance);
    const WrittenRoute& written = attempt.written;
    if (options.max_items && item_count(written, options) > *options.max_items) {
      break;
    }
    std::optional<std::string> now = attempt.with_decimals(mission.request, false, decimals);
    const bool as_turns = !now && written.turns > 0;
    if (!now) {
      attempt.problem.clear();
      now = attempt.with_decimals(as_turns ? beside_turns(mission.request) : mission.request, true,
                                  decimals);
    }
    if (now) {
      Exported result = attempt.exported(std::move(*now), decimals);
      for (std::string& note :
           notes_on(written, options, tolerance, as_turns, mission.request.vehicle)) {
        result.messages.push_back(std::move(note));
      }
      return result;
    }
    if (written.turns == 0) {
      break;
    }
  }
  return {std::nullopt,
          {"not written: rounded to the format's precision, the route is not valid: " +
           attempt.problem}};
}
}  // namespace

Exported export_route(const Mission& mission, const ExportSource& wanted,
                      const ExportOptions& options) {
  expect_possible(mission, options, wanted.route.front());
  Exported result;
  ExportSource source = wanted;
  std::vector<std::string> notes;
  if (const std::string problem = problem_of(mission, source, source.route, mission.request);
      !problem.empty()) {
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
  text.is_wing = mission.request.vehicle.wing.has_value();
  if (options.format) {
    text.mission = frame_of(source, place, *options.format);
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
