// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "altiplan/request.hpp"
#include "altiplan/task.hpp"
#include "host/config/config.hpp"
#include "host/judge/runways.hpp"
#include "host/mission/objective.hpp"

namespace altiplan::host {

/// A scenario as built: its worlds, and the problem passed to every step of a pipeline.
struct Mission {
  World truth;  ///< every layer and moving obstacle
  World known;  ///< known to planners at take-off
  Site site;    ///< for building layers of events later; its `before` is not set
  /// The problem in the known world, with the limits and constraints that apply to routes.
  Request request;
  /// The same with those that apply to tracks.
  Request track_request;
  std::vector<Goal> via;
  Runways runways;  ///< an aeroplane's, whose ends are the first and the last of the via points
  /// What is to be done; until its passes are ordered, start and goal are where the scenario gives
  /// them, or nowhere in particular. Null: nothing.
  std::shared_ptr<const Task> task;
  TaskEnds ends;                ///< of the task, as far as the scenario gives them
  std::vector<Metric> metrics;  ///< by which routes and tracks are measured
  VehicleType vehicle_type = VehicleType::copter;
  std::vector<std::string> notes;     ///< notes of the layers
  std::vector<std::string> warnings;  ///< for the user to check
  double setup_time_s = 0;            ///< wall time of building the layers
};

using NoteSink = std::function<void(const std::string&)>;

/// Builds layers, volume, points and limits. Throws ConfigError naming the location in the scenario
/// for errors in the files, PluginError for a plugin that misbehaves. `calling` receives the name
/// of the plugin about to be called, "" when all are done; `on_note` each note as it arises, so
/// that those before an error are not lost.
Mission build_mission(const Config& config, int threads,
                      const std::function<void(const std::string&)>& calling = {},
                      const NoteSink& on_note = {});

/// The order of the mission's task, the same for the same seed and budget, whoever asks.
TaskOrder order_of_task(const Mission& mission, Budget budget);

/// Builds a layer in the same way as the scenario's own.
Layer build_layer(const Config& config, const std::string& plugin_name, const Value& parameters,
                  const std::string& id, bool known, Site site, const std::string& key);

/// The scenario's point in local metres; `key` is its key in the file.
Vec3 resolve_point(const Point& point, const Site& site, const std::optional<double>& level_m,
                   const Location& where, const std::string& key);
}  // namespace altiplan::host
