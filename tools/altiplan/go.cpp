// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "commands.hpp"
#include "first_run.hpp"
#include "flight_text.hpp"
#include "host/base/output_file.hpp"
#include "host/first_route/first_route.hpp"
#include "host/first_route/runway_choice.hpp"
#include "host/gate/fewest_items.hpp"
#include "host/view/scene.hpp"
#include "host/view/viewer_page.hpp"
#include "mission_options.hpp"
#include "progress.hpp"
#include "route_export.hpp"

namespace altiplan::cli {
namespace {

namespace fs = std::filesystem;

struct GoArguments : FirstArguments {
  std::string from;
  std::string to;
  std::vector<std::string> via;
  bool takeoff = false;
  bool land = false;
  std::optional<double> runway_deg;
};

/// A copter takes off and lands straight up and down, whether it is asked to or not.
bool uses_runway(const GoArguments& arguments, bool is_asked_for) {
  return is_asked_for && arguments.wish.turn_radius_m;
}

/// Throws UsageError for options that do not fit together.
void expect_runways_fit(GoArguments& arguments) {
  const auto expect_on_ground = [](const char* option, const std::string& point, bool is_runway) {
    if (is_runway && point_of(option, point).above_ground_m) {
      throw UsageError{std::string(option) +
                       ": expected LON,LAT: the end of a runway is on the ground"};
    }
  };
  expect_on_ground("--from", arguments.from, uses_runway(arguments, arguments.takeoff));
  expect_on_ground("--to", arguments.to, uses_runway(arguments, arguments.land));
  if (arguments.runway_deg && !arguments.takeoff && !arguments.land) {
    throw UsageError{"--runway: give --takeoff, --land or both"};
  }
  if (arguments.runway_deg && !arguments.wish.turn_radius_m) {
    throw UsageError{"--runway: a copter needs none; an aeroplane is planned for with --wing"};
  }
}

host::RouteWish wish_of(const GoArguments& arguments) {
  host::RouteWish wish = wish_of_first(arguments);
  wish.points.push_back(point_of("--from", arguments.from));
  for (const std::string& via : arguments.via) {
    wish.points.push_back(point_of("--via", via));
  }
  wish.points.push_back(point_of("--to", arguments.to));
  wish.uses_runways =
      uses_runway(arguments, arguments.takeoff) || uses_runway(arguments, arguments.land);
  return wish;
}

/// True where another corridor or smaller cells may help.
bool may_be_wider(const host::RunResult& result) {
  return !result.accepted && (result.status == host::RunStatus::no_route ||
                              result.status == host::RunStatus::timed_out);
}

void print(const host::RunResult& result, bool is_runway) {
  const host::StepResult& step = result.steps[*result.accepted];
  double seconds = 0;
  for (const host::StepResult& each : result.steps) {
    seconds += each.time_s;
  }
  const Measures& m = step.measures.value();
  const std::string flown = flown_in_words(result);
  const std::string above =
      is_runway ? "" : "at least " + fixed(m.min_ground_clearance_m, 1) + " m above ground, ";
  std::printf("route: %s km, %zu waypoints, %sjudged valid; found in %s%s\n",
              fixed(m.length_m / 1000, 3).c_str(), m.waypoints, above.c_str(),
              duration(seconds).c_str(), flown.empty() ? "" : ("; flown in " + flown).c_str());
}

/// "course 250 degrees, 5.0 m/s of wind from ahead and 1.2 m/s from the side"
std::string course_in_words(double course_deg, const std::optional<host::WishedWind>& wind) {
  std::string words = "course " + host::with_digits(course_deg, 4) + " degrees";
  if (wind) {
    const double off = radians(wind->from_deg - course_deg);
    const double ahead = wind->speed_mps * std::cos(off);
    words += ", " + fixed(std::abs(ahead), 1) + " m/s of wind from " +
             (ahead < 0 ? "behind" : "ahead") + " and " +
             fixed(std::abs(wind->speed_mps * std::sin(off)), 1) + " m/s from the side";
  }
  return words;
}

/// True if ArduPilot arms with DO_LAND_START, which its default RTL_AUTOLAND prevents.
bool may_name_landing(const GoArguments& arguments) {
  const auto& parameters = arguments.gate.flight.parameters;
  const auto given = parameters.find("RTL_AUTOLAND");
  return given != parameters.end() && given->second.value != 0;
}

void print_runways(const host::RouteWish& wish, const GoArguments& arguments) {
  const auto metres = [](double value) { return host::with_digits(std::round(value), 6) + " m"; };
  if (wish.takeoff) {
    std::printf("take-off: %s; climbs to %s above the runway within %s; check: --runway %s\n",
                course_in_words(wish.takeoff->course_deg, wish.wind).c_str(),
                metres(wish.takeoff->height_m).c_str(),
                metres(wish.takeoff->height_m / std::tan(radians(wish.takeoff->climb_deg))).c_str(),
                host::with_digits(wish.takeoff->course_deg, 6).c_str());
  }
  if (wish.landing) {
    std::printf(
        "landing: %s; level for %s at %s above the runway, then a glide of %s degrees over %s%s; "
        "an aborted landing is not judged\n",
        course_in_words(wish.landing->course_deg, wish.wind).c_str(),
        metres(wish.landing->level_m).c_str(), metres(wish.landing->height_m).c_str(),
        host::with_digits(wish.landing->glide_deg, 3).c_str(),
        metres(wish.landing->height_m / std::tan(radians(wish.landing->glide_deg))).c_str(),
        may_name_landing(arguments)
            ? ""
            : "; without DO_LAND_START, with which ArduPilot does not arm unless RTL_AUTOLAND is "
              "set (--params)");
  }
}

/// Chooses the courses of take-off and landing. False, which is reported, if there is none.
bool choose_runways(host::RouteWish& wish, const host::FirstRoute& first, GoArguments& arguments) {
  const bool takes_off = uses_runway(arguments, arguments.takeoff);
  const bool lands = uses_runway(arguments, arguments.land);
  if (!takes_off && !lands) {
    return true;
  }
  std::vector<LonLat> about;
  for (const host::WishedPoint& point : wish.points) {
    about.push_back({point.lon, point.lat});
  }
  const Activity activity("choosing the runways");
  const host::Mission world = flown_world(first, arguments.overrides, about);
  host::RunwayChoice choice(world, wish, first, arguments.gate);
  const auto at = [&](const host::WishedPoint& point) {
    return first.local(point).head<2>().eval();
  };
  const std::size_t last = wish.points.size() - 1;
  std::optional<host::TakeOffEntry> takeoff;
  std::optional<host::LandingEntry> landing;
  if (takes_off) {
    takeoff = choice.takeoff(at(wish.points[0]), at(wish.points[1]), arguments.runway_deg);
  }
  if (lands && choice.refusal().empty()) {
    landing =
        choice.landing(at(wish.points[last]), at(wish.points[last - 1]), arguments.runway_deg);
  }
  if (!choice.refusal().empty()) {
    std::printf("no route: %s\n", choice.refusal().c_str());
    return false;
  }
  wish.takeoff = takeoff;
  wish.landing = landing;
  if (takeoff) {
    arguments.gate.flight.runway_deg = takeoff->course_deg;
  }
  return true;
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
  route.options.landing_start = may_name_landing(arguments);
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
  host::RouteWish wish = wish_of(arguments);
  std::optional<host::FirstRoute> planned(std::in_place, wish, arguments.overrides.plugin_path);
  if (!choose_runways(wish, *planned, arguments)) {
    return kNoRoute;
  }
  if (wish.takeoff || wish.landing) {
    planned.emplace(wish, arguments.overrides.plugin_path);
  }
  const host::FirstRoute& first = *planned;
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
  print_runways(wish, arguments);
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
  print(result, wish.takeoff || wish.landing);
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
  const auto prepare = [](GoArguments& given) {
    expect_permissions(given.wish.permitted, given.avoid);
    expect_runways_fit(given);
  };
  auto [command, arguments] = add_command<GoArguments>(
      app, action, "go", "a first route between two points, without YAML", go, prepare);
  add_points(command, arguments);
  add_first_options(command, arguments, "the model's name");
  command.add_flag("--takeoff", arguments.takeoff,
                   "begin on the ground (a copter does in any case)");
  command.add_flag("--land", arguments.land,
                   "end on the ground (a copter does in any case); an aeroplane's approach is "
                   "chosen by wind, ground and zones");
  command
      .add_option("--runway DEGREES", arguments.runway_deg,
                  "course of an aeroplane's take-off and landing, clockwise from north (default: "
                  "into the wind as far as it passes)")
      ->check(number_from(0, 360));
  add_plugin_path(command, arguments.overrides);
  set_example(command,
              "altiplan go --terrain configs/data/jacksboro_fault.tif --from -84.38,36.48 "
              "--to -84.12,36.70 --max-agl 120");
}
}  // namespace altiplan::cli
