// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "altiplan/formats/mission_file.hpp"
#include "altiplan/nearest_place.hpp"
#include "check_survey.hpp"
#include "commands.hpp"
#include "flight_text.hpp"
#include "host/base/words.hpp"
#include "host/flight/events.hpp"
#include "host/flight/track_judge.hpp"
#include "host/gate/route_returns.hpp"
#include "host/gate/task_verdict.hpp"
#include "host/gate/violated_zone.hpp"
#include "host/import_export/imported_route.hpp"
#include "host/import_export/route_format.hpp"
#include "host/judge/judge.hpp"
#include "host/mission/mission.hpp"
#include "host/result/stored_result.hpp"
#include "host/run/along_task.hpp"
#include "mission_options.hpp"
#include "progress.hpp"
#include "terminal.hpp"

namespace altiplan::cli {
namespace {

struct CheckArguments {
  std::optional<std::string> result;
  std::optional<std::string> route;
  bool survey = false;
  MissionOptions mission;
  host::Overrides overrides;
};

void print_violations(const CheckResult& verdict, const char* point) {
  for (const Violation& violation : verdict.violations) {
    std::printf("  %s %zu, %s: %s\n", point, violation.at, violation.constraint.c_str(),
                violation.message.c_str());
  }
}

std::string verdict_text(const CheckResult& verdict) {
  return painted(stdout, verdict.ok() ? Color::good : Color::bad,
                 verdict.ok() ? "valid" : "not valid");
}

void print_route(const CheckResult& verdict, const Measures& measures) {
  std::printf("%s: %zu waypoints, %s km, clearance %s m, %s m above ground\n",
              verdict_text(verdict).c_str(), measures.waypoints,
              fixed(measures.length_m / 1000, 3).c_str(),
              fixed(measures.min_clearance_m, 2).c_str(),
              fixed(measures.min_ground_clearance_m, 2).c_str());
  print_violations(verdict, "waypoint");
}

void print_track(const host::TrackVerdict& verdict, const host::Track& track, bool has_events) {
  std::printf("flight %s: %zu points, %s s, %d collision%s, %s\n",
              verdict_text(verdict.check).c_str(), track.size(),
              fixed(track.back().first, 0).c_str(), verdict.collisions,
              verdict.collisions == 1 ? "" : "s",
              verdict.reached ? "reached the goal" : "did not reach the goal");
  print_violations(verdict.check, "point");
  if (has_events) {
    std::printf("  each event is applied at the first point at or after its time\n");
  }
}

/// Adds the name of the zone, or of another part of a layer, that a leg comes too near to.
void name_zones(CheckResult& verdict, const Route& route, const World& world) {
  host::ZoneNames names(world);
  for (Violation& violation : verdict.violations) {
    const Layer* layer = world.find(violation.layer);
    if (violation.constraint != "clearance" || layer == nullptr ||
        violation.at >= route.leg_count()) {
      continue;
    }
    const Leg leg = route.leg(violation.at);
    host::Finding finding;
    finding.violation = violation;
    finding.at = leg.at(nearest_share(*layer->environment, leg.from, leg.to, violation.value));
    names.add_to(finding);
    violation.message = finding.violation.message;
  }
}

/// The verdict of a step that judges returns.
struct JudgedReturns {
  std::string id;
  host::ReturnsVerdict verdict;
};

/// Of the pipeline that a result is of, judged again.
std::vector<JudgedReturns> returns_of(const host::Config& config, const host::Mission& mission,
                                      const host::StoredResult& stored) {
  host::RunResult run;
  run.steps.emplace_back().route = *stored.route;
  run.accepted = 0;
  if (mission.task) {
    run.task.emplace();
    for (const host::PlacedStop& stop : stored.stops) {
      Pass& pass = run.task->passes.emplace_back();
      pass.points = {stop.at};
      pass.stop = stop.stop;
    }
  }
  std::vector<JudgedReturns> all;
  for (const host::StepEntry& step : config.steps) {
    if (step.verb == host::Verb::returns) {
      all.push_back({step.id, busy("judging the returns", [&] {
                       return host::judge_route_returns(config, mission, run, step);
                     })});
    }
  }
  return all;
}

/// Prints the verdicts on the route and, if there are any, on the flight and on returns; returns
/// the exit code.
int report(const host::Mission& mission, const Route& route,
           const std::optional<host::Track>& track, bool telemetry,
           const std::vector<host::FlightEvent>& events, bool as_json,
           const std::optional<Violation>& undone, const std::vector<JudgedReturns>& returns) {
  CheckResult verdict = busy("judging the route", [&] {
    return host::judge(route, mission.request, mission.via, mission.runways);
  });
  name_zones(verdict, route, *mission.request.world);
  if (undone) {
    verdict.violations.push_back(*undone);
  }
  const Measures measures = measure(route, mission.request);
  bool valid = verdict.ok();
  const host::Cost cost = host::price(route, mission.request, mission.via);
  const host::MetricValues metrics = host::measured(route, mission.request, mission.metrics);
  host::Json json{{"check", host::to_json(verdict)}, {"metrics", host::to_json(measures, metrics)}};
  json.update(host::to_json(std::optional(cost)));
  if (!as_json) {
    print_route(verdict, measures);
    if (mission.request.objective) {
      const std::string gap =
          std::isfinite(cost.gap()) ? ": gap " + fixed(100 * cost.gap(), 2) + " %" : "";
      std::printf("  cost %s %s, at least %s%s\n", host::with_digits(cost.cost, 6).c_str(),
                  mission.request.objective->unit().c_str(),
                  host::with_digits(cost.bound, 6).c_str(), gap.c_str());
    }
    print_metrics(stdout, "route", metrics);
  }
  if (track) {
    host::FlightSetup setup;
    setup.request = mission.track_request;
    setup.truth = mission.truth;
    setup.events = events;
    setup.telemetry = telemetry;
    const host::TrackVerdict flown =
        busy("judging the flight", [&] { return host::judge_track(*track, setup); });
    valid = valid && flown.check.ok();
    json["flight"] = {{"check", host::to_json(flown.check)},
                      {"collisions", flown.collisions},
                      {"reached", flown.reached}};
    if (!as_json) {
      print_track(flown, *track, !events.empty());
    }
  }
  for (const auto& [id, judged] : returns) {
    valid = valid && judged.passes;
    json["returns"][id] = judged.json.empty() ? host::Json() : host::parse_json(judged.json);
    if (!as_json) {
      std::printf("%s %s\n", id.c_str(), judged.message.c_str());
    }
  }
  if (as_json) {
    std::cout << host::file_text(json);
  }
  return valid ? kDone : kNoRoute;
}

/// What of the scenario's task a route of altiplan run leaves undone.
std::optional<Violation> undone_by_run(const host::Config& config, const host::Mission& mission,
                                       const host::StoredResult& stored) {
  if (!mission.task) {
    return std::nullopt;
  }
  Budget budget;
  if (const auto iterations = config.steps.front().within_iterations) {
    budget.max_iterations = std::uint64_t(*iterations);
  }
  const TaskOrder order = host::order_of_task(mission, budget);
  if (order.status != PlanStatus::solved) {
    return Violation{"task", 0, 0, 0, "the task has no order: " + order.message};
  }
  const host::TaskSections sections(order, mission.ends, mission.request);
  if (auto undone = sections.violation(stored.route.value(), mission.request)) {
    return undone;
  }
  std::vector<const Pass*> acting;
  for (const Pass& pass : order.passes) {
    if (pass.stop.acts()) {
      acting.push_back(&pass);
    }
  }
  const bool are_same = std::equal(
      acting.begin(), acting.end(), stored.stops.begin(), stored.stops.end(),
      [](const Pass* pass, const host::PlacedStop& stop) {
        constexpr double kRounding = 1e-6;
        return std::abs(pass->stop.hold_s - stop.stop.hold_s) < kRounding &&
               pass->stop.lands == stop.stop.lands && pass->stop.drops == stop.stop.drops &&
               (pass->points.back() - stop.at).norm() <= kLengthTolerance;
      });
  return are_same ? std::nullopt
                  : std::optional(Violation{"task", 0, 0, 0, "its stops are not the task's"});
}

int check_result(const CheckArguments& arguments) {
  const host::StoredResult stored = host::read_result(*arguments.result, arguments.overrides);
  for (const std::string& changed : stored.changed) {
    warn(changed + " has changed since the result was written");
  }
  if (!stored.route) {
    std::cout << stored.file << " contains no accepted route\n";
    return kNoRoute;
  }
  const host::Config config = host::load_config(stored.pipeline, stored.overrides);
  host::Mission mission =
      busy("building the world", [&] { return host::build_mission(config, 1); });
  const std::optional<Violation> undone = undone_by_run(config, mission, stored);
  const std::vector<JudgedReturns> returns = returns_of(config, mission, stored);
  host::take_open_ends(mission, *stored.route, mission.request);
  return report(mission, *stored.route, stored.track, stored.telemetry,
                host::build_events(config, mission), arguments.mission.plan.json, undone, returns);
}

int check_route(const CheckArguments& arguments) {
  const host::Config config =
      host::load_scenario(*arguments.mission.plan.scenario, arguments.overrides);
  host::Mission mission =
      busy("building the world", [&] { return host::build_mission(config, 1); });
  for (const std::string& warning : mission.warnings) {
    warn(warning);
  }
  const host::ImportedRoute imported = host::read_imported_route(*arguments.route, mission);
  for (const std::string& note : imported.notes) {
    info(note);
  }
  if (config.scenario.constraints.empty()) {
    warn(
        "the scenario has no constraints: only obstacles, ground, volume and the vehicle's own "
        "limits are "
        "checked");
  }
  std::optional<Violation> left;
  if (mission.task) {
    if (const auto finding = host::undone(mission, host::places_flown(imported.route))) {
      left = finding->violation;
    }
  }
  host::take_open_ends(mission, imported.route, mission.request);
  return report(mission, imported.route, std::nullopt, false, {}, arguments.mission.plan.json, left,
                {});
}

/// What is written besides the verdict; returns the options.
std::vector<Option*> add_outputs(App& command, PlanCheck& plan) {
  const auto file = [&](const char* name, std::optional<std::string>& value, const char* what) {
    return command.add_option(std::string(name) + " FILE", value, what);
  };
  return {file("--certificate", plan.certificate,
               "also write the verdict as a page (HTML) with the height profile"),
          file("--junit", plan.junit, "also write the verdict as JUnit XML"),
          file("--fix", plan.fixed,
               "write the mission with items raised, lowered or moved until it passes (.plan, "
               ".waypoints)")};
}

/// What the flight and its returns are flown on.
void add_battery(App& command, PlanCheck& plan, Option* returns) {
  auto* battery = command
                      .add_option("--battery WH", plan.battery_wh,
                                  "with --returns: its capacity (Wh), which each must keep to")
                      ->check(number_from(0.001, 1e6))
                      ->needs(returns);
  auto* power = command
                    .add_option("--power W", plan.battery.power_w,
                                "with --battery: power that the vehicle takes in flight (W)")
                    ->check(number_from(0.001, 1e6))
                    ->needs(battery);
  battery->needs(power);
  command
      .add_option("--reserve SHARE", plan.battery.reserve,
                  "share of the battery that is kept (default 0.2)")
      ->check(number_from(0, 0.99))
      ->needs(battery);
}

void add_glide(App& command, PlanCheck& plan, Option* returns) {
  auto* glide =
      command
          .add_option("--glide RATIO", plan.glide,
                      "with --returns: also judge whether an aeroplane whose engine stops "
                      "glides to a site, so many metres on per metre of height in still air")
          ->check(number_from(0.1, 100))
          ->needs(returns);
  command
      .add_option("--ditch FILE", plan.ditch,
                  "with --glide: points and areas where it may come down (GeoJSON, KML), in place "
                  "of home and the mission's landing")
      ->needs(glide);
}

/// A mission whose ending is not its format's is told by --scenario or --terrain.
bool is_plan(const CheckArguments& arguments) {
  return arguments.result &&
         (!arguments.mission.plan.terrain.empty() || arguments.mission.plan.scenario);
}

/// Throws UsageError for options that do not fit together.
void expect_fitting(const CheckArguments& arguments, const std::vector<Option*>& outputs) {
  if (arguments.survey) {
    if (!arguments.result || arguments.mission.plan.scenario) {
      throw UsageError{"--survey takes a .plan, and --terrain for one of altiplan survey"};
    }
    return;
  }
  if (!arguments.result && !arguments.route) {
    throw UsageError{
        "a result, a mission and --terrain or --scenario, or --route and --scenario is required"};
  }
  if (arguments.result && !is_plan(arguments) && host::is_mission_name(*arguments.result)) {
    throw UsageError{*arguments.result + " is a mission: add --terrain DEM or --scenario FILE"};
  }
  for (const Option* output : outputs) {
    if (output->count() > 0 && !is_plan(arguments)) {
      throw UsageError{output->name() + " requires a mission and --terrain or --scenario"};
    }
  }
}
}  // namespace

void add_check(App& app, Action& action) {
  auto outputs = std::make_shared<std::vector<Option*>>();
  const auto prepare = [outputs](CheckArguments& given) {
    expect_fitting(given, *outputs);
    if (!given.survey || is_plan(given)) {
      given.mission.plan = checked_plan(given.mission, given.result.value_or(""));
    }
  };
  const auto check = [](const CheckArguments& given) {
    return given.survey     ? check_survey(*given.result, given.mission.plan, given.overrides)
           : is_plan(given) ? check_plan(given.mission.plan, given.overrides)
           : given.result   ? check_result(given)
                            : check_route(given);
  };
  auto [command, arguments] = add_command<CheckArguments>(
      app, action, "check", "judge a mission (.plan, .waypoints, …), a result or a route", check,
      prepare);
  auto* result =
      command.add_option("file", arguments.result,
                         "result file of altiplan run (JSON), or with --terrain or --scenario a "
                         "mission (.plan, .waypoints, .kml, .gpx, .geojson)");
  auto* route = command
                    .add_option("--route FILE", arguments.route,
                                "route file: JSON ([[x, y, z], …] in metres, or a result), CSV, "
                                "or a mission")
                    ->excludes(result);
  auto* scenario = command.add_option("--scenario FILE", arguments.mission.plan.scenario,
                                      "scenario file in which to judge the route (YAML)");
  add_mission_options(command, arguments.mission)->excludes(scenario)->needs(result);
  route->needs(scenario);
  *outputs = add_outputs(command, arguments.mission.plan);
  outputs->push_back(command.add_flag("--returns", arguments.mission.plan.returns,
                                      "also judge the failsafe return from every second of it"));
  add_battery(command, arguments.mission.plan, outputs->back());
  add_glide(command, arguments.mission.plan, outputs->back());
  command
      .add_option("--fix-returns FILE", arguments.mission.plan.fixed_returns,
                  "with --returns: write the minimum return height with which all pass "
                  "(.param), or the mission so cured (.plan)")
      ->needs(outputs->back());
  command
      .add_flag("--survey", arguments.survey,
                "make the surveys of a QGroundControl .plan again from their settings, and compare "
                "them with its items; of a plan of altiplan survey, with --terrain, see what its "
                "photos show")
      ->excludes(route);
  add_plugin_path(command, arguments.overrides);
  command.add_flag("--json", arguments.mission.plan.json, "print as JSON");
  set_example(command, "altiplan check mission.plan --terrain dem.tif --min-agl 50");
}
}  // namespace altiplan::cli
