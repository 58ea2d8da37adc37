// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "commands.hpp"
#include "host/base/output_file.hpp"
#include "host/base/words.hpp"
#include "host/view/scene.hpp"
#include "host/view/viewer_page.hpp"
#include "mission_options.hpp"
#include "progress.hpp"
#include "survey_flights.hpp"
#include "survey_item.hpp"

namespace altiplan::cli {
namespace {

namespace fs = std::filesystem;

host::RouteWish wish_of(const SurveyArguments& arguments) {
  host::RouteWish wish = wish_of_first(arguments);
  host::SurveyWish& survey = wish.survey.emplace();
  survey.file = arguments.area;
  survey.camera = host::camera_of(arguments.camera);
  host::read_places(survey);
  survey.gsd_m =
      arguments.gsd_cm ? *arguments.gsd_cm / 100 : survey.camera.gsd_m(arguments.agl_m.value());
  survey.overlap = arguments.overlap / 100;
  survey.sidelap = arguments.sidelap / 100;
  survey.tolerance = arguments.tolerance / 100;
  survey.offsets_m = arguments.offsets;
  survey.width_m = arguments.width_m;
  if (survey.line.empty() && (!arguments.offsets.empty() || arguments.width_m > 0)) {
    throw Error("--offset, --width: " + arguments.area + " has areas, not a line");
  }
  survey.has_start = !arguments.from.empty();
  if (survey.has_start) {
    wish.points.push_back(point_of("--from", arguments.from));
    wish.points.front().above_ground_m.reset();
  }
  const auto add_corners = [&](const std::string& of, const formats::Ring& ring) {
    std::size_t corner = 0;
    for (const auto& [lon, lat] : ring) {
      wish.points.push_back({of + "corner " + std::to_string(++corner), lon, lat, std::nullopt});
    }
  };
  for (const host::SurveyArea& area : survey.areas) {
    const bool is_one = survey.areas.size() == 1;
    add_corners(arguments.area + ": " + (is_one ? "" : "'" + area.name + "', "),
                area.polygon.outline);
  }
  add_corners(arguments.area + ": ", survey.line);
  return wish;
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

/// Heights above ground, as they may be flown.
host::LegHeights heights_of(const std::vector<Flight>& flights) {
  host::LegHeights all;
  for (const Flight& flight : flights) {
    all.lowest = std::min(all.lowest, flight.heights.lowest);
    all.highest = std::max(all.highest, flight.heights.highest);
  }
  return all;
}

/// Of the route as it is drawn, in the wind that was given.
double planned_s(const Surveyed& surveyed) {
  const host::RunResult& result = surveyed.result;
  return result.steps[*result.accepted].measures->time_s.value_or(0);
}

void write_page(const fs::path& folder, const SurveyArguments& arguments) {
  const host::Scene scene = busy("drawing the page", [&] {
    return host::build_scene({host::read_result(folder / "result.json", arguments.overrides)});
  });
  host::write_file(folder / "page.html", host::viewer_page(scene.json));
}

host::Json json_of(const Surveyed& surveyed, const host::FirstRoute& first,
                   const host::Camera& camera, const fs::path& folder, const std::string& item) {
  const host::LegHeights heights = heights_of(surveyed.flights);
  const std::vector<Polyline> lines = surveyed.lines();
  host::Json flights = host::Json::array();
  for (const Flight& flight : surveyed.flights) {
    const host::PlanReport& report = flight.report;
    host::Json findings = host::Json::array();
    for (const host::Finding& finding : report.findings) {
      findings.push_back(finding.items.back() + ": " + finding.violation.message);
    }
    flights.push_back({{"plan", (folder / flight.file).string()},
                       {"verdict", word_of(report.verdict())},
                       {"findings", findings},
                       {"time_s", {report.time.min_s, report.time.max_s}},
                       {"max_wh", report.energy ? host::Json(report.energy->max_wh) : host::Json()},
                       {"metrics", host::to_json(report.measures)}});
  }
  return {{"verdict", surveyed.passed() ? "pass" : "fail"},
          {"too_long", surveyed.too_long},
          {"area_m2", first.area_m2()},
          {"above_ground_m", first.lines().above_ground_m},
          {"spacing_m", first.lines().spacing_m},
          {"trigger_m", first.lines().trigger_m},
          {"coverage", first.areas().empty() ? host::Json() : host::Json(surveyed.shown)},
          {"planned_s", planned_s(surveyed)},
          {"lines", lines.size()},
          {"images", photos_of(lines, first.lines().trigger_m)},
          {"gsd_cm", {100 * camera.gsd_m(heights.lowest), 100 * camera.gsd_m(heights.highest)}},
          {"flights", flights},
          {"survey_item", item}};
}

void print(const Surveyed& surveyed, const host::FirstRoute& first, const host::Camera& camera,
           bool has_wind) {
  const host::LegHeights heights = heights_of(surveyed.flights);
  const std::vector<Polyline> lines = surveyed.lines();
  const bool has_area = !first.areas().empty();
  std::printf(
      "survey: %sthe camera on along %zu stretches, %zu photos, %s to %s cm a pixel below it%s%s\n",
      has_area ? (host::with_digits(first.area_m2() / 1e4, 4) + " ha, ").c_str() : "", lines.size(),
      photos_of(lines, first.lines().trigger_m),
      fixed(100 * camera.gsd_m(heights.lowest), 3).c_str(),
      fixed(100 * camera.gsd_m(heights.highest), 3).c_str(),
      has_area ? (", " + fixed(100 * surveyed.shown, 2) + " % shown for certain").c_str() : "",
      !has_wind ? "" : (", " + fixed(planned_s(surveyed) / 60, 1) + " min in that wind").c_str());
}

/// The verdicts on the flights.
void print_checks(const Surveyed& surveyed) {
  for (const Flight& flight : surveyed.flights) {
    if (surveyed.flights.size() > 1) {
      std::printf("%s: ", flight.file.c_str());
    }
    print_check(flight.report);
    if (flight.report.energy) {
      std::printf("  energy: %s\n", flight.report.energy->in_words().c_str());
    }
  }
  if (!surveyed.too_long.empty()) {
    std::printf("%s\n", surveyed.too_long.c_str());
  }
}

int survey(SurveyArguments arguments) {
  read_vehicle(arguments);
  std::optional<Activity> activity("reading the model");
  host::RouteWish wish = wish_of(arguments);
  std::optional<host::FirstRoute> first(std::in_place, wish, arguments.overrides.plugin_path);
  const fs::path folder = new_folder(arguments, arguments.area);
  static_cast<void>(first->files(0, folder));  // nothing is written if that throws
  activity.reset();
  const std::unique_ptr<host::Unfinished> unfinished = created(folder);
  Interrupt interrupt;
  const Surveyed surveyed = survey_in(folder, arguments, wish, first, interrupt);
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
  if (surveyed.flights.empty()) {
    return kNoRoute;
  }
  const host::Camera& camera = wish.survey->camera;
  const std::string item =
      first->areas().empty() || !surveyed.passed()
          ? ""
          : write_survey_item(folder, arguments, *wish.survey, *first, surveyed);
  if (arguments.json) {
    std::cout << host::file_text(json_of(surveyed, *first, camera, folder, item));
  } else {
    print(surveyed, *first, camera, wish.wind.has_value());
    const std::size_t plans = surveyed.flights.size();
    std::printf("written: %s/: page.html, %s, result.json, scenario.yaml, pipeline.yaml\n",
                folder.c_str(),
                plans == 1 ? "route.plan"
                           : ("route-1.plan to route-" + std::to_string(plans) + ".plan").c_str());
    print_checks(surveyed);
    if (!item.empty()) {
      std::printf("%s\n", item.c_str());
    }
  }
  return surveyed.passed() ? kDone : kNoRoute;
}
}  // namespace

void add_survey(App& app, Action& action) {
  const auto prepare = [](SurveyArguments& given) {
    if (!given.gsd_cm && !given.agl_m) {
      throw UsageError{"--gsd-cm or --agl is required"};
    }
    if (given.wish.turn_radius_m && (given.flight_minutes || given.wish.battery_wh)) {
      throw UsageError{
          "--flight-minutes and --battery are for copters: an aeroplane's plan ends in a circle"};
    }
    expect_permissions(given.wish.permitted, given.avoid);
  };
  auto [command, arguments] = add_command<SurveyArguments>(
      app, action, "survey", "photos of areas or along a line from above, without YAML", survey,
      prepare);
  command
      .add_option("area FILE", arguments.area,
                  "polygons, which may have holes, or one line (KML, GeoJSON)")
      ->required();
  add_terrain(command, arguments);
  command
      .add_option("--camera NAME", arguments.camera,
                  "a camera that looks straight down, or a .yaml file with sensor_mm, image_px and "
                  "focal_mm")
      ->required();
  const auto* gsd =
      command.add_option("--gsd-cm CM", arguments.gsd_cm, "what a pixel of a photo shows")
          ->check(number_from(0.01, 1000));
  command.add_option("--agl METRES", arguments.agl_m, "or the height above ground")
      ->check(number_from(1, 1e4))
      ->excludes(gsd);
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
  const auto* offset =
      command
          .add_option("--offset METRES", arguments.offsets,
                      "fly so far to the left of a line, negative: to its right; repeatable "
                      "(default 0)")
          ->check(number_from(-1e4, 1e4))
          ->one_at_a_time()
          ->take_all();
  command
      .add_option("--width METRES", arguments.width_m,
                  "photograph so much on both sides of a line together")
      ->check(number_from(0.1, 1e4))
      ->excludes(offset);
  command
      .add_option("--flight-minutes MIN", arguments.flight_minutes,
                  "longest flight; an area takes several if need be")
      ->check(number_from(0.1, 1e4));
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
