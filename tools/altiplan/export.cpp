// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <map>

#include "commands.hpp"
#include "host/base/output_file.hpp"
#include "host/flight/events.hpp"
#include "host/import_export/export.hpp"
#include "host/result/stored_result.hpp"

namespace altiplan::cli {
namespace {

using Format = kit::MissionFile::Format;

struct Arguments {
  std::string result;
  std::string to;
  std::string altitude = "sea";
  std::string arcs = "points";
  std::optional<std::string> out;
  bool flight = false;
  host::ExportOptions options;
  host::Overrides overrides;
};

const std::map<std::string, std::optional<Format>>& formats() {
  static const std::map<std::string, std::optional<Format>> kAll{
      {"qgc-plan", Format::qgc_plan}, {"waypoints", Format::waypoints},
      {"kml", Format::kml},           {"geojson", Format::geojson},
      {"gpx", Format::gpx},           {"csv", std::nullopt}};
  return kAll;
}

const std::map<std::string, kit::AltitudeFrame>& altitudes() {
  static const std::map<std::string, kit::AltitudeFrame> kAll{
      {"sea", kit::AltitudeFrame::sea},
      {"ground", kit::AltitudeFrame::ground},
      {"home", kit::AltitudeFrame::home}};
  return kAll;
}

void say(const std::string& message) {
  if (log_level() != LogLevel::quiet) {
    std::cerr << "altiplan: " << message << '\n';
  }
}

/// The accepted route or the flown track; none if the result lacks it.
std::optional<host::ExportSource> source_of(const host::StoredResult& stored, bool flight) {
  host::ExportSource source;
  if (flight) {
    if (!stored.track) {
      return std::nullopt;
    }
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
  return source;
}

int export_result(const Arguments& arguments) {
  expect_writable(arguments.out, "-o");
  const host::StoredResult stored = host::read_result(arguments.result, arguments.overrides);
  for (const std::string& changed : stored.changed) {
    warn(changed + " has changed since the result was written");
  }
  expect_apart(arguments.out, "-o", files_of(stored));
  std::optional<host::ExportSource> source = source_of(stored, arguments.flight);
  if (!source) {
    say(stored.file + " contains no " + (arguments.flight ? "flight" : "accepted route"));
    return kNoRoute;
  }
  const host::Config config = host::load_config(stored.pipeline, stored.overrides);
  const host::Mission mission = host::build_mission(config, 1);
  source->name =
      config.scenario.name.empty() ? config.scenario_path.stem().string() : config.scenario.name;
  if (arguments.flight) {
    source->events = host::build_events(config, mission);
  }
  const host::Exported exported = host::export_route(mission, *source, arguments.options);
  for (const std::string& message : exported.messages) {
    say(message);
  }
  if (!exported.text) {
    return kNoRoute;
  }
  if (arguments.out) {
    host::write_file(*arguments.out, *exported.text);
  } else {
    std::cout << *exported.text;
  }
  return kDone;
}
}  // namespace

void add_export(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("export", "write a result's route for ground control stations and maps");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("result", arguments->result, "result file of altiplan run (JSON)")
      ->required();
  command
      ->add_option("--to", arguments->to, "format: qgc-plan, waypoints, kml, geojson, gpx or csv")
      ->required()
      ->type_name("FORMAT")
      ->check(CLI::IsMember({"qgc-plan", "waypoints", "kml", "geojson", "gpx", "csv"}));
  command->add_option("-o,--out", arguments->out, "output file (default: stdout)")
      ->type_name("FILE");
  command
      ->add_option("--altitude", arguments->altitude,
                   "altitude reference: sea, ground or home (default sea)")
      ->type_name("FROM")
      ->check(CLI::IsMember({"sea", "ground", "home"}));
  command
      ->add_option("--arcs", arguments->arcs,
                   "turns as points within 0.5 m (points, the default), or as loiters that end on "
                   "a tangent where an autopilot flies the same turn (loiter)")
      ->type_name("FORM")
      ->check(CLI::IsMember({"points", "loiter"}));
  command->add_flag("--flight", arguments->flight, "export the flown track instead of the route");
  command->add_flag("--takeoff", arguments->options.takeoff,
                    "begin the mission with a take-off item");
  command->add_flag("--land", arguments->options.land,
                    "end the mission with a landing below the last waypoint");
  command
      ->add_option("--home-altitude", arguments->options.home_altitude_m,
                   "altitude of home above sea level (m, default: the ground below the start)")
      ->type_name("M")
      ->check(number_from(-1e4, 1e5));
  command
      ->add_option("--max-items", arguments->options.max_items,
                   "maximum number of mission items; waypoints are dropped while the route stays "
                   "valid (default: no limit)")
      ->type_name("N")
      ->check(CLI::Range(2, 1'000'000));
  add_plugin_path(*command, arguments->overrides);
  set_example(*command, "altiplan export result.json --to qgc-plan --takeoff --land -o ridge.plan");
  command->callback([&action, arguments] {
    arguments->options.format = formats().at(arguments->to);
    arguments->options.loiters = arguments->arcs == "loiter";
    arguments->options.altitude = altitudes().at(arguments->altitude);
    if (const std::string problem = arguments->options.problem(); !problem.empty()) {
      throw CLI::ValidationError(problem);
    }
    action = [arguments] { return export_result(*arguments); };
  });
}
}  // namespace altiplan::cli
