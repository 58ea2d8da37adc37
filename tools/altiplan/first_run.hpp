// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "commands.hpp"
#include "guarded_run.hpp"
#include "host/base/unfinished.hpp"
#include "host/first_route/first_route.hpp"
#include "host/gate/plan_report.hpp"

namespace altiplan::cli {

/// What the commands that need no YAML have in common.
struct FirstArguments {
  std::vector<std::string> terrain;
  std::vector<std::string> avoid;
  std::optional<std::string> out;
  std::optional<std::string> wind;
  std::optional<std::string> parameters;
  bool copter = false;
  host::RouteWish wish;
  host::GateOptions gate;  ///< in a wind an aeroplane is judged in that strength, from anywhere
  host::Overrides overrides;
};

/// Adds --terrain.
void add_terrain(App& command, FirstArguments& arguments);
/// Adds the vehicle and the wind, zones, limits of height, battery, planner, time and -o, which is
/// by default `folder`.
void add_first_options(App& command, FirstArguments& arguments, const std::string& folder);
/// Reads the autopilot's parameters and the wind into the wish and the gate.
void read_vehicle(FirstArguments& arguments);
/// The wish with models and zones, without points.
host::RouteWish wish_of_first(const FirstArguments& arguments);
/// Finite numbers separated by commas; none if the text is anything else.
std::optional<std::vector<double>> numbers(const std::string& text);
/// The error message for LON,LAT[,AGL]; "" if it is valid.
std::string point_problem(const std::string& text);
host::WishedPoint point_of(const char* option, const std::string& text);

/// The folder asked for, or one named after the file, numbered if there are others.
std::filesystem::path new_folder(const FirstArguments& arguments,
                                 const std::filesystem::path& after);
/// Creates the folder, to be removed again unless it is finished.
std::unique_ptr<host::Unfinished> created(const std::filesystem::path& folder);

/// How many zones of each file count, as its layer says.
void print_zones(const host::RunResult& result, const std::vector<std::string>& layers);
/// The world in which missions about these positions are judged as they are flown.
host::Mission flown_world(const host::FirstRoute& first, const host::Overrides& overrides,
                          const std::vector<LonLat>& about);
/// The verdict on a mission as autopilots fly it.
host::PlanReport judged(const std::string& file, const host::FirstRoute& first,
                        const host::Overrides& overrides, const host::GateOptions& options);
void print_check(const host::PlanReport& report);

/// The files of a try, written to that folder and run; the result is written beside them. Throws
/// Error without the place in the files, which the user has not written.
host::RunResult run_in(const std::filesystem::path& folder, const host::FirstFiles& files,
                       const host::Overrides& overrides, Interrupt& interrupt);

/// A try of a wish that has ended without a route.
struct FailedTry {
  host::RouteWish wish;
  host::Overrides overrides;
  std::filesystem::path folder;  ///< with its scenario and pipeline
  int attempt = 0;
};

/// Why there is no route, as far as a run without the zones, or without the limit above, tells:
/// sentences. The runs leave no files.
std::vector<std::string> reasons_of(const FailedTry& failed, Interrupt& interrupt);
}  // namespace altiplan::cli
