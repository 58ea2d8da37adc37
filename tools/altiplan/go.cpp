// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
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
  std::optional<double> vtol_radius_m;
  std::string autopilot = "ardupilot";
  std::optional<double> runway_deg;
};

/// A copter and a VTOL take off and land straight up and down, whether they are asked to or not.
bool uses_runway(const GoArguments& arguments, bool is_asked_for) {
  return is_asked_for && arguments.wish.turn_radius_m && !arguments.vtol_radius_m;
}

/// Takes the vehicle and its autopilot into the wish and the gate.
void take_vehicle(GoArguments& arguments) {
  host::RouteWish& wish = arguments.wish;
  if (arguments.vtol_radius_m && (wish.turn_radius_m || arguments.copter)) {
    throw UsageError{"--vtol: without --wing and --copter"};
  }
  wish.autopilot.airframe = arguments.vtol_radius_m ? formats::Airframe::vtol
                            : wish.turn_radius_m    ? formats::Airframe::plane
                                                    : formats::Airframe::copter;
  wish.turn_radius_m = arguments.vtol_radius_m ? arguments.vtol_radius_m : wish.turn_radius_m;
  wish.autopilot.firmware =
      arguments.autopilot == "px4" ? formats::Firmware::px4 : formats::Firmware::ardupilot;
  arguments.gate.firmware = wish.autopilot.firmware;
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
  if (arguments.runway_deg && (!arguments.wish.turn_radius_m || arguments.wish.is_vtol())) {
    throw UsageError{
        "--runway: a copter and a VTOL need none; an aeroplane is planned for with --wing"};
  }
  if (arguments.runway_deg && !arguments.takeoff && !arguments.land) {
    throw UsageError{"--runway: give --takeoff, --land or both"};
  }
}

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

/// True if the autopilot arms with DO_LAND_START, which ArduPilot's default RTL_AUTOLAND prevents.
bool may_name_landing(const GoArguments& arguments) {
  if (arguments.wish.autopilot.is_px4()) {
    return true;
  }
  const auto& parameters = arguments.gate.flight.parameters;
  const auto given = parameters.find("RTL_AUTOLAND");
  return given != parameters.end() && given->second.value != 0;
}

