// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <map>

#include "commands.hpp"
#include "host/base/output_file.hpp"
#include "route_export.hpp"

namespace altiplan::cli {
namespace {

using Format = formats::MissionFile::Format;

struct ExportArguments {
  RouteExport route;
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

int export_result(const ExportArguments& arguments) {
  expect_writable(arguments.out, "-o");
  expect_writable(arguments.fence, "--fence");
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
    finish_options(arguments.route);
  };
  auto [command, arguments] = add_command<ExportArguments>(
      app, action, "export", "write a result's route for ground control stations and maps",
      export_result, prepare);
  command
      .add_option("--to FORMAT", arguments.to,
                  "format: qgc-plan, waypoints, kml, geojson, gpx or csv (default: by -o)")
      ->check(Check::one_of({"qgc-plan", "waypoints", "kml", "geojson", "gpx", "csv"}));
  command.add_option("-o,--out FILE", arguments.out, "output file (default: stdout)");
  command.add_option("--fence FILE", arguments.fence,
                     "also write the zones as a fence file for Mission Planner (QGC WPL 110)");
  add_route_export(command, arguments.route);
  command.add_flag("--flight", arguments.route.flight,
                   "export the flown track instead of the route");
  set_example(command, "altiplan export result.json --takeoff --land -o ridge.plan");
}
}  // namespace altiplan::cli
