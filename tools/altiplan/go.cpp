// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "commands.hpp"
#include "first_run.hpp"
#include "flight_text.hpp"
#include "host/base/output_file.hpp"
#include "host/base/unfinished.hpp"
#include "host/first_route/first_route.hpp"
#include "host/gate/fewest_items.hpp"
#include "host/gate/plan_report.hpp"
#include "host/mission/mission.hpp"
#include "host/view/scene.hpp"
#include "host/view/viewer_page.hpp"
#include "progress.hpp"
#include "route_export.hpp"

namespace altiplan::cli {
namespace {

namespace fs = std::filesystem;

struct GoArguments {
  std::vector<std::string> terrain;
  std::string from;
  std::string to;
  std::vector<std::string> via;
  std::vector<std::string> avoid;
  bool copter = false;
  std::optional<std::string> out;
  host::RouteWish wish;
  host::Overrides overrides;
};

/// Numbers separated by commas; none if the text is anything else.
std::optional<std::vector<double>> numbers(const std::string& text) {
  std::vector<double> all;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    double value = 0;
    const auto [stop, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value)) {
      return std::nullopt;
    }
    all.push_back(value);
    if (stop == end) {
      return all;
    }
    if (*stop != ',') {
      return std::nullopt;
    }
    at = stop + 1;
  }
}

std::string point_problem(const std::string& text) {
  const auto point = numbers(text);
  return point && (point->size() == 2 || point->size() == 3)
             ? ""
             : "expected LON,LAT or LON,LAT,AGL (degrees; metres above ground), without spaces, "
               "found '" +
                   text + "'";
}

host::WishedPoint point_of(const char* option, const std::string& text) {
  const std::vector<double> all = numbers(text).value();
  return {option, all[0], all[1], all.size() > 2 ? std::optional(all[2]) : std::nullopt};
}

host::RouteWish wish_of(const GoArguments& arguments) {
  host::RouteWish wish = arguments.wish;
  wish.terrain.assign(arguments.terrain.begin(), arguments.terrain.end());
  wish.avoid.assign(arguments.avoid.begin(), arguments.avoid.end());
  wish.points.push_back(point_of("--from", arguments.from));
  for (const std::string& via : arguments.via) {
    wish.points.push_back(point_of("--via", via));
  }
  wish.points.push_back(point_of("--to", arguments.to));
  return wish;
}

/// The folder asked for, or one named after the model, numbered if there are others.
fs::path folder_of(const GoArguments& arguments) {
  const fs::path model = fs::path(arguments.terrain.front()).lexically_normal();
  const std::string stem = (model.has_filename() ? model : model.parent_path()).stem().string();
  fs::path folder = arguments.out.value_or(stem);
  for (int n = 2; !arguments.out && fs::exists(folder); ++n) {
    folder = stem + "_" + std::to_string(n);
  }
  return folder;
}

/// Creates the folder, to be removed again unless it is finished.
std::unique_ptr<host::Unfinished> created(const fs::path& folder) {
  const auto lock = host::uninterrupted();
  std::error_code error;
  if (!fs::create_directory(folder, error)) {
    throw Error("-o: '" + folder.string() + "' " +
                (error ? "cannot be created: " + error.message()
                       : "exists already: give the name of a new folder"));
  }
  return std::make_unique<host::Unfinished>([folder] {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  });
}

/// True where another corridor or smaller cells may help.
bool may_be_wider(const host::RunResult& result) {
  return !result.accepted && (result.status == host::RunStatus::no_route ||
                              result.status == host::RunStatus::timed_out);
}

/// How many zones of each file count, as its layer says.
void print_zones(const host::RunResult& result, const std::vector<std::string>& layers) {
  for (const std::string& layer : layers) {
    std::string text;
    for (const std::string& note : result.notes) {
      const bool is_count = note.find("keep-in zones, ") != note.npos ||
                            note.find("zones outside the bounds") != note.npos;
      if (is_count && note.rfind(layer + ": ", 0) == 0) {
        text += (text.empty() ? "" : "; ") + note.substr(layer.size() + 2);
      }
    }
    std::printf("zones: %s: %s\n", layer.c_str(), text.c_str());
  }
}

