// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "commands.hpp"
#include "first_run.hpp"
#include "host/base/output_file.hpp"
#include "host/base/words.hpp"
#include "host/first_route/shown.hpp"
#include "host/import_export/plan.hpp"
#include "host/view/scene.hpp"
#include "host/view/viewer_page.hpp"
#include "progress.hpp"
#include "route_export.hpp"

namespace altiplan::cli {
namespace {

namespace fs = std::filesystem;

struct SurveyArguments : FirstArguments {
  std::string area;
  std::string camera;
  std::string from;
  double gsd_cm = 0;
  double overlap = 75;
  double sidelap = 70;
  double tolerance = 5;
  bool json = false;
};

/// Shares of the tolerance of scale that are tried for the drawn route: the less of it, the more is
/// left for how it is flown beside steep ground, and the more waypoints there are.
constexpr double kDrawn[] = {0.6, 0.3, 0.1};

host::RouteWish wish_of(const SurveyArguments& arguments) {
  host::RouteWish wish = wish_of_first(arguments);
  host::SurveyWish& survey = wish.survey.emplace();
  survey.file = arguments.area;
  survey.camera = host::camera_of(arguments.camera);
  survey.area = host::read_area(arguments.area);
  survey.gsd_m = arguments.gsd_cm / 100;
  survey.overlap = arguments.overlap / 100;
  survey.sidelap = arguments.sidelap / 100;
  survey.tolerance = arguments.tolerance / 100;
  survey.has_start = !arguments.from.empty();
  if (survey.has_start) {
    wish.points.push_back(point_of("--from", arguments.from));
    wish.points.front().above_ground_m.reset();
  }
  std::size_t corner = 0;
  for (const auto& [lon, lat] : survey.area.outline) {
    wish.points.push_back(
        {arguments.area + ": corner " + std::to_string(++corner), lon, lat, std::nullopt});
  }
  return wish;
}

/// What is flown, and the verdict on it.
struct Surveyed {
  host::RunResult result;
  std::vector<std::string> choices;
  std::vector<std::string> zone_layers;
  std::optional<host::PlanReport> report;  ///< none: there is no mission
  std::string voids;
  double shown = 0;  ///< share of the area
};

/// The passes along which photos are taken: those with a length.
std::vector<Polyline> lines_of(const host::RunResult& result) {
  std::vector<Polyline> lines;
  for (const Pass& pass : result.task->passes) {
    if (pass.points.size() > 1) {
      lines.push_back(pass.points);
    }
  }
  return lines;
}

/// One at each end of a line, and between.
std::size_t photos_of(const std::vector<Polyline>& lines, double trigger_m) {
  std::size_t photos = 0;
  for (const Polyline& line : lines) {
    double metres = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
      metres += (line[i] - line[i - 1]).head<2>().norm();
    }
    photos += std::size_t(std::ceil(metres / trigger_m)) + 1;
  }
  return photos;
}

/// Heights above ground on the ways between items, as they may be flown.
host::LegHeights heights_of(const host::PlanReport& report) {
  host::LegHeights all;
  for (const host::ReportedPart& part : report.parts) {
    if (part.what.empty() && part.items.size() > 1) {
      all.lowest = std::min(all.lowest, part.heights.lowest);
      all.highest = std::max(all.highest, part.heights.highest);
    }
  }
  return all;
}

/// How far a copter may be off its lines, metres (WP_RADIUS_M, and a metre for stored numbers).
constexpr double kOffLines = 3;

/// Writes the mission with its photos, and sees what these show; false where it cannot be written.
bool write_plan(const fs::path& folder, const SurveyArguments& arguments,
                const host::FirstRoute& first, Surveyed& surveyed) {
  RouteExport route;
  route.result = folder / "result.json";
  route.overrides = arguments.overrides;
  route.options.format = &host::format_named("qgc-plan");
  route.options.takeoff = route.options.land = true;
  finish_options(route);
  const std::optional<LoadedRoute> source = loaded(route, std::nullopt);
  const std::optional<host::Exported> written = source ? exported(*source, route) : std::nullopt;
  if (!written) {
    return false;
  }
  const host::CameraLines camera{lines_of(surveyed.result), first.lines().trigger_m,
                                 source->mission.request.vehicle.speed_mps};
  host::write_file(folder / "route.plan", host::plan_text(host::plan_of(written->mission, camera)));
  const host::SurveyLines& lines = first.lines();
  const double per_m = 0.5 / lines.above_ground_m;
  surveyed.shown = host::share_shown(
      first.area(),
      {camera.lines, lines.trigger_m, per_m * lines.across_m, per_m * lines.along_m, kOffLines},
      source->mission.truth);
  return true;
}

void write_page(const fs::path& folder, const SurveyArguments& arguments) {
  const host::Scene scene = busy("drawing the page", [&] {
    return host::build_scene({host::read_result(folder / "result.json", arguments.overrides)});
  });
  host::write_file(folder / "page.html", host::viewer_page(scene.json));
}

/// True where a route that is nearer to the height of the photos may pass.
bool may_be_nearer(const host::PlanReport& report) {
  return !report.passed() &&
         std::all_of(report.findings.begin(), report.findings.end(), [](const auto& finding) {
           return finding.violation.constraint == "altitude" ||
                  finding.violation.constraint == "ground_clearance";
         });
}

Surveyed fly(const SurveyArguments& arguments, const host::FirstRoute& first,
             const fs::path& folder, Interrupt& interrupt) {
  Surveyed surveyed;
  const host::FirstFiles files = first.files(0, folder);
  surveyed.choices = files.choices;
  surveyed.zone_layers = files.zone_layers;
  surveyed.result = run_in(folder, files, arguments.overrides, interrupt);
  if (!surveyed.result.accepted || interrupt.happened()) {
    return surveyed;
  }
  const Polyline& route = surveyed.result.steps[*surveyed.result.accepted].route.waypoints();
  surveyed.voids = first.over_voids(route);
  if (write_plan(folder, arguments, first, surveyed)) {
    host::GateOptions gate;
    if (const host::RouteWish& wish = arguments.wish; wish.battery_wh) {
      gate.battery = host::Battery{*wish.battery_wh, wish.reserve, *wish.power_w, *wish.power_w};
    }
    surveyed.report = judged(folder / "route.plan", first, arguments.overrides, gate);
  }
  return surveyed;
}

/// So many at least: each also flies out and back.
int flights_of(const host::EnergyUse& energy) {
  return int(std::ceil(energy.max_wh / energy.battery.usable_wh()));
}

host::Json json_of(const Surveyed& surveyed, const host::FirstRoute& first,
                   const host::Camera& camera, const fs::path& folder) {
  const host::PlanReport& report = surveyed.report.value();
  const host::LegHeights heights = heights_of(report);
  const std::vector<Polyline> lines = lines_of(surveyed.result);
  host::Json findings = host::Json::array();
  for (const host::Finding& finding : report.findings) {
    findings.push_back(finding.items.back() + ": " + finding.violation.message);
  }
  return {{"plan", (folder / "route.plan").string()},
          {"verdict", word_of(report.verdict())},
          {"findings", findings},
          {"area_m2", first.area_m2()},
          {"above_ground_m", first.lines().above_ground_m},
          {"spacing_m", first.lines().spacing_m},
          {"trigger_m", first.lines().trigger_m},
          {"coverage", surveyed.shown},
          {"lines", lines.size()},
          {"images", photos_of(lines, first.lines().trigger_m)},
          {"gsd_cm", {100 * camera.gsd_m(heights.lowest), 100 * camera.gsd_m(heights.highest)}},
          {"flights", report.energy ? host::Json(flights_of(*report.energy)) : host::Json()},
          {"time_s", {report.time.min_s, report.time.max_s}},
          {"metrics", host::to_json(report.measures)}};
}

void print(const Surveyed& surveyed, const host::FirstRoute& first, const host::Camera& camera) {
  const host::PlanReport& report = surveyed.report.value();
  const host::LegHeights heights = heights_of(report);
  const std::vector<Polyline> lines = lines_of(surveyed.result);
  std::printf(
      "survey: %s ha, the camera on along %zu stretches, %zu photos, %s to %s cm a pixel below it, "
      "%s %% shown for certain\n",
      host::with_digits(first.area_m2() / 1e4, 4).c_str(), lines.size(),
      photos_of(lines, first.lines().trigger_m),
      fixed(100 * camera.gsd_m(heights.lowest), 3).c_str(),
      fixed(100 * camera.gsd_m(heights.highest), 3).c_str(),
      fixed(100 * surveyed.shown, 2).c_str());
  if (report.energy) {
    std::printf("energy: %s: %s or more\n", report.energy->in_words().c_str(),
                host::counted(std::size_t(flights_of(*report.energy)), "flight").c_str());
  }
}

int survey(const SurveyArguments& arguments) {
  std::optional<Activity> activity("reading the model");
  host::RouteWish wish = wish_of(arguments);
  std::optional<host::FirstRoute> first(std::in_place, wish, arguments.overrides.plugin_path);
  const fs::path folder = new_folder(arguments, arguments.area);
  static_cast<void>(first->files(0, folder));  // nothing is written if that throws
  activity.reset();
  const std::unique_ptr<host::Unfinished> unfinished = created(folder);
  Interrupt interrupt;
  Surveyed surveyed;
  for (const double share : kDrawn) {
    wish.survey->drawn = share;
    first.emplace(wish, arguments.overrides.plugin_path);
    surveyed = fly(arguments, *first, folder, interrupt);
    if (interrupt.happened() || !surveyed.report || !may_be_nearer(*surveyed.report)) {
      break;
    }
  }
  interrupt.finish();
  if (interrupt.happened()) {
    return kInterrupted;
  }
  for (std::size_t n = 0; n < surveyed.choices.size() && !arguments.json; ++n) {
    std::printf("%s\n", surveyed.choices[n].c_str());
  }
  if (!arguments.json) {
    print_zones(surveyed.result, surveyed.zone_layers);
  }
  print_remarks(surveyed.result);
  if (!surveyed.voids.empty()) {
    warn(surveyed.voids);
  }
  unfinished->is_finished();
  if (!surveyed.result.accepted) {
    std::printf("no route: %s; %s/ holds scenario.yaml, pipeline.yaml and result.json\n",
                surveyed.result.message.c_str(), folder.c_str());
    return surveyed.result.exit_code();
  }
  write_page(folder, arguments);
  if (!surveyed.report) {
    return kNoRoute;
  }
  const host::Camera& camera = wish.survey->camera;
  if (arguments.json) {
    std::cout << host::file_text(json_of(surveyed, *first, camera, folder));
  } else {
    print(surveyed, *first, camera);
    std::printf("written: %s/: page.html, route.plan, result.json, scenario.yaml, pipeline.yaml\n",
                folder.c_str());
    print_check(*surveyed.report);
  }
  return surveyed.report->passed() ? kDone : kNoRoute;
}
}  // namespace

