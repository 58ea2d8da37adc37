// SPDX-License-Identifier: Apache-2.0
#include "host/import_export/export.hpp"

#include <algorithm>

#include "altiplan/check.hpp"
#include "altiplan/error.hpp"
#include "altiplan/kit/layers/hours.hpp"
#include "host/base/words.hpp"
#include "host/import_export/export_attempt.hpp"
#include "host/import_export/fence.hpp"
#include "host/import_export/placing.hpp"
#include "host/import_export/thinning.hpp"
#include "host/judge/judge.hpp"

namespace altiplan::host {
namespace {

using formats::AltitudeFrame;
using Zones = RouteFormat::Zones;

/// The problem of the vertical climb and descent of what can hover, which are not part of the
/// route: a layer that they come too near to, except the ground, where they begin and end; "" if
/// none.
std::string column_problem(const Mission& mission, const ExportSource& source, const Placing& place,
                           const ExportOptions& options) {
  const Route& route = source.route;
  Vec3 home = route.front();
  home.z() = place.home().altitude_m;
  const Vec3 down = landing(mission, route, place);
  for (const Layer& layer : mission.truth.layers()) {
    const auto blocked = [&](const Vec3& foot, const Vec3& top) {
      return layer.environment->ground() == nullptr &&
             layer.environment->blocked(foot, top, mission.request.vehicle.reach_m());
    };
    if (options.takeoff && mission.vehicle_type != VehicleType::plane &&
        blocked(home, route.front())) {
      return "the climb from home to the start passes too close to '" + layer.id + "'";
    }
    if (options.land && !mission.runways.glides_from && blocked(down, route.back())) {
      return "the descent from the last point passes too close to '" + layer.id + "'";
    }
    for (const auto& [at, stop] : source.stops) {
      if (stop.lands && blocked(landing(mission, {at}, place), at)) {
        return "the landing at the stop " + host::place(at) + " passes too close to '" + layer.id +
               "'";
      }
    }
  }
  return "";
}

/// "the route waits 12.5 s at point 3"; "" if it does not wait.
std::string first_wait(const Route& route) {
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    if (const Leg leg = route.leg(i); leg.waits()) {
      return "the route waits " + with_decimals(leg.hold_s, 1) + " s at point " + std::to_string(i);
    }
  }
  return "";
}

/// What autopilots make of the stops that do more than wait.
void note_stops(const std::vector<PlacedStop>& stops, std::vector<std::string>& notes) {
  std::size_t landings = 0;
  std::size_t drops = 0;
  double longest_s = 0;
  for (const auto& [at, stop] : stops) {
    landings += stop.lands ? 1 : 0;
    drops += stop.drops ? 1 : 0;
    longest_s = std::max(longest_s, stop.lands ? stop.hold_s : 0);
  }
  if (drops > 0) {
    notes.push_back(counted(drops, "drop") + " written as DO_GRIPPER, release");
  }
  if (landings > 0) {
    notes.push_back("warning: lands and takes off again at " + counted(landings, "stop") +
                    ": ArduPilot's copter does so with MIS_OPTIONS 4 alone" +
                    (longest_s > 0 ? ", and waits for " + with_digits(longest_s, 4) +
                                         " s on the ground with DISARM_DELAY 0 or above that"
                                   : "") +
                    "; else, and with PX4, the flight may end there");
  }
}

/// The mission without its items.
formats::MissionFile frame_of(const ExportSource& source, const Placing& place) {
  formats::MissionFile file;
  file.name = source.name;
  file.home = place.home();
  return file;
}

/// The items that PX4 stores (NUM_MISSIONS_SUPPORTED); ArduPilot without an SD card about 700.
constexpr std::size_t kStoredItems = 500;

/// Drops waypoints, and their times, to fit max_items, and reports it. False if the route cannot be
/// thinned that far.
bool thin(const Mission& mission, ExportSource& source, const ExportOptions& options,
          std::vector<std::string>& messages) {
  const std::size_t items = options.max_items ? item_count(source, mission, options) : 0;
  if (!options.max_items || items <= *options.max_items) {
    return true;
  }
  const bool flown = !source.times.empty();
  if (mission.task && !flown) {
    messages.push_back("not written: the route needs " + std::to_string(items) +
                       " items, more than --max-items " + std::to_string(*options.max_items) +
                       ": a task's passes are flown as they are");
    return false;
  }
  const std::size_t count = source.route.size();
  const std::size_t max_points = count - std::min(count, items - *options.max_items);
  const std::vector<std::size_t> kept = thinned(
      source.route, max_points, flown ? mission.track_request : mission.request, source.via);
  ExportSource less{source.name, part_of(source.route, kept), {}, source.events, source.telemetry};
  for (const std::size_t n : kept) {
    if (flown) {
      less.times.push_back(source.times[n]);
    }
    if (!source.timing.empty()) {
      less.timing.push_back(source.timing[n]);
    }
  }
  for (const std::size_t n : source.via) {
    const auto found = std::lower_bound(kept.begin(), kept.end(), n);
    less.via.push_back(std::size_t(found - kept.begin()));
  }
  const std::size_t left = item_count(less, mission, options);
  if (left > *options.max_items) {
    messages.push_back("not written: the route needs " + std::to_string(left) +
                       " items to stay valid, more than --max-items " +
                       std::to_string(*options.max_items));
    return false;
  }
  messages.push_back(std::to_string(count - kept.size()) + " of " + std::to_string(count) +
                     " points dropped: the route stays valid without them");
  source = std::move(less);
  return true;
}

/// Adds the zones; reports it if the format cannot hold them.
void add_zones(const Mission& mission, const Route& route, const RouteFormat& format,
               formats::MissionFile& file, std::vector<std::string>& messages) {
  const World& world = mission.known;
  const bool flat = format.zones == Zones::fence;
  Fence fence = flat ? flat_fence_of(world, route.chords(kChordTolerance), mission.vehicle_type)
                     : zones_of(world);
  messages.insert(messages.end(), fence.notes.begin(), fence.notes.end());
  if (fence.zones.empty()) {
    return;
  }
  const std::string count = counted(fence.zones.size(), "zone") + " ";
  if (format.zones == Zones::none) {
    messages.push_back(count + "are not written: the format cannot hold them beside a route");
    return;
  }
  messages.push_back(count + (flat ? "written as the fence" : "written"));
  file.zones = std::move(fence.zones);
}

void warn_of_many_items(const ExportSource& source, const Mission& mission,
                        const ExportOptions& options, std::vector<std::string>& messages) {
  const std::size_t items =
      options.format->has_commands() ? item_count(source, mission, options) : 0;
  if (items > kStoredItems) {
    messages.push_back("warning: " + std::to_string(items) +
                       " items: PX4 stores 500, ArduPilot about 700 without an SD card; altiplan "
                       "export --max-items N drops points that the route can do without");
  }
}

const char* above(AltitudeFrame frame) {
  return frame == AltitudeFrame::sea      ? "sea level"
         : frame == AltitudeFrame::ground ? "ground"
                                          : "the place of take-off";
}
}  // namespace

