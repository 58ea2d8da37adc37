// SPDX-License-Identifier: Apache-2.0
#include "first_run.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>

#include "altiplan/drawing.hpp"
#include "commands.hpp"
#include "host/base/output_file.hpp"
#include "host/base/unfinished.hpp"
#include "host/base/words.hpp"
#include "host/mission/mission.hpp"
#include "host/result/result_json.hpp"
#include "mission_options.hpp"
#include "plan_world.hpp"
#include "progress.hpp"

namespace altiplan::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kNamed = 4;  ///< zones in a sentence

/// Names of the keep-out zones that the route enters, or comes nearer to than the buffer, quoted.
std::vector<std::string> zones_entered(const World& world, const Polyline& route,
                                       double buffer_m = 0) {
  std::vector<std::string> names;
  for (const Layer& layer : world.layers()) {
    const std::optional<Drawing> drawing = layer.environment->drawing();
    if (layer.plugin != "zones" || !drawing) {
      continue;
    }
    for (const Drawn& zone : drawing->shapes) {
      const auto enters = [&](std::size_t n) {
        const Vec3& to = route[std::min(n + 1, route.size() - 1)];
        return leg_depth(zone.shape, route[n], to) > 0 ||
               comes_within(zone.shape, route[n], to, buffer_m);
      };
      for (std::size_t n = 0; zone.role == Drawn::Role::keep_out && n < route.size(); ++n) {
        if (enters(n)) {
          names.push_back("'" + (zone.name.empty() ? layer.id : zone.name) + "'");
          break;
        }
      }
    }
  }
  return names;
}

/// A route for a wish that asks for less; empty if there is none either.
Polyline route_of(const FailedTry& failed, const host::RouteWish& wish, Interrupt& interrupt) {
  const fs::path folder = failed.folder / "without";
  fs::create_directory(folder);
  const host::Unfinished removed([folder] {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  });
  const host::FirstRoute less(wish, failed.overrides.plugin_path);
  const host::RunResult result =
      run_in(folder, less.files(failed.attempt, folder), failed.overrides, interrupt);
  return result.accepted ? result.steps[*result.accepted].route.waypoints() : Polyline{};
}

std::string kilometres(const Polyline& route) {
  return host::with_digits(length(route) / 1000, 4) + " km";
}

/// Where a point lies that zones close: "in 'Prison'", "outside 'County'"; "" if none does.
std::string where_in_zones(const World& world, const Vec3& at, double buffer_m) {
  const std::string near = "within --buffer, " + host::with_digits(buffer_m, 4) + " m, of ";
  for (const double reach : {0.0, buffer_m}) {
    const std::vector<std::string> names = zones_entered(world, {at, at}, reach);
    if (!names.empty()) {
      return (reach > 0 ? near : "in ") + host::listed(names, kNamed);
    }
  }
  for (const Layer& layer : world.layers()) {
    const std::optional<Drawing> drawing = layer.environment->drawing();
    if (layer.plugin == "zones" && drawing && layer.environment->blocked(at, at, 0)) {
      return "outside '" + name_at(*drawing, at) + "'" +
             (buffer_m > 0 ? ", or " + near + "its border" : "");
    }
  }
  return "";
}

/// Of points that lie where zones close, which no route can leave.
std::vector<std::string> ends_in_zones(const host::Mission& mission, double buffer_m) {
  std::vector<std::string> sentences;
  const auto add = [&](const std::string& what, const Vec3& at) {
    const std::string where = where_in_zones(mission.truth, at, buffer_m);
    if (!where.empty()) {
      sentences.push_back(what + " lies " + where);
    }
  };
  add("the start", mission.request.start.position);
  for (const Goal& via : mission.via) {
    add("a point to pass through", via.position);
  }
  add("the goal", mission.request.goal.position);
  return sentences;
}

/// The error message for M/S,DEGREES; "" if it is valid.
std::string wind_problem(const std::string& text) {
  const auto wind = numbers(text);
  return wind && wind->size() == 2 && wind->front() >= 0 && wind->front() <= 100 &&
                 wind->back() >= 0 && wind->back() <= 360
             ? ""
             : "expected M/S,DEGREES (0 to 100; where it comes from, 0 to 360, clockwise from "
               "north), without spaces, found '" +
                   text + "'";
}