void add_survey(App& app, Action& action) {
  auto [command, arguments] = add_command<SurveyArguments>(
      app, action, "survey", "photos of an area from above, without YAML", survey);
  command
      .add_option("area FILE", arguments.area, "one polygon, which may have holes (KML, GeoJSON)")
      ->required();
  add_terrain(command, arguments);
  command
      .add_option("--camera NAME", arguments.camera,
                  "a camera that looks straight down, or a .yaml file with sensor_mm, image_px and "
                  "focal_mm")
      ->required();
  command.add_option("--gsd-cm CM", arguments.gsd_cm, "what a pixel of a photo shows")
      ->required()
      ->check(number_from(0.01, 1000));
  const auto percent = [&, &survey_command = command](const char* name, double& value, double low,
                                                      double high, const char* what) {
    survey_command.add_option(std::string(name) + " PERCENT", value, what)
        ->check(number_from(low, high));
  };
  percent("--overlap", arguments.overlap, 0, 95,
          "of a photo that the next one shows, too (default 75)");
  percent("--sidelap", arguments.sidelap, 0, 95,
          "of a photo that one of the next line shows, too (default 70)");
  percent("--scale-tolerance", arguments.tolerance, 0.5, 50,
          "by which the scale may be off below the camera (default 5)");
  command
      .add_option("--from LON,LAT", arguments.from,
                  "place of take-off and landing (default: the beginning of the first line)")
      ->check(point_problem);
  add_first_options(command, arguments, "the area's name");
  command.add_flag("--json", arguments.json, "print the figures as JSON");
  add_plugin_path(command, arguments.overrides);
  set_example(command,
              "altiplan survey field.kml --terrain configs/data/jacksboro_fault.tif "
              "--camera sony_a6000_16mm --gsd-cm 2");
}
}  // namespace altiplan::cli