void print(const host::RunResult& result) {
  const host::StepResult& step = result.steps[*result.accepted];
  double seconds = 0;
  for (const host::StepResult& each : result.steps) {
    seconds += each.time_s;
  }
  const Measures& m = step.measures.value();
  const std::string flown = flown_in_words(result);
  std::printf(
      "route: %s km, %zu waypoints, at least %s m above ground, judged valid; found in %s%s\n",
      fixed(m.length_m / 1000, 3).c_str(), m.waypoints, fixed(m.min_ground_clearance_m, 1).c_str(),
      duration(seconds).c_str(), flown.empty() ? "" : ("; flown in " + flown).c_str());
}

/// True if the mission passes as autopilots fly it; prints the verdict.
bool passes(const std::string& file, const host::FirstRoute& first,
            const host::Overrides& overrides) {
  host::Config config =
      host::load_scenario_text(first.flown_scenario(), "the world of go", overrides);
  config.is_only_judged = true;
  const host::PlanReport report = busy("judging the mission", [&] {
    return host::judge_plan(file, formats::read_mission(file), host::build_mission(config, 1), {});
  });
  std::printf("check: %s, flown by %s, %s\n", word_of(report.verdict()),
              report.autopilots.front().name().c_str(), time_in_words(report.time).c_str());
  for (const host::Finding& finding : report.findings) {
    std::printf("  %s: %s\n", finding.items.back().c_str(), finding.violation.message.c_str());
  }
  return report.passed();
}

/// The plan with fly-by items for turns, if that passes; else with all of their points.
std::string few_items(const LoadedRoute& loaded, const RouteExport& route,
                      const host::Exported& written) {
  const host::FewestItems fewest = busy("searching the fewest items", [&] {
    return host::fewest_items(loaded.mission, loaded.source, route.options, written.mission, {});
  });
  if (!fewest.passed()) {
    return *written.text;
  }
  std::printf("items: %zu, which pass as they are flown, in place of %zu\n",
              fewest.plan.items.size(), host::plan_of(written.mission).items.size());
  return host::plan_text(fewest.plan);
}

/// The page, and the mission; false if the route would not be valid as a mission.
bool write_views(const fs::path& folder, const GoArguments& arguments) {
  RouteExport route;
  route.result = folder / "result.json";
  route.overrides = arguments.overrides;
  route.options.format = &host::format_named("qgc-plan");
  const bool is_wing = arguments.wish.turn_radius_m.has_value();
  route.options.takeoff = route.options.land = !is_wing;
  route.options.circles_at_end = is_wing;
  finish_options(route);
  const host::Scene scene = busy("drawing the page", [&] {
    return host::build_scene({host::read_result(route.result, arguments.overrides)});
  });
  host::write_file(folder / "page.html", host::viewer_page(scene.json));
  const std::optional<LoadedRoute> source = loaded(route, std::nullopt);
  const std::optional<host::Exported> plan = source ? exported(*source, route) : std::nullopt;
  if (plan) {
    host::write_file(folder / "route.plan",
                     is_wing ? few_items(*source, route, *plan) : *plan->text);
  }
  std::printf("written: %s/: page.html, %sresult.json, scenario.yaml, pipeline.yaml\n",
              folder.c_str(), plan ? "route.plan, " : "");
  return plan.has_value();
}