/// What flies, and in which wind.
void add_vehicle(App& command, FirstArguments& arguments) {
  host::RouteWish& wish = arguments.wish;
  auto* copter = command.add_flag("--copter", arguments.copter, "plan for a copter (default)");
  command
      .add_option("--wing RADIUS", wish.turn_radius_m,
                  "plan for an aeroplane with this turn radius")
      ->check(number_from(1, 5000))
      ->excludes(copter);
  const auto rate = [&](const char* name, std::optional<double>& value, const char* what) {
    command.add_option(std::string(name) + " M/S", value, what)->check(number_from(0.1, 200));
  };
  rate("--speed", wish.speed_mps, "speed through the air (default: chosen)");
  rate(
      "--climb", wish.climb_mps,
      "greatest rates of climb and sink (default: of an aeroplane 10 degrees, of a copter those of "
      "ArduPilot's defaults)");
  command.add_option("--params FILE", arguments.parameters,
                     "the autopilot's parameters (.param, .params), in place of its defaults");
  command.add_option("--wind M/S,DEGREES", arguments.wind, "wind, and where it comes from")
      ->check(wind_problem);
}
}  // namespace

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

void add_terrain(App& command, FirstArguments& arguments) {
  command
      .add_option("--terrain DEM", arguments.terrain,
                  "elevation models, or a folder of tiles; repeatable")
      ->required()
      ->take_all();
}

void add_first_options(App& command, FirstArguments& arguments, const std::string& folder) {
  host::RouteWish& wish = arguments.wish;
  add_vehicle(command, arguments);
  auto* avoid = command
                    .add_option("--avoid FILE", arguments.avoid,
                                "zones: published airspace, GeoJSON, KML, or a fence; repeatable")
                    ->take_all();
  add_permission(command, wish.permitted)->needs(avoid);
  add_buffer(command, wish.buffer_m)->needs(avoid);
  const auto metres = [&](const char* name, std::optional<double>& value, const char* what) {
    return command.add_option(std::string(name) + " METRES", value, what)
        ->check(number_from(0, 1e4));
  };
  metres("--min-agl", wish.min_above_ground_m, "minimum height above ground (default 50)");
  metres("--max-agl", wish.max_above_ground_m, "greatest height above ground (default none)");
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
  command.add_option("-o,--out DIR", arguments.out, "new folder (default: " + folder + ")");
}

void read_vehicle(FirstArguments& arguments) {
  if (arguments.parameters) {
    arguments.gate.flight.parameters = host::read_parameters(*arguments.parameters);
    arguments.wish.parameters = arguments.gate.flight.parameters;
  }
  if (arguments.wind) {
    const std::vector<double> wind = numbers(*arguments.wind).value();
    arguments.wish.wind = {wind.front(), wind.back()};
    arguments.gate.flight.wind_mps = wind.front();
  }
}

