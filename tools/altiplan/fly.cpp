// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <filesystem>
#include <iostream>

#include "flight_text.hpp"
#include "host/base/output_file.hpp"
#include "host/import_export/imported_route.hpp"
#include "host/result/result_json.hpp"
#include "host/run/pipeline.hpp"
#include "link/failsafe.hpp"
#include "link/linked_vehicle.hpp"
#include "link/vehicle_words.hpp"
#include "plan_upload.hpp"
#include "route_export.hpp"

namespace altiplan::cli {
namespace {

struct FlyArguments {
  RouteExport route;
  LinkOptions link;
  std::optional<std::string> out;
  FenceOptions fence;
  bool arm = false;
  bool command = false;
  bool accept_failsafe = false;

  /// "result.flown.json" beside result.json.
  std::string file() const {
    return out.value_or(
        std::filesystem::path(route.result).replace_extension(".flown.json").string());
  }
};

void tell_user(const std::string& message) { std::cerr << "altiplan: " + message + "\n"; }

/// False, and said, for an aeroplane's route on a multirotor, or the reverse.
bool is_of_kind(const link::Vehicle& vehicle, bool is_wing) {
  if (link::is_fixed_wing(vehicle.heartbeat) == is_wing) {
    return true;
  }
  tell_user(std::string("the route is ") + (is_wing ? "an aeroplane's" : "a multirotor's") +
            ", and the vehicle is a " + link::type_in_words(vehicle.heartbeat) +
            ": nothing was uploaded");
  return false;
}

/// Says what the vehicle does when everything that commands it dies; false where that is neither a
/// hold nor a return, and not accepted.
bool accepts_failsafe(Connection& connection, bool accepted) {
  const link::Failsafe failsafe =
      link::read_failsafe(connection.link, connection.vehicle, connection.stop);
  const bool goes_on = failsafe.is_safe || accepted;
  tell_user("when nothing reaches the vehicle any more, " + failsafe.words +
            (goes_on ? ""
                     : ": neither a hold nor a return, so nothing was uploaded; --accept-failsafe "
                       "commands it all the same"));
  return goes_on;
}

/// The places of the mission's items along the route, in local metres; a landing is not part of it.
std::vector<Vec3> places_of(const host::MissionText& text, const LoadedRoute& loaded) {
  std::vector<Vec3> places;
  for (const formats::MissionItem& item : text.mission.items) {
    if (item.kind != formats::MissionItem::Kind::land) {
      places.push_back(host::to_local(item.at, text.mission.home, loaded.mission.known));
    }
  }
  places.front() = loaded.source.route.front();  // without the rounding of the projection
  return places;
}

/// That of each item that the vehicle holds: a command before it flies to the same place.
std::vector<Vec3> by_number(const host::Plan& plan, const std::vector<Vec3>& places) {
  std::vector<Vec3> numbered;
  std::size_t place = 0;
  for (const host::PlanItem& item : plan.items) {
    if (place < places.size()) {
      numbered.push_back(places[place]);
      place += item.command == host::Command::kChangeSpeed ? 0 : 1;
    }
  }
  return numbered;
}

/// The pipeline with a flight at its end.
host::Config with_flight(host::Config config) {
  if (config.steps.back().verb != host::Verb::fly) {
    host::StepEntry step;
    step.verb = host::Verb::fly;
    step.plugin = host::kFollowRoute;
    step.id = "fly";
    config.steps.push_back(std::move(step));
  }
  return config;
}

/// The stored result with this flight in place of its own.
host::Json with_flight_of(const host::RunResult& result, const host::Config& config,
                          host::Json stored) {
  const host::Json flown = host::result_json(config, result);
  for (const char* key : {"folder", "status", "reason", "message", "flight"}) {
    stored[key] = flown.at(key);
  }
  host::Json& steps = stored["steps"];
  const host::Json& step = flown.at("steps").back();
  if (step.at("verb") == "fly") {
    while (!steps.empty() && steps.back().at("verb") == "fly") {
      steps.erase(steps.size() - 1);
    }
    steps.push_back(step);
  }
  return stored;
}

host::RunResult flown(const host::Config& config, const std::vector<Vec3>& places,
                      host::FlownVehicle& vehicle, const std::string& file,
                      const std::stop_token& stop) {
  constexpr double kNoLimit = 1e8;  // s: a flight takes what it takes
  host::RunOptions options;
  options.timeout_s = kNoLimit;
  options.stop = stop;
  options.out = file;
  options.real.emplace(host::RealFlight{Route(places), vehicle});
  host::ProcessGuard process;
  options.process = &process;
  options.on_call = [&](const host::RunResult& result) {
    host::ProcessGuard::CrashReport words;
    words.for_user = "altiplan: " + result.message + "\n";
    process.set_crash_report(words);
  };
  options.on_stuck = [&](const host::RunResult& result) {
    std::cerr << "altiplan: " << result.message << std::endl;
    _exit(stop.stop_requested() ? kInterrupted : kBadPlugin);
  };
  return host::run(config, options);
}

int fly(const FlyArguments& arguments, const LoadedRoute& loaded, const host::Exported& written,
        const host::Plan& plan, Connection& connection) {
  const host::Config config = with_flight(loaded.config);
  const std::vector<Vec3> places = places_of(written.mission, loaded);
  link::LinkedFlight flight;
  flight.items = by_number(plan, places);
  flight.arm = arguments.arm;
  flight.command = arguments.command;
  flight.say = tell_user;
  link::LinkedVehicle vehicle(connection.link, connection.vehicle, loaded.mission.known, flight,
                              connection.stop);
  host::RunResult result = flown(config, places, vehicle, arguments.file(), connection.stop);
  if (result.flight) {
    result.flight->link = arguments.link.address;
    print_flight(stdout, *result.flight, false);
  }
  host::write_file(arguments.file(),
                   host::file_text(with_flight_of(result, config, loaded.stored.json)));
  std::printf("  %s\n  written to %s\n", result.message.c_str(), arguments.file().c_str());
  return connection.stop.stop_requested() ? kInterrupted : result.exit_code();
}

int fly_result(const FlyArguments& arguments) {
  expect_writable(arguments.file(), "--out");
  const std::optional<LoadedRoute> source = loaded(arguments.route, arguments.file());
  if (!source) {
    return kNoRoute;
  }
  const host::StepEntry& last = source->config.steps.back();
  if (last.verb == host::Verb::fly && last.fly.command == "always" && !arguments.command) {
    std::cerr << "altiplan: the pipeline's flight has command: always, which needs --command\n";
    return kUsage;
  }
  const std::optional<host::Exported> written = exported(*source, arguments.route);
  if (!written) {
    return kNoRoute;
  }
  host::Plan plan = plan_to_upload(*written);
  if (const auto& wing = source->mission.request.vehicle.wing) {
    // An aeroplane's mission ends where this judges that it has arrived, not at the distance at
    // which it turns at waypoints.
    const std::size_t goal = plan.items.size() - (arguments.route.options.land ? 2 : 1);
    plan.items[goal].params[1] = std::floor(wing->turn_radius() / 2);
  }
  return connected(arguments.link, [&](Connection& connection) {
    const bool is_ready =
        is_of_kind(connection.vehicle, source->mission.request.vehicle.wing.has_value()) &&
        (!arguments.command || accepts_failsafe(connection, arguments.accept_failsafe));
    if (is_ready) {
      tell_refusals(connection.vehicle, formats::read_mission("route.plan", *written->text));
    }
    return is_ready && upload_plan(connection, plan, arguments.fence)
               ? fly(arguments, *source, *written, plan, connection)
               : kNoRoute;
  });
}
}  // namespace

void add_fly(App& app, Action& action) {
  const auto prepare = [](FlyArguments& arguments) {
    if (arguments.route.arcs == "loiter") {
      throw UsageError{"fly follows legs between points: give --arcs points"};
    }
    arguments.route.options.format = &host::format_named("qgc-plan");
    finish_options(arguments.route);
  };
  auto [command, arguments] = add_command<FlyArguments>(
      app, action, "fly", "upload a result's route to a vehicle, follow its flight and judge it",
      fly_result, prepare);
  add_link_options(command, "--link", arguments.link);
  add_route_export(command, arguments.route, false);
  add_fence_options(command, arguments.fence);
  command.add_flag("--arm", arguments.arm, "arm the vehicle and start its mission");
  command.add_flag("--command", arguments.command,
                   "let the pipeline's local planner command the vehicle off its mission, and "
                   "back");
  command.add_flag("--accept-failsafe", arguments.accept_failsafe,
                   "with --command: whatever the vehicle does when nothing reaches it any more");
  command.add_option("-o,--out FILE", arguments.out,
                     "write the result with the flight to this file (JSON, default: "
                     "RESULT.flown.json)");
  set_example(command,
              "altiplan fly result.json --link udp:127.0.0.1:14550 --takeoff --arm --command");
}
}  // namespace altiplan::cli
