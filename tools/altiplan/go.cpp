// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>

#include "commands.hpp"
#include "first_run.hpp"
#include "flight_text.hpp"
#include "host/base/output_file.hpp"
#include "host/first_route/first_route.hpp"
#include "host/gate/fewest_items.hpp"
#include "host/view/scene.hpp"
#include "host/view/viewer_page.hpp"
#include "progress.hpp"
#include "route_export.hpp"

namespace altiplan::cli {
namespace {

namespace fs = std::filesystem;

struct GoArguments : FirstArguments {
  std::string from;
  std::string to;
  std::vector<std::string> via;
};

host::RouteWish wish_of(const GoArguments& arguments) {
  host::RouteWish wish = wish_of_first(arguments);
  wish.points.push_back(point_of("--from", arguments.from));
  for (const std::string& via : arguments.via) {
    wish.points.push_back(point_of("--via", via));
  }
  wish.points.push_back(point_of("--to", arguments.to));
  return wish;
}

/// True where another corridor or smaller cells may help.
bool may_be_wider(const host::RunResult& result) {
  return !result.accepted && (result.status == host::RunStatus::no_route ||
                              result.status == host::RunStatus::timed_out);
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

/// The plan with fly-by items for turns, if that passes; else with all of their points.
std::string few_items(const LoadedRoute& loaded, const RouteExport& route,
                      const host::Exported& written, const host::GateOptions& gate) {
  const host::FewestItems fewest = busy("searching the fewest items", [&] {
    return host::fewest_items(loaded.mission, loaded.source, route.options, written.mission, gate);
  });
  if (!fewest.passed()) {
    return *written.text;
  }
  std::printf("items: %zu, which pass as they are flown, in place of %zu\n",
              fewest.plan.items.size(), host::plan_of(written.mission).items.size());
  return host::plan_text(fewest.plan);
}

/// The mission with a command for the speed, which a copter does not take from a plan.
std::string with_speed(const host::Exported& written, double speed_mps) {
  return host::plan_text(host::plan_of(written.mission, host::CameraLines{{}, 0, speed_mps}));
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
                     is_wing                    ? few_items(*source, route, *plan, arguments.gate)
                     : arguments.wish.speed_mps ? with_speed(*plan, *arguments.wish.speed_mps)
                                                : *plan->text);
  }
  std::printf("written: %s/: page.html, %sresult.json, scenario.yaml, pipeline.yaml\n",
              folder.c_str(), plan ? "route.plan, " : "");
  return plan.has_value();
}

int go(GoArguments arguments) {
  read_vehicle(arguments);
  std::optional<Activity> activity("reading the model");
  const host::RouteWish wish = wish_of(arguments);
  const host::FirstRoute first(wish, arguments.overrides.plugin_path);
  const fs::path model = fs::path(arguments.terrain.front()).lexically_normal();
  const fs::path folder = new_folder(arguments, model.has_filename() ? model : model.parent_path());
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
    std::string why = result.message;
    constexpr std::string_view kSaid = "no route: ";
    if (const std::size_t at = why.find(": " + std::string(kSaid)); at != why.npos) {
      why.erase(at + 2, kSaid.size());  // of the planner, which is named before
    }
    std::printf("no route: %s; %s/ holds scenario.yaml, pipeline.yaml and result.json\n",
                why.c_str(), folder.c_str());
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
  if (!is_mission) {
    return kNoRoute;
  }
  const host::PlanReport report =
      judged(folder / "route.plan", first, arguments.overrides, arguments.gate);
  print_check(report);
  return report.passed() ? kDone : kNoRoute;
}

void add_points(App& command, GoArguments& arguments) {
  add_terrain(command, arguments);
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

}  // namespace

void add_go(App& app, Action& action) {
  auto [command, arguments] = add_command<GoArguments>(
      app, action, "go", "a first route between two points, without YAML", go);
  add_points(command, arguments);
  add_first_options(command, arguments, "the model's name");
  add_plugin_path(command, arguments.overrides);
  set_example(command,
              "altiplan go --terrain configs/data/jacksboro_fault.tif --from -84.38,36.48 "
              "--to -84.12,36.70 --max-agl 120");
}
}  // namespace altiplan::cli