std::string ExportOptions::problem() const {
  const std::vector<AltitudeFrame>& frames = format->frames;
  if (std::find(frames.begin(), frames.end(), altitude) == frames.end()) {
    std::string heights;
    std::string words;
    for (const AltitudeFrame frame : frames) {
      const bool is_last = frame == frames.back();
      heights += (heights.empty() ? "" : is_last ? " or " : ", ") + std::string(above(frame));
      words += (words.empty() ? "" : is_last ? " or " : ", ") + std::string(name(frame));
    }
    return std::string(format->name) + " only has heights above " + heights + ": give --altitude " +
           words;
  }
  if (loiters && !format->has_commands()) {
    return "--arcs loiter needs qgc-plan or waypoints: other formats have no commands";
  }
  if (loiters && altitude == AltitudeFrame::ground) {
    return "--arcs loiter needs --altitude sea or home: the ground below a circle has many heights";
  }
  if ((takeoff || land) && !format->has_commands()) {
    return "--takeoff and --land need qgc-plan or waypoints: other formats have no commands";
  }
  return "";
}

Exported export_route(const Mission& mission, const ExportSource& wanted,
                      const ExportOptions& options) {
  expect_possible(mission, options, wanted.route.front());
  Exported result;
  ExportSource source = wanted;
  std::vector<std::string> notes;
  if (const std::string problem =
          problem_of(mission, source, source.route, mission.request, mission.via);
      !problem.empty()) {
    result.messages.push_back("not written: the route is not valid: " + problem);
    return result;
  }
  if (const std::string wait = first_wait(source.route); !wait.empty()) {
    if (!options.format->has_commands() || options.max_items) {
      result.messages.push_back("not written: " + wait + ", which " +
                                (options.max_items
                                     ? "--max-items does not keep"
                                     : "the format cannot say: use qgc-plan or waypoints"));
      return result;
    }
    notes.emplace_back(
        "waits written as hold times of waypoints, in whole seconds, as ArduPilot knows no others, "
        "and judged so");
  }
  note_stops(source.stops, notes);
  if (source.times.empty()) {
    source.via = via_indices(source.route, mission.via);
  }
  if (!thin(mission, source, options, notes)) {
    result.messages = std::move(notes);
    return result;
  }
  const Placing place(mission, options, source.route.front());
  if (const std::string problem = column_problem(mission, source, place, options);
      !problem.empty()) {
    result.messages.push_back("not written: " + problem);
    return result;
  }
  if (options.takeoff && mission.vehicle_type == VehicleType::plane && !mission.runways.climbs_to) {
    notes.emplace_back(
        "warning: an aeroplane climbs to the start from its runway, in a straight line: that climb "
        "is not judged here; altiplan check judges it from home");
  }
  if (avoids_moving(mission.request) || kit::has_hours(*mission.request.world)) {
    notes.emplace_back(
        "warning: what moves or is closed at times was judged for a route that leaves its first "
        "point at the "
        "scenario's start");
  }
  if (!options.format->is_local() && !home_altitude(mission, options, source.route.front())) {
    notes.emplace_back(
        "the world has no ground below the start: home is written at the start's own height "
        "(--home-altitude overrides it)");
  }
  MissionText text;
  text.speed_mps = mission.request.vehicle.speed_mps;
  text.vehicle = mission.vehicle_type;
  text.firmware = options.firmware;
  text.commanded_mps = options.commanded_mps;
  if (const auto& wing = mission.request.vehicle.wing) {
    text.climb_deg = degrees(wing->climb);
  }
  if (mission.site.has_start_time) {
    text.start_time_s = mission.site.start_time_s;
  }
  text.has_position = mission.truth.frame().has_position();
  text.mission = frame_of(source, place);
  if (!options.format->is_local()) {
    add_zones(mission, source.route, *options.format, text.mission, notes);
  }
  result = written_soundly(mission, source, place, options, std::move(text));
  if (result.text) {
    if (options.format->is_copters && mission.vehicle_type != VehicleType::copter) {
      notes.insert(notes.begin(), "warning: what flies " + std::string(options.format->name) +
                                      " are copters, no aeroplanes");
    }
    if (options.format->notes != nullptr) {
      const std::vector<std::string> own = options.format->notes(result.mission);
      notes.insert(notes.begin(), own.begin(), own.end());
    }
    warn_of_many_items(source, mission, options, notes);
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
