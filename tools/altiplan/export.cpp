// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <map>

#include "commands.hpp"
#include "host/base/output_file.hpp"
#include "host/import_export/plan.hpp"
#include "host/import_export/route_csv.hpp"
#include "mission_options.hpp"
#include "route_export.hpp"

namespace altiplan::cli {
namespace {

using Format = formats::MissionFile::Format;

struct ExportArguments {
  RouteExport route;
  MissionOptions mission;
  std::optional<std::string> to;
  std::optional<std::string> out;
  std::optional<std::string> fence;
};

const std::map<std::string, std::optional<Format>>& formats() {
  static const std::map<std::string, std::optional<Format>> kAll{
      {"qgc-plan", Format::qgc_plan}, {"waypoints", Format::waypoints},
      {"kml", Format::kml},           {"geojson", Format::geojson},
      {"gpx", Format::gpx},           {"csv", std::nullopt}};
  return kAll;
}

/// The format's name: as given, or by the output file's extension.
std::string format_of(const ExportArguments& arguments) {
  if (arguments.to) {
    return *arguments.to;
  }
  static const std::map<std::string, std::string> kExtensions{
      {".plan", "qgc-plan"}, {".waypoints", "waypoints"},
      {".kml", "kml"},       {".geojson", "geojson"},
      {".gpx", "gpx"},       {".csv", "csv"}};
  const auto found =
      kExtensions.find(std::filesystem::path(arguments.out.value_or("")).extension().string());
  if (found == kExtensions.end()) {
    throw UsageError{
        "--to is required, or an output file (-o) that ends in .plan, .waypoints, .kml, .geojson, "
        ".gpx or .csv"};
  }
  return found->second;
}

/// The zones in a file of their own; false if there are none.
bool write_fence(const LoadedRoute& route, const std::string& file) {
  const host::Exported fence = host::export_fence(route.mission, route.source.route);
  for (const std::string& message : fence.messages) {
    warn(file + ": " + message);
  }
  if (fence.text) {
    host::write_file(file, *fence.text);
  }
  return fence.text.has_value();
}

/// The drawn points with the gate's times.
std::string csv_of(const JudgedPlan& judged) {
  const host::ImportedRoute& drawn = judged.report.imported;
  std::vector<host::CsvRow> rows;
  for (std::size_t n = 0; n < drawn.items.size(); ++n) {
    const host::TimeSpan& time = judged.report.times[n];
    rows.push_back({time.min_s, time.max_s, drawn.route[n], drawn.items[n].at});
  }
  return host::route_csv_text(rows, judged.world.truth.frame().has_position(), {});
}

/// Its own commands, where the format has some; else its positions. None, which is reported: the
/// mission does not pass.
std::optional<std::string> text_of_mission(const ExportArguments& arguments) {
  const std::string& file = arguments.route.result;
  JudgedPlan judged = judged_plan(arguments.mission.plan, arguments.route.overrides);
  if (!judged.report.passed()) {
    std::cerr << "altiplan: " << file << ": " << word_of(judged.report.verdict())
              << ": not written\n";
    for (const std::string& finding : judged.findings()) {
      std::cerr << "  " << finding << '\n';
    }
    return std::nullopt;
  }
  const std::optional<Format>& format = arguments.route.options.format;
  if (format == Format::qgc_plan || format == Format::waypoints) {
    const host::Plan plan = host::plan_of(judged.mission);
    if (format == Format::waypoints && !(plan.fence.empty() && plan.rally.empty())) {
      warn("QGC WPL 110 holds the mission alone: its fence and rally points are left out");
    }
    return format == Format::qgc_plan ? host::plan_text(plan) : host::waypoints_text(plan);
  }
  if (!format) {
    return csv_of(judged);
  }
  host::ExportSource source;
  source.name = std::filesystem::path(file).stem().string();
  source.route = judged.report.imported.route;
  judged.world.request.start.position = source.route.front();
  judged.world.request.goal = {source.route.back()};
  judged.world.request.goal.tolerance_m = 1;
  host::ExportOptions options = arguments.route.options;
  options.has_times = false;
  const host::Exported written = host::export_route(judged.world, source, options);
  for (const std::string& message : written.messages) {
    std::cerr << "altiplan: " << message << '\n';
  }
  return written.text;
}

int write_mission(const ExportArguments& arguments) {
  expect_apart(arguments.out, "-o", {arguments.route.result});
  const std::optional<std::string> text = text_of_mission(arguments);
  if (text && arguments.out) {
    host::write_file(*arguments.out, *text);
  } else if (text) {
    std::cout << *text;
  }
  return text ? kDone : kNoRoute;
}

int export_result(const ExportArguments& arguments) {
  expect_writable(arguments.out, "-o");
  expect_writable(arguments.fence, "--fence");
  if (is_mission(arguments.mission, arguments.route.result)) {
    return write_mission(arguments);
  }
  const std::optional<LoadedRoute> route = loaded(arguments.route, arguments.out);
  const std::optional<host::Exported> written =
      route ? exported(*route, arguments.route) : std::nullopt;
  if (!written) {
    return kNoRoute;
  }
  if (arguments.fence) {
    std::vector<std::string> others = files_of(route->stored);
    others.push_back(arguments.out.value_or(""));
    expect_apart(arguments.fence, "--fence", others);
  }
  if (arguments.out) {
    host::write_file(*arguments.out, *written->text);
  } else {
    std::cout << *written->text;
  }
  return !arguments.fence || write_fence(*route, *arguments.fence) ? kDone : kNoRoute;
}
}  // namespace

void add_export(App& app, Action& action) {
  const auto prepare = [](ExportArguments& arguments) {
    arguments.route.options.format = formats().at(format_of(arguments));
    if (is_mission(arguments.mission, arguments.route.result)) {
      expect_no_item_options(arguments.route, arguments.fence.has_value());
      arguments.mission.plan = checked_plan(arguments.mission, arguments.route.result);
    }
    finish_options(arguments.route);
  };
  auto [command, arguments] = add_command<ExportArguments>(
      app, action, "export",
      "write a result's route, or a mission, for ground control stations and maps", export_result,
      prepare);
  command
      .add_option("--to FORMAT", arguments.to,
                  "format: qgc-plan, waypoints, kml, geojson, gpx or csv (default: by -o)")
      ->check(Check::one_of({"qgc-plan", "waypoints", "kml", "geojson", "gpx", "csv"}));
  command.add_option("-o,--out FILE", arguments.out, "output file (default: stdout)");
  command.add_option("--fence FILE", arguments.fence,
                     "also write the zones as a fence file for Mission Planner (QGC WPL 110)");
  add_route_export(command, arguments.route, true);
  add_mission_options(command, arguments.mission);
  command.add_flag("--flight", arguments.route.flight,
                   "export the flown track instead of the route");
  set_example(command, "altiplan export result.json --takeoff --land -o ridge.plan");
}
}  // namespace altiplan::cli