void print_runways(const host::RouteWish& wish, const GoArguments& arguments) {
  const auto metres = [](double value) { return host::with_digits(std::round(value), 6) + " m"; };
  if (wish.is_vtol()) {
    const auto above = [&](const host::WishedPoint& point) {
      return metres(*point.above_ground_m);
    };
    const std::string course = host::with_digits(wish.takeoff->course_deg, 6);
    std::printf("take-off: straight up to %s above the ground, then within %s on wings, %s%s\n",
                above(wish.points.front()).c_str(), metres(wish.takeoff->level_m).c_str(),
                course_in_words(wish.takeoff->course_deg, wish.wind).c_str(),
                wish.autopilot.is_px4()
                    ? ""
                    : ("; point it there before; check: --runway " + course).c_str());
    std::printf("landing: level for %s at %s above the ground, %s, then straight down\n",
                metres(wish.landing->level_m).c_str(), above(wish.points.back()).c_str(),
                course_in_words(wish.landing->course_deg, wish.wind).c_str());
    return;
  }
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

/// Chooses the courses of take-off and landing, and how high an aeroplane circles that does not
/// land. False, which is reported, if there is none.
bool choose_runways(host::RouteWish& wish, const host::FirstRoute& first, GoArguments& arguments) {
  if (!wish.turn_radius_m) {
    return true;
  }
  const bool takes_off = wish.is_vtol() || arguments.takeoff;
  const bool lands = wish.is_vtol() || arguments.land;
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
  std::optional<double> circle_m;
  if (lands && choice.refusal().empty()) {
    landing =
        choice.landing(at(wish.points[last]), at(wish.points[last - 1]), arguments.runway_deg);
  } else if (choice.refusal().empty()) {
    circle_m = choice.circle(at(wish.points[last]), at(wish.points[last - 1]));
  }
  if (!choice.refusal().empty() && !circle_m) {
    std::printf("no route: %s\n", choice.refusal().c_str());
    return false;
  }
  if (circle_m && !choice.refusal().empty()) {
    wish.points.back().above_ground_m = circle_m;
    std::printf("circle: around the goal at %s m above its ground: lower it does not pass\n",
                host::with_digits(*circle_m, 6).c_str());
  }
  if (wish.is_vtol()) {
    wish.points.front().above_ground_m = std::exchange(takeoff->height_m, 0);
    wish.points.back().above_ground_m = std::exchange(landing->height_m, 0);
  }
  wish.takeoff = takeoff;
  wish.landing = landing;
  if (takeoff) {
    arguments.gate.flight.runway_deg = takeoff->course_deg;
  }
  return true;
}

/// A route's plan, and what is to be said of it.
struct Planned {
  std::optional<std::string> text;  ///< none if the route would not be valid as a mission
  std::string items;                ///< how many, where these are fewer than its points
  std::vector<std::string> messages;
};

/// Of the result in the folder: with as few items as pass, turns as items that are flown by; else
/// with all points.
Planned plan_in(const fs::path& folder, const GoArguments& arguments) {
  RouteExport route;
  route.result = folder / "result.json";
  route.overrides = arguments.overrides;
  route.options.format = &host::format_named("qgc-plan");
  const bool is_wing = arguments.wish.turn_radius_m.has_value();
  route.options.takeoff = route.options.land = !is_wing;
  route.options.circles_at_end = is_wing;
  route.options.landing_start = may_name_landing(arguments) && !arguments.wish.is_vtol();
  route.options.firmware = arguments.wish.autopilot.firmware;
  route.options.commanded_mps = arguments.wish.speed_mps.value_or(0);
  finish_options(route);
  const std::optional<LoadedRoute> source = loaded(route, std::nullopt);
  if (!source) {
    return {};
  }
  host::Exported written = busy("judging the mission", [&] {
    return host::export_route(source->mission, source->source, route.options);
  });
  Planned planned{written.text, "", std::move(written.messages)};
  if (!written.text) {
    return planned;
  }
  const host::FewestItems fewest = busy("searching the fewest items", [&] {
    return host::fewest_items(source->mission, source->source, route.options, written.mission,
                              arguments.gate);
  });
  const std::size_t all = host::plan_of(written.mission).items.size();
  if (fewest.passed() && fewest.plan.items.size() < all) {
    planned.text = host::plan_text(fewest.plan);
    planned.items = std::to_string(fewest.plan.items.size()) +
                    ", which pass as they are flown, in place of " + std::to_string(all);
  }
  return planned;
}

/// By how much heights are off their limits; 0 if a verdict has other reasons.
double lacking_m(const host::PlanReport& report) {
  double lacking = 0;
  for (const host::Finding& finding : report.findings) {
    const Violation& violation = finding.violation;
    if (violation.constraint != "ground_clearance" && violation.constraint != "altitude") {
      return 0;
    }
    lacking = std::max(lacking, std::abs(violation.value - violation.limit));
  }
  return lacking;
}

bool is_circle_low(const host::PlanReport& report) {
  return std::any_of(report.findings.begin(), report.findings.end(),
                     [](const host::Finding& finding) { return finding.what == "its circle"; });
}

/// The search in ever wider corridors, in the end on smaller cells.
struct Tries {
  const fs::path& folder;
  const host::Overrides& overrides;
  Interrupt& interrupt;
  host::FirstFiles files;  ///< of the last try
  host::RunResult result{};
  int attempt = 0;

  void run(const host::FirstRoute& first) {
    for (int next = 0; next < host::FirstRoute::kTries; ++next) {
      if (first.repeats(next)) {
        continue;
      }
      attempt = next;
      files = first.files(attempt, folder);
      result = run_in(folder, files, overrides, interrupt);
      if (interrupt.happened() || !may_be_wider(result)) {
        return;
      }
    }
  }
};

void draw_page(const fs::path& folder, const host::Overrides& overrides) {
  const host::Scene scene = busy("drawing the page", [&] {
    return host::build_scene({host::read_result(folder / "result.json", overrides)});
  });
  host::write_file(folder / "page.html", host::viewer_page(scene.json));
}

/// Throws Error for a mission that the autopilot refuses; warns of a speed that it does not fly.
void expect_taken(const GoArguments& arguments) {
  const host::RouteWish& wish = arguments.wish;
  const host::Parameters value(wish.autopilot, wish.parameters);
  const bool is_px4 = wish.autopilot.is_px4();
  if (!wish.turn_radius_m) {
    return;
  }
  constexpr double kLanding = 2;  // of MIS_TKO_LAND_REQ
  if (is_px4 && !wish.is_vtol() && !arguments.land && value("MIS_TKO_LAND_REQ") >= kLanding) {
    throw Error(
        "--autopilot px4: it takes an aeroplane's mission with a landing alone "
        "(MIS_TKO_LAND_REQ): add --land");
  }
  const char* const min_name = is_px4 ? "FW_AIRSPD_MIN" : "AIRSPEED_MIN";
  const char* const max_name = is_px4 ? "FW_AIRSPD_MAX" : "AIRSPEED_MAX";
  const double speed = wish.speed_mps.value_or(value(min_name));
  if (speed < value(min_name) || speed > value(max_name)) {
    warn("--speed: " + wish.autopilot.name() + " flies from " +
         host::with_digits(value(min_name), 4) + " to " + host::with_digits(value(max_name), 4) +
         " m/s through the air (" + min_name + ", " + max_name +
         "): give its parameters (--params)");
  }
}

int go(GoArguments arguments) {
  read_vehicle(arguments);
  expect_taken(arguments);
  std::optional<Activity> activity("reading the model");
  host::RouteWish wish = wish_of(arguments);
  std::optional<host::FirstRoute> planned(std::in_place, wish, arguments.overrides.plugin_path);
  if (!choose_runways(wish, *planned, arguments)) {
    return kNoRoute;
  }
  if (wish.turn_radius_m) {
    planned.emplace(wish, arguments.overrides.plugin_path);
  }
  const fs::path model = fs::path(arguments.terrain.front()).lexically_normal();
  const fs::path folder = new_folder(arguments, model.has_filename() ? model : model.parent_path());
  host::FirstFiles files = planned->files(0, folder);  // nothing is written if that throws
  activity.reset();
  const std::unique_ptr<host::Unfinished> unfinished = created(folder);
  Interrupt interrupt;
  Tries tries{folder, arguments.overrides, interrupt, std::move(files)};
  tries.run(*planned);
  Planned plan;
  std::optional<host::PlanReport> report;
  const auto judge_plan = [&] {
    plan = plan_in(folder, arguments);
    report.reset();
    if (plan.text) {
      host::write_file(folder / "route.plan", *plan.text);
      report = judged(folder / "route.plan", *planned, arguments.overrides, arguments.gate);
    }
  };
  if (tries.result.accepted) {
    judge_plan();
  }
  // What an aeroplane's flight lacks of its limits of height, the next route keeps from them.
  constexpr int kAgain = 2;
  constexpr double kMore = 3;  // metres
  for (int n = 0; n < kAgain && wish.turn_radius_m && report && !report->passed(); ++n) {
    const double lacking = lacking_m(*report);
    if (lacking == 0) {
      break;
    }
    host::RouteWish farther = wish;
    farther.kept_m += std::ceil(lacking) + kMore;
    if (auto& circle_m = farther.points.back().above_ground_m; is_circle_low(*report) && circle_m) {
      *circle_m += std::ceil(lacking) + kMore;
    }
    host::FirstRoute next(farther, arguments.overrides.plugin_path);
    if (interrupt.happened() ||
        (next.flown_margin() == planned->flown_margin() && !is_circle_low(*report))) {
      break;
    }
    tries.run(next);
    if (!tries.result.accepted) {
      tries.run(*planned);
      break;
    }
    wish = farther;
    planned.emplace(std::move(next));
    judge_plan();
  }
  const host::FirstRoute& first = *planned;
  const host::RunResult& result = tries.result;
  std::vector<std::string> reasons;
  if (!result.accepted && !interrupt.happened()) {
    reasons = reasons_of({wish, arguments.overrides, folder, tries.attempt}, interrupt);
  }
  interrupt.finish();
  for (const std::string& line : tries.files.choices) {
    std::printf("%s\n", line.c_str());
  }
  print_runways(wish, arguments);
  print_zones(result, tries.files.zone_layers);
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
  say(plan.messages);
  if (!plan.items.empty()) {
    std::printf("items: %s\n", plan.items.c_str());
  }
  draw_page(folder, arguments.overrides);
  std::printf("written: %s/: page.html, %sresult.json, scenario.yaml, pipeline.yaml\n",
              folder.c_str(), plan.text ? "route.plan, " : "");
  unfinished->is_finished();
  if (!report) {
    return kNoRoute;
  }
  print_check(*report);
  return report->passed() ? kDone : kNoRoute;
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
    take_vehicle(given);
    expect_runways_fit(given);
  };
  auto [command, arguments] = add_command<GoArguments>(
      app, action, "go", "a first route between two points, without YAML", go, prepare);
  add_points(command, arguments);
  add_first_options(command, arguments, "the model's name");
  command
      .add_option("--vtol RADIUS", arguments.vtol_radius_m,
                  "plan for a VTOL with this turn radius on wings, which takes off and lands in "
                  "hover")
      ->check(number_from(1, 5000));
  command
      .add_option("--autopilot NAME", arguments.autopilot,
                  "who flies it: ardupilot (default) or px4")
      ->check(Check::one_of({"ardupilot", "px4"}));
  command.add_flag("--takeoff", arguments.takeoff,
                   "begin on the ground (a copter and a VTOL do in any case)");
  command.add_flag(
      "--land", arguments.land,
      "end on the ground (a copter and a VTOL do in any case); an aeroplane's approach "
      "is "
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
