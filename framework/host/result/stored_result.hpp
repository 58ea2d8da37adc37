// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/config/config.hpp"
#include "host/flight/track_judge.hpp"
#include "host/mission/mission.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::host {

/// What the vehicle does at a place of a task.
struct PlacedStop {
  Vec3 at{0, 0, 0};
  Stop stop{};
};

/// A result.json read back: its route and track, and what is needed to rebuild its world
/// (`load_config(pipeline, overrides)`).
struct StoredResult {
  std::string file;
  Json json;
  std::filesystem::path pipeline;
  Overrides overrides;  ///< of the run
  std::optional<Route> route;
  std::vector<PlacedStop> stops;  ///< of the route's task, in order
  std::optional<Track> track;
  bool telemetry = false;            ///< the track is that of a vehicle at a link
  std::vector<std::string> changed;  ///< input files that have changed since the result was written
};

/// Reads a result; `overrides` may add plugin paths. Throws Error naming the problem.
StoredResult read_result(const std::string& file, const Overrides& overrides);
/// The same for a result stored by a study; `file` is its name in messages.
StoredResult stored_result(const std::string& file, Json content, const Overrides& overrides);

/// Throws Error with the line if the file is not JSON; `expected` describes the expected content.
Json read_json(const std::string& file, const std::string& expected);

/// Throws Error for a point farther away than anything flies: queries of the world would take
/// forever.
void expect_reachable(const Polyline& route, const std::string& file);

/// Ends that a scenario with a task leaves open are those of its route.
void take_open_ends(const Mission& mission, const Route& route, Request& request);

/// Reads the legs of a result or a step, or else its route, or a list of [x, y, z]; `file` is for
/// messages. Throws Error, also for an empty route.
Route route_of(const Json& holder, const std::string& file);
}  // namespace altiplan::host
