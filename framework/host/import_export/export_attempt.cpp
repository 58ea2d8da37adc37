// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/export_attempt.hpp"

#include <cmath>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"
#include "host/import_export/export_notes.hpp"
#include "host/import_export/imported_route.hpp"
#include "host/judge/judge.hpp"

namespace altiplan::host {
namespace {

using formats::MissionItem;

/// The first suits autopilots, which store degrees to seven decimals (1 cm); the last matches the
/// judge's tolerance.
constexpr Decimals kDecimals[] = {{7, 3}, {9, 5}, {13, 8}};

/// Of points that stand for turns: finer where an obstacle or the ground is too near beside them.
constexpr double kTolerances[] = {kArcTolerance, kArcTolerance / 5, kArcTolerance / 25};

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
}  // namespace

std::vector<formats::MissionItem> items_of(const std::vector<MissionPlace>& places,
                                           const Mission& mission, const Placing& place,
                                           const ExportOptions& options,
                                           const std::vector<PlaceTiming>& timing) {
  std::vector<MissionItem> items;
  for (const MissionPlace& each : places) {
    const auto kind = each.circle ? MissionItem::Kind::loiter : MissionItem::Kind::waypoint;
    items.push_back({kind, place(each.at), 0, "", each.circle});
  }
  const bool has_runways = mission.runways.has_any() && options.format->has_commands();
  const bool is_vtol = mission.vehicle_type == VehicleType::vtol;
  if (options.takeoff || (has_runways && mission.runways.climbs_to)) {
    if (items.front().circle) {
      throw Error("--takeoff: the route begins on a loiter circle, give --arcs points");
    }
    items.front().kind = MissionItem::Kind::takeoff;
  }
  if (has_runways && mission.runways.climbs_to) {  // on its line, at the height of its end
    const Vec3 end = *mission.runways.climbs_to;
    const Vec3 middle = (places.front().at + end) / 2;
    items.front().at = place({middle.x(), middle.y(), end.z()});
  }
  if (is_vtol && items.front().kind == MissionItem::Kind::takeoff) {
    // ArduPilot's climbs by the number, whatever its frame.
    formats::MissionPoint& at = items.front().at;
    at.altitude_m = places.front().at.z() - place.home().altitude_m;
    at.frame = formats::AltitudeFrame::home;
  }
  if (has_runways && mission.runways.glides_from) {
    items.back().kind = MissionItem::Kind::land;
    items.back().at =
        place(is_vtol ? landing(mission, {places.back().at}, place) : places.back().at);
  } else if (options.land) {
    const Vec3 down = landing(mission, {places.back().at}, place);
    items.push_back({MissionItem::Kind::land, place(down), 0, ""});
  } else if (options.circles_at_end && places.back().hold_s == 0 && !items.back().circle) {
    items.back().kind = MissionItem::Kind::loiter;
  }
  for (std::size_t n = 0; n < timing.size(); ++n) {
    items[n].speed_mps = timing[n].speed_mps;
  }
  return items;
}

Vec3 landing(const Mission& mission, const Route& route, const Placing& place) {
  Vec3 down = route.back();
  down.z() = mission.truth.ground(down.x(), down.y()).value_or(place.home().altitude_m);
  return down;
}

bool tell_stops(const std::vector<MissionPlace>& places, const std::vector<PlacedStop>& stops,
                const Mission& mission, const Placing& place, MissionText& text) {
  std::size_t told = 0;
  for (std::size_t n = 0; n < places.size() && told < stops.size(); ++n) {
    const auto& [at, stop] = stops[told];
    if (places[n].hold_s > 0 && (places[n].at - at).norm() <= kLengthTolerance) {
      const double ground_m = stop.lands ? place(landing(mission, {at}, place)).altitude_m : 0;
      text.stops[n] = {stop, rounded(ground_m, text.decimals.metres)};
      ++told;
    }
  }
  return told == stops.size();
}

std::string problem_of(const Mission& mission, const ExportSource& source, const Route& route,
                       const Request& request, const std::vector<Goal>& via) {
  CheckResult check;
  if (source.times.empty()) {
    check = judge(route, request, via, mission.runways);
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

namespace {

WrittenRoute places_of(const Mission& mission, const ExportSource& source,
                       const ExportOptions& options, double tolerance) {
  WrittenRoute written =
      written_route(source.route, {options.loiters, tolerance}, source.via, mission.request);
  std::vector<MissionPlace>& places = written.places;
  if (options.takeoff && places.front().hold_s > 0) {  // it waits after its take-off
    places.insert(places.begin(), {places.front().at});
  }
  return written;
}

/// Of a flight, its own times; its speeds are what the vehicle made of them. Of an autopilot's, its
/// own too: between waypoints in proportion, and the speed of the leg in the middle of the way.
std::vector<PlaceTiming> timing_of(const WrittenRoute& written, const Mission& mission,
                                   const ExportSource& source) {
  std::vector<PlaceTiming> timing;
  double before = 0;
  for (const MissionPlace& place : written.places) {
    if (!source.timing.empty()) {
      const double from_s = source.timing[std::size_t(place.along)].time_s;
      const double to_s = source.timing[std::size_t(std::ceil(place.along))].time_s;
      const double share = place.along - std::floor(place.along);
      const auto leg_end = std::size_t(std::ceil((before + place.along) / 2));
      timing.push_back({from_s + share * (to_s - from_s), source.timing[leg_end].speed_mps});
      before = place.along;
    }
  }
  for (const double time_s : source.times) {
    timing.push_back({time_s});
  }
  return timing.empty() ? timing_of(written.places, mission) : timing;
}

std::size_t item_count(const WrittenRoute& written, const std::vector<PlaceTiming>& timing,
                       const Mission& mission, const ExportOptions& options) {
  return written.places.size() + speed_changes(timing, mission.request.vehicle.speed_mps) +
         (options.land && !mission.runways.glides_from ? 1 : 0);
}

}  // namespace

std::size_t item_count(const ExportSource& source, const Mission& mission,
                       const ExportOptions& options) {
  const WrittenRoute written = places_of(mission, source, options, kArcTolerance);
  return item_count(written, timing_of(written, mission, source), mission, options);
}

namespace {

/// The route of a file with the waits of its waypoints, which reading a mission leaves out; none
/// where it is not clear which wait.
Route with_waits(const Route& route, const formats::MissionFile& file) {
  std::vector<double> holds_s;
  for (const formats::MissionCommand& command : file.commands) {
    if (command.number == Command::kWaypoint) {
      holds_s.push_back(command.params[0]);
    } else if (command.number != Command::kChangeSpeed && command.number != Command::kLand &&
               command.number != Command::kVtolLand) {
      holds_s.push_back(0);
    }
  }
  if (holds_s.size() != route.size()) {
    return {};
  }
  Route waiting{route.front()};
  for (std::size_t i = 0; i < route.size(); ++i) {
    if (i > 0) {
      waiting.push_back(route.leg(i - 1));
    }
    if (holds_s[i] > 0) {
      waiting.push_back(Leg::hold(route[i], holds_s[i]));
    }
  }
  return waiting;
}

/// A take-off item stands on the way to the end of the climb; a VTOL's landing below the end.
Route along_runways(const Route& read, const Route& own, const Mission& mission) {
  const Runways& runways = mission.runways;
  const bool sinks = runways.glides_from && mission.vehicle_type == VehicleType::vtol;
  Route whole{runways.climbs_to ? own.front() : read.front()};
  for (std::size_t n = 0; n < read.leg_count(); ++n) {
    const bool is_end = (n == 0 && runways.climbs_to) || (n + 1 == read.leg_count() && sinks);
    const Vec3& to = n + 1 == read.leg_count() && sinks ? own.back() : read[n + 1];
    whole.push_back(is_end ? Leg::straight(whole.back(), to) : read.leg(n));
  }
  return whole;
}

std::vector<Goal> without_headings(std::vector<Goal> via) {
  for (Goal& each : via) {
    each.heading.reset();
  }
  return via;
}

/// The route as text, in the ways that may be tried.
struct Attempt {
  const Mission& mission;
  const ExportSource& source;
  const Placing& place;
  const ExportOptions& options;
  MissionText text;  ///< without items
  WrittenRoute written;
  std::vector<PlaceTiming> timing;  ///< one per place of that
  std::string problem;              ///< of the last one; "" before the first

  /// Writes with as few decimals as make the route, read back, satisfy the request.
  std::optional<std::string> with_decimals(const Request& request, bool without_tangents,
                                           Decimals& decimals) {
    for (const Decimals& each : kDecimals) {
      decimals = text.decimals = each;
      const std::string now = as_text();
      const std::string name = std::string("route") + options.format->extension;
      ImportedRoute read =
          read_imported_route(name, now, mission.truth, mission.request, place.home());
      if (source.route.waits()) {
        read.route = with_waits(read.route, read_mission_file(name, now));
      }
      if (mission.runways.has_any() && options.format->has_commands()) {
        read.route = along_runways(read.route, source.route, mission);
      }
      const std::string problem_now =
          problem_of(mission, source, read.route,
                     without_tangents ? ending_with(request, read.route) : request,
                     without_tangents ? without_headings(mission.via) : mission.via);
      if (problem_now.empty()) {
        return now;
      }
      problem = problem_now;
    }
    return std::nullopt;
  }

  std::string as_text() {
    text.mission.items = items_of(written.places, mission, place, options, timing);
    text.landing_start = options.landing_start && mission.runways.glides_from;
    text.local.clear();
    text.holds_s.clear();
    for (const MissionPlace& each : written.places) {
      text.local.push_back(each.at);
      text.holds_s.push_back(std::ceil(each.hold_s));
    }
    return options.format->write(text);
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

}  // namespace

Exported written_soundly(const Mission& mission, const ExportSource& source, const Placing& place,
                         const ExportOptions& options, MissionText text) {
  Attempt attempt{mission, source, place, options, std::move(text), {}, {}, ""};
  Decimals decimals;
  for (const double tolerance : kTolerances) {
    attempt.written = places_of(mission, source, options, tolerance);
    const WrittenRoute& written = attempt.written;
    attempt.timing = timing_of(written, mission, source);
    if (options.max_items &&
        item_count(written, attempt.timing, mission, options) > *options.max_items) {
      break;
    }
    attempt.text.times_s.clear();
    for (const PlaceTiming& each : attempt.timing) {
      attempt.text.times_s.push_back(each.time_s);
    }
    std::optional<std::string> now = attempt.with_decimals(mission.request, false, decimals);
    const bool as_turns = !now && written.turns > 0;
    if (!now) {
      attempt.problem.clear();
      now = attempt.with_decimals(as_turns ? beside_turns(mission.request) : mission.request, true,
                                  decimals);
    }
    if (now && !source.stops.empty()) {
      if (!tell_stops(written.places, source.stops, mission, place, attempt.text)) {
        return {std::nullopt, {"not written: the route does not wait at each stop of its task"}};
      }
      now = options.format->write(attempt.text);
    }
    if (now) {
      Exported result = attempt.exported(std::move(*now), decimals);
      for (std::string& note : notes_on(written, options, tolerance, as_turns, mission)) {
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
}  // namespace altiplan::host
