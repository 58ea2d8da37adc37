// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "commands.hpp"
#include "host/flight/track_judge.hpp"
#include "host/output/result_json.hpp"
#include "host/run/events.hpp"
#include "host/run/judge.hpp"
#include "host/run/mission.hpp"

namespace altiplan::cli {
namespace {

struct Arguments {
  std::optional<std::string> result;
  std::optional<std::string> route;
  std::optional<std::string> scenario;
  host::Overrides overrides;
  bool json = false;
};

host::Json read_json(const std::string& file, const std::string& expected) {
  if (std::filesystem::is_directory(file)) {
    throw Error("'" + file + "' is a folder, expected a JSON file");
  }
  std::ifstream in(file);
  if (!in) {
    throw Error("cannot read '" + file + "': " + std::strerror(errno));
  }
  try {
    return host::Json::parse(in);
  } catch (const host::Json::parse_error& error) {
    in.clear();
    in.seekg(0);
    std::string before(error.byte > 0 ? error.byte - 1 : 0, '\0');
    in.read(before.data(), std::streamsize(before.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    throw Error(file + ":" + std::to_string(line) + ": this is not JSON: expected " + expected);
  } catch (const host::Json::out_of_range&) {
    throw Error(file + ": holds a number that is too large (beyond 1.8e308)");
  }
}

Route route_of(const host::Json& json, const std::string& file) {
  Route route;
  try {
    for (const host::Json& p : json.get_ref<const host::Json::array_t&>()) {  // or it throws
      if (p.is_array() && p.size() != 3) {
        throw Error(file + ": expected points of three numbers, found one of " +
                    std::to_string(p.size()));
      }
      route.emplace_back(p.at(0).get<double>(), p.at(1).get<double>(), p.at(2).get<double>());
    }
  } catch (const host::Json::exception&) {
    throw Error(file + ": expected a route as a list of [x, y, z] in metres");
  }
  if (route.empty()) {
    throw Error(file + ": there is no route in it");
  }
  return route;
}

void print_violations(const CheckResult& verdict, const char* point) {
  for (const Violation& violation : verdict.violations) {
    std::printf("  %s %zu, %s: %s\n", point, violation.at, violation.constraint.c_str(),
                violation.message.c_str());
  }
}

void print_route(const CheckResult& verdict, const Measures& measures) {
  std::printf("%s: %zu waypoints, %s km, clearance %s m, %s m above ground\n",
              verdict.ok() ? "sound" : "not sound", measures.waypoints,
              fixed(measures.length_m / 1000, 3).c_str(),
              fixed(measures.min_clearance_m, 2).c_str(),
              fixed(measures.min_ground_clearance_m, 2).c_str());
  print_violations(verdict, "waypoint");
}

void print_track(const host::TrackVerdict& verdict, const host::Track& track, bool has_events) {
  std::printf("flight %s: %zu points, %s s, %d collision%s, %s\n",
              verdict.check.ok() ? "sound" : "not sound", track.size(),
              fixed(track.back().first, 0).c_str(), verdict.collisions,
              verdict.collisions == 1 ? "" : "s",
              verdict.reached ? "reached the goal" : "did not reach the goal");
  print_violations(verdict.check, "point");
  if (has_events) {
    std::printf("  each event was applied at the first point at or after it\n");
  }
}

/// The verdicts, printed; a flight only where there is one.
int report(const host::Mission& mission, const Route& route,
           const std::optional<host::Track>& track, const std::vector<host::FlightEvent>& events,
           bool as_json) {
  const CheckResult verdict = host::judge(route, mission.request, mission.via);
  const Measures measures = measure(route, mission.request);
  bool sound = verdict.ok();
  host::Json json{{"check", host::to_json(verdict)}, {"metrics", host::to_json(measures)}};
  if (!as_json) {
    print_route(verdict, measures);
  }
  if (track) {
    host::FlightSetup setup;
    setup.request = mission.track_request;
    setup.truth = mission.truth;
    setup.events = events;
    const host::TrackVerdict flown = host::judge_track(*track, setup);
    sound = sound && flown.check.ok();
    json["flight"] = {{"check", host::to_json(flown.check)},
                      {"collisions", flown.collisions},
                      {"reached", flown.reached}};
    if (!as_json) {
      print_track(flown, *track, !events.empty());
    }
  }
  if (as_json) {
    std::cout << host::file_text(json);
  }
  return sound ? kDone : kNoRoute;
}

host::Track track_of(const host::Json& json, const std::string& file) {
  host::Track track;
  if (!json.is_array()) {
    throw Error(file + ": expected the flight's track as a list of [t, x, y, z]");
  }
  for (const host::Json& point : json) {
    track.emplace_back(
        point.at(0).get<double>(),
        Vec3(point.at(1).get<double>(), point.at(2).get<double>(), point.at(3).get<double>()));
    if (track.size() > 1 && track.back().first < track[track.size() - 2].first) {
      throw Error(file + ": point " + std::to_string(track.size() - 1) +
                  " of the flight's track is earlier than the one before it");
    }
  }
  if (track.empty()) {
    throw Error(file + ": the flight has no track");
  }
  return track;
}

/// The overrides with which a stored run was made.
host::Overrides stored_overrides(const host::Json& json, const std::string& file,
                                 host::Overrides overrides) {
  overrides.scenario = json.at("scenario").get<std::string>();
  if (json.at("seed").is_number_float()) {
    throw Error(file + ": seed: expected a whole number, found " + json.at("seed").dump());
  }
  overrides.seed = json.at("seed").get<std::int64_t>();
  const host::Json& stored = json.at("overrides");
  if (stored.contains("set")) {
    for (const auto& [key, value] : stored.at("set").items()) {
      overrides.set.push_back(key + "=" + value.get<std::string>());
    }
  }
  return overrides;
}

int check_result(const Arguments& arguments) {
  const std::string& file = *arguments.result;
  const host::Json json = read_json(file, "a result of altiplan run");
  host::Overrides overrides;
  std::string pipeline;
  std::optional<host::Track> track;
  try {
    if (!json.is_object() || !json.contains("altiplan") ||
        json.at("altiplan") != host::kFileFormat) {
      throw Error(file + ": expected a result of format 1");
    }
    overrides = stored_overrides(json, file, arguments.overrides);
    pipeline = json.at("pipeline").get<std::string>();
    for (const host::Json& used : json.at("files")) {
      if (host::sha256(used.at("path").get<std::string>()) != used.at("sha256")) {
        warn(used.at("path").get<std::string>() + " is not the file that the result was made from");
      }
    }
    if (json.at("route").is_null()) {
      std::cout << "there is no standing route in " << file << '\n';
      return kNoRoute;
    }
    if (!json.at("flight").is_null()) {
      track = track_of(json.at("flight").at("track"), file);
    }
  } catch (const host::Json::exception& error) {
    const std::string why = error.what();  // "[json.exception.type_error.302] type must be …"
    throw Error(file + ": expected a result of altiplan run: " + why.substr(why.find("] ") + 2));
  }
  const host::Config config = host::load_config(pipeline, overrides);
  const host::Mission mission = host::build_mission(config, 1);
  return report(mission, route_of(json.at("route"), file), track,
                host::build_events(config, mission), arguments.json);
}

int check_route(const Arguments& arguments) {
  const host::Json json = read_json(*arguments.route, "a route as a list of [x, y, z] in metres");
  const Route route = route_of(json.is_object() && json.contains("route") ? json.at("route") : json,
                               *arguments.route);
  const host::Config config = host::load_scenario(*arguments.scenario, arguments.overrides);
  const host::Mission mission = host::build_mission(config, 1);
  return report(mission, route, std::nullopt, {}, arguments.json);
}
}  // namespace

void add_check(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("check", "judge a stored or a foreign route again");
  auto arguments = std::make_shared<Arguments>();
  auto* result = command->add_option("result", arguments->result, "a result of altiplan run");
  auto* route = command
                    ->add_option("--route", arguments->route,
                                 "a route as JSON: [[x, y, z], …] in metres, or a result")
                    ->type_name("FILE")
                    ->excludes(result);
  auto* scenario =
      command->add_option("--scenario", arguments->scenario, "the scenario to judge it in")
          ->type_name("FILE")
          ->excludes(result);
  route->needs(scenario);
  scenario->needs(route);
  add_plugin_path(*command, arguments->overrides);
  command->add_flag("--json", arguments->json, "print JSON");
  set_example(*command, "altiplan check result.json");
  command->callback([&action, arguments] {
    if (!arguments->result && !arguments->route) {
      throw CLI::RequiredError("a result, or --route and --scenario");
    }
    action = [arguments] {
      return arguments->result ? check_result(*arguments) : check_route(*arguments);
    };
  });
}
}  // namespace altiplan::cli
