// SPDX-License-Identifier: Apache-2.0
#include "route_export.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>

#include "host/autopilot/parameters.hpp"
#include "host/flight/events.hpp"
#include "host/gate/route_returns.hpp"
#include "host/import_export/plan.hpp"
#include "progress.hpp"

namespace altiplan::cli {
namespace {

const std::map<std::string, formats::AltitudeFrame>& altitudes() {
  static const std::map<std::string, formats::AltitudeFrame> kAll{
      {"sea", formats::AltitudeFrame::sea},
      {"ground", formats::AltitudeFrame::ground},
      {"home", formats::AltitudeFrame::home}};
  return kAll;
}

/// Of what flies it, as it is judged: not a copter, if that is not known.
std::optional<formats::Airframe> airframe_of(const JudgedPlan& judged) {
  std::optional<formats::Airframe> airframe = judged.gate.airframe;
  for (const formats::Autopilot autopilot : judged.report.autopilots) {
    if (!judged.mission.commands.empty() && (!airframe || *airframe == formats::Airframe::copter)) {
      airframe = autopilot.airframe;
    }
  }
  return airframe;
}

/// The accepted route or the flown track; none if the result lacks it.
std::optional<host::ExportSource> source_of(const host::StoredResult& stored, bool flight) {
  host::ExportSource source;
  if (flight) {
    if (!stored.track) {
      return std::nullopt;
    }
    source.telemetry = stored.telemetry;
    for (const auto& [time, place] : *stored.track) {
      source.times.push_back(time);
      source.route.push_back(place);
    }
    return source;
  }
  if (!stored.route) {
    return std::nullopt;
  }
  source.route = *stored.route;
  source.stops = stored.stops;
  return source;
}

}  // namespace

void say(const std::vector<std::string>& messages) {
  for (const std::string& message : messages) {
    if (log_level() != LogLevel::quiet) {
      std::cerr << "altiplan: " << message << '\n';
    }
  }
}

void add_route_export(App& command, RouteExport& route, bool takes_missions) {
  const std::string missions = takes_missions ? ", or with --terrain a mission (.plan, …)" : "";
  command.add_option("file", route.result, "result file of altiplan run (JSON)" + missions)
      ->required();
  command
      .add_option("--altitude FROM", route.altitude,
                  "altitude reference: sea, ground or home (default sea, of wpml and litchi home)")
      ->check(Check::one_of({"sea", "ground", "home"}));
  command
      .add_option("--arcs FORM", route.arcs,
                  "turns as points within 0.5 m (points, the default), or as loiters that end on "
                  "a tangent where an autopilot flies the same turn (loiter)")
      ->check(Check::one_of({"points", "loiter"}));
  command.add_flag("--takeoff", route.options.takeoff, "begin the mission with a take-off item");
  command.add_flag("--land", route.options.land,
                   "end the mission with a landing below the last waypoint");
  command
      .add_option("--home-altitude M", route.options.home_altitude_m,
                  "altitude of home above sea level (m, default: the ground below the start)")
      ->check(number_from(-1e4, 1e5));
  command
      .add_option("--max-items N", route.options.max_items,
                  "maximum number of mission items; waypoints are dropped while the route stays "
                  "valid (default: no limit)")
      ->check(Check::between(2, 1'000'000));
  add_plugin_path(command, route.overrides);
}

void expect_no_item_options(const RouteExport& route, bool has_fence) {
  const host::ExportOptions& options = route.options;
  const host::RouteFormat* format = host::format_by_extension(route.result);
  if (format != nullptr && !format->has_commands() && !route.flight && !has_fence) {
    return;
  }
  if (options.takeoff || options.land || options.home_altitude_m || options.max_items ||
      route.altitude || route.arcs != "points" || route.flight || has_fence) {
    throw UsageError{
        route.result +
        " is a mission, which has its own items: --takeoff, --land, --altitude, --arcs, "
        "--home-altitude, --max-items, --fence and --flight are for results"};
  }
}

void finish_options(RouteExport& route) {
  route.options.loiters = route.arcs == "loiter";
  route.options.altitude =
      route.altitude ? altitudes().at(*route.altitude) : route.options.format->frames.front();
  if (const std::string problem = route.options.problem(); !problem.empty()) {
    throw UsageError{problem};
  }
}

std::optional<LoadedRoute> loaded(const RouteExport& route, const std::optional<std::string>& out) {
  host::StoredResult stored = host::read_result(route.result, route.overrides);
  for (const std::string& changed : stored.changed) {
    warn(changed + " has changed since the result was written");
  }
  expect_apart(out, "-o", files_of(stored));
  std::optional<host::ExportSource> source = source_of(stored, route.flight);
  if (!source) {
    say({stored.file + " contains no " + (route.flight ? "flight" : "accepted route")});
    return std::nullopt;
  }
  host::Config config = host::load_config(stored.pipeline, stored.overrides);
  host::Mission mission =
      busy("building the world", [&] { return host::build_mission(config, 1); });
  source->name =
      config.scenario.name.empty() ? config.scenario_path.stem().string() : config.scenario.name;
  if (mission.task && !mission.ends.goal) {
    mission.request.goal.tolerance_m = 1;  // files of missions round points
  }
  host::take_open_ends(mission, source->route, mission.request);
  if (route.flight) {
    source->events = host::build_events(config, mission);
  }
  return LoadedRoute{std::move(stored), std::move(config), std::move(mission), std::move(*source)};
}

std::optional<host::Exported> exported(const LoadedRoute& loaded, const RouteExport& route) {
  host::Exported exported = busy("judging the mission", [&] {
    return host::export_route(loaded.mission, loaded.source, route.options);
  });
  say(exported.messages);
  return exported.text ? std::optional(std::move(exported)) : std::nullopt;
}

std::optional<host::Exported> exported(const RouteExport& route,
                                       const std::optional<std::string>& out) {
  const std::optional<LoadedRoute> source = loaded(route, out);
  return source ? exported(*source, route) : std::nullopt;
}

std::optional<host::Plan> fewest_plan(const LoadedRoute& loaded, const RouteExport& route,
                                      const PlanCheck& options) {
  host::GateOptions gate = options.gate;
  if (options.parameters) {
    gate.flight.parameters = host::read_parameters(*options.parameters);
  }
  const host::RouteMission made = busy("searching the fewest items", [&] {
    return host::mission_of_route(loaded.mission, loaded.source, route.options, gate);
  });
  if (!made.fewest) {
    say(made.written.messages);
    return std::nullopt;
  }
  const host::FewestItems& fewest = *made.fewest;
  const std::size_t items = fewest.plan.items.size();
  const std::string how = std::to_string(items) + " items in place of " +
                          std::to_string(host::plan_of(made.written.mission).items.size());
  if (!fewest.passed()) {
    tell_findings(route.result + ", " + how + ", flown as a plan", {{}, {}, fewest.report, {}});
    return std::nullopt;
  }
  if (route.options.max_items && items > *route.options.max_items) {
    say({"not written: " + std::to_string(items) +
         " items are the fewest found that pass, more than --max-items " +
         std::to_string(*route.options.max_items)});
    return std::nullopt;
  }
  say({how + ": pass as " + fewest.report.autopilots.front().name() + " flies them (" +
       std::to_string(fewest.judged) + " plans judged)"});
  return fewest.plan;
}

host::Exported exported_route(const JudgedPlan& judged, const RouteExport& route) {
  host::Mission world = judged.world;
  if (const auto airframe = airframe_of(judged)) {
    world.vehicle_type = *airframe == formats::Airframe::copter  ? host::VehicleType::copter
                         : *airframe == formats::Airframe::plane ? host::VehicleType::plane
                                                                 : host::VehicleType::vtol;
  }
  host::ExportSource source;
  source.name = std::filesystem::path(route.result).stem().string();
  source.route = judged.report.imported.route;
  world.request.start.position = source.route.front();
  world.request.goal = {source.route.back()};
  world.request.goal.tolerance_m = 1;
  const host::PlanReport& report = judged.report;
  const auto speed = std::find_if(report.speeds_mps.begin(), report.speeds_mps.end(),
                                  [](double speed_mps) { return speed_mps > 0; });
  if (!route.options.format->has_commands() && speed != report.speeds_mps.end()) {
    world.request.vehicle.speed_mps = *speed;
    for (std::size_t n = 0; n < source.route.size(); ++n) {
      source.timing.push_back({report.times[n].min_s, report.speeds_mps[n]});
    }
    warn("speeds and times, if written, are those of the fastest flight");
  }
  host::ExportOptions options = route.options;
  options.firmware = judged.gate.firmware.value_or(options.firmware);
  host::Exported written = host::export_route(world, source, options);
  say(written.messages);
  return written;
}

std::optional<host::Plan> plan_of_line(const JudgedPlan& judged, const RouteExport& route) {
  const host::Exported written = exported_route(judged, route);
  if (!written.text) {
    return std::nullopt;
  }
  const host::Plan plan = host::plan_of(written.mission);
  JudgedPlan flown = judged;
  flown.mission = formats::read_mission("route.plan", host::plan_text(plan));
  flown.report = busy("judging the plan", [&] {
    return host::judge_plan(route.result, flown.mission, flown.world, flown.gate);
  });
  if (!flown.report.passed()) {
    tell_findings(route.result + ", flown as a plan", flown);
    return std::nullopt;
  }
  return plan;
}

void tell_findings(const std::string& file, const JudgedPlan& judged) {
  std::cerr << "altiplan: " << file << ": " << word_of(judged.report.verdict())
            << ": not written\n";
  for (const std::string& finding : judged.findings()) {
    std::cerr << "  " << finding << '\n';
  }
}
}  // namespace altiplan::cli