int go(const GoArguments& arguments) {
  std::optional<Activity> activity("reading the model");
  const host::RouteWish wish = wish_of(arguments);
  const host::FirstRoute first(wish, arguments.overrides.plugin_path);
  const fs::path folder = folder_of(arguments);
  host::FirstFiles files = first.files(0, folder);  // nothing is written if that throws
  activity.reset();
  const std::unique_ptr<host::Unfinished> unfinished = created(folder);
  Interrupt interrupt;
  host::RunResult result;
  int tried = 0;
  for (int attempt = 0; attempt < host::FirstRoute::kTries; ++attempt) {
    if (first.repeats(attempt)) {
      continue;
    }
    tried = attempt;
    files = first.files(attempt, folder);
    result = run_in(folder, files, arguments.overrides, interrupt);
    if (interrupt.happened() || !may_be_wider(result)) {
      break;
    }
  }
  std::vector<std::string> reasons;
  if (!result.accepted && !interrupt.happened()) {
    reasons = reasons_of({wish, arguments.overrides, folder, tried}, interrupt);
  }
  interrupt.finish();
  for (const std::string& line : files.choices) {
    std::printf("%s\n", line.c_str());
  }
  print_zones(result, files.zone_layers);
  if (interrupt.happened()) {
    return kInterrupted;
  }
  print_remarks(result);
  if (!result.accepted) {
    unfinished->is_finished();
    std::printf("no route: %s; %s/ holds scenario.yaml, pipeline.yaml and result.json\n",
                result.message.c_str(), folder.c_str());
    for (const std::string& reason : reasons) {
      std::printf("reason: %s\n", reason.c_str());
    }
    return result.exit_code();
  }
  print(result);
  const Polyline& route = result.steps[*result.accepted].route.waypoints();
  if (const std::string voids = first.over_voids(route); !voids.empty()) {
    warn(voids);
  }
  const bool is_mission = write_views(folder, arguments);
  unfinished->is_finished();
  return is_mission && passes(folder / "route.plan", first, arguments.overrides) ? kDone : kNoRoute;
}

void add_points(App& command, GoArguments& arguments) {
  command
      .add_option("--terrain DEM", arguments.terrain,
                  "elevation models, or a folder of tiles; repeatable")
      ->required()
      ->take_all();
  command
      .add_option("--from LON,LAT[,AGL]", arguments.from, "start: degrees, and metres above ground")
      ->required()
      ->check(point_problem);
  command.add_option("--to LON,LAT[,AGL]", arguments.to, "goal")->required()->check(point_problem);
  command
      .add_option("--via LON,LAT[,AGL]", arguments.via,
                  "point to pass through, in order; repeatable")
      ->one_at_a_time()
      ->take_all()
      ->check(point_problem);
}

void add_wishes(App& command, GoArguments& arguments) {
  host::RouteWish& wish = arguments.wish;
  command
      .add_option("--avoid FILE", arguments.avoid,
                  "zones: published airspace, GeoJSON, KML, or a fence; repeatable")
      ->take_all();
  const auto metres = [&](const char* name, std::optional<double>& value, const char* what) {
    return command.add_option(std::string(name) + " METRES", value, what)
        ->check(number_from(0, 1e4));
  };
  metres("--min-agl", wish.min_above_ground_m, "minimum height above ground (default 50)");
  metres("--max-agl", wish.max_above_ground_m, "greatest height above ground (default none)");
  auto* copter = command.add_flag("--copter", arguments.copter, "plan for a copter (default)");
  command
      .add_option("--wing RADIUS", wish.turn_radius_m,
                  "plan for an aeroplane with this turn radius")
      ->check(number_from(1, 5000))
      ->excludes(copter);
  auto* battery =
      command
          .add_option("--battery WH", wish.battery_wh,
                      "capacity of the battery, with --power; routes may use it but for "
                      "its reserve")
          ->check(number_from(0.01, 1e6));
  auto* power =
      command.add_option("--power W", wish.power_w, "mean power in flight, with --battery")
          ->check(number_from(0.01, 1e6))
          ->needs(battery);
  battery->needs(power);
  command.add_option("--reserve SHARE", wish.reserve, "share of the battery to keep (default 0.2)")
      ->check(number_from(0, 0.99))
      ->needs(battery);
  command.add_option("--planner NAME", wish.planner, "planner (default: chosen)");
  command.add_option("--start-time TIME", wish.start_time,
                     "UTC (2026-05-01T10:00:00Z), for zones with hours; default: all count");
  command.add_option("--crs EPSG:CODE", wish.crs, "coordinate system of a model that names none");
  command.add_option("-o,--out DIR", arguments.out, "new folder (default: the model's name)");
}
}  // namespace

void add_go(App& app, Action& action) {
  auto [command, arguments] = add_command<GoArguments>(
      app, action, "go", "a first route between two points, without YAML", go);
  add_points(command, arguments);
  add_wishes(command, arguments);
  add_plugin_path(command, arguments.overrides);
  set_example(command,
              "altiplan go --terrain configs/data/jacksboro_fault.tif --from -84.38,36.48 "
              "--to -84.12,36.70 --max-agl 120");
}
}  // namespace altiplan::cli