host::RouteWish wish_of_first(const FirstArguments& arguments) {
  host::RouteWish wish = arguments.wish;
  wish.terrain.assign(arguments.terrain.begin(), arguments.terrain.end());
  wish.avoid.assign(arguments.avoid.begin(), arguments.avoid.end());
  return wish;
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

fs::path new_folder(const FirstArguments& arguments, const fs::path& after) {
  const std::string stem = after.stem().string();
  fs::path folder = arguments.out.value_or(stem);
  for (int n = 2; !arguments.out && fs::exists(folder); ++n) {
    folder = stem + "_" + std::to_string(n);
  }
  return folder;
}

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

void print_zones(const host::RunResult& result, const std::vector<std::string>& layers) {
  for (const std::string& layer : layers) {
    for (const std::string& note : result.notes) {
      if (note.starts_with(layer + ": ")) {
        std::printf("zones: %s\n", note.c_str());
      }
    }
  }
}

host::Mission flown_world(const host::FirstRoute& first, const host::Overrides& overrides,
                          const std::vector<LonLat>& about) {
  host::Config config =
      host::load_scenario_text(first.flown_scenario(), "the world of go", overrides);
  config.is_only_judged = true;
  config.about = about;
  return host::build_mission(config, 1);
}

host::PlanReport judged(const std::string& file, const host::FirstRoute& first,
                        const host::Overrides& overrides, const host::GateOptions& options) {
  const formats::MissionFile mission = formats::read_mission(file);
  return busy("judging the mission", [&] {
    return host::judge_plan(file, mission, flown_world(first, overrides, positions_of(mission)),
                            options);
  });
}

void print_check(const host::PlanReport& report) {
  std::printf("check: %s, flown by %s, %s\n", word_of(report.verdict()),
              report.autopilots.front().name().c_str(), time_in_words(report.time).c_str());
  for (const host::Finding& finding : report.findings) {
    std::printf("  %s: %s\n", finding.items.back().c_str(), finding.violation.message.c_str());
  }
}

host::RunResult run_in(const fs::path& folder, const host::FirstFiles& files,
                       const host::Overrides& overrides, Interrupt& interrupt) {
  host::write_file(folder / "scenario.yaml", files.scenario);
  host::write_file(folder / "pipeline.yaml", files.pipeline);
  try {
    const host::Config config = host::load_config(folder / "pipeline.yaml", overrides);
    const std::string out = folder / "result.json";
    const HandOut hand_out = [&](std::FILE* to, const host::RunResult& result) {
      host::write_file(out, host::file_text(host::result_json(config, result)));
      std::fprintf(to, "no route: %s\n", result.message.c_str());
      return result.exit_code();
    };
    host::RunResult result = guarded_run(config, {}, {out, false}, interrupt, hand_out);
    host::write_file(out, host::file_text(host::result_json(config, result)));
    return result;
  } catch (const ConfigError& error) {
    throw Error(error.problems().front().message);
  }
}

std::vector<std::string> reasons_of(const FailedTry& failed, Interrupt& interrupt) {
  const host::Mission mission =
      host::build_mission(host::load_config(failed.folder / "pipeline.yaml", failed.overrides), 1);
  std::vector<std::string> reasons = ends_in_zones(mission, failed.wish.buffer_m);
  // The first thing to give up that a route is found without; empty where it is not tried.
  const auto found_without = [&](bool is_given, const auto& give_up) {
    if (!is_given || !reasons.empty() || interrupt.happened()) {
      return Polyline{};
    }
    host::RouteWish wish = failed.wish;
    give_up(wish);
    return route_of(failed, wish, interrupt);
  };
  Polyline route = found_without(failed.wish.planner.has_value(),
                                 [](host::RouteWish& wish) { wish.planner.reset(); });
  if (!route.empty()) {
    reasons.push_back("--planner " + *failed.wish.planner + ": without it a route of " +
                      kilometres(route) + " is found within the same limits");
  }
  const double buffer_m = failed.wish.buffer_m;
  route = found_without(buffer_m > 0, [](host::RouteWish& wish) { wish.buffer_m = 0; });
  if (!route.empty()) {
    const std::vector<std::string> names = zones_entered(mission.truth, route, buffer_m);
    reasons.push_back(
        "--buffer " + host::with_digits(buffer_m, 4) + " is too much: without it a route of " +
        kilometres(route) + " is found" +
        (names.empty() ? "" : ", which comes nearer to " + host::listed(names, kNamed)));
  }
  route =
      found_without(!failed.wish.avoid.empty(), [](host::RouteWish& wish) { wish.avoid.clear(); });
  if (!route.empty()) {
    const std::vector<std::string> names = zones_entered(mission.truth, route);
    reasons.push_back("the zones close every way: without them a route of " + kilometres(route) +
                      " is found" +
                      (names.empty() ? "" : ", which enters " + host::listed(names, kNamed)));
  }
  for (const double times : {1.5, 2.0, 3.0, 5.0, kInfinity}) {
    const double limit = std::ceil(times * failed.wish.max_above_ground_m.value_or(0));
    route = found_without(failed.wish.max_above_ground_m.has_value(), [&](host::RouteWish& wish) {
      wish.min_above_ground_m = host::heights_of(wish).min_m;
      wish.max_above_ground_m = std::isfinite(limit) ? std::optional(limit) : std::nullopt;
    });
    if (!route.empty()) {
      reasons.push_back("--max-agl is too low: " +
                        (std::isfinite(limit) ? "up to " + host::with_digits(limit, 4) + " m"
                                              : std::string("without it")) +
                        " a route of " + kilometres(route) + " is found");
      break;
    }
  }
  return reasons;
}
}  // namespace altiplan::cli
