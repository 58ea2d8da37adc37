// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "altiplan/request.hpp"
#include "host/config/config.hpp"

namespace altiplan::host {

/// A scenario made real: worlds, and the problem as every step of a pipeline gets it.
struct Mission {
  World truth;  ///< every layer and moving obstacle
  World known;  ///< what planners may know at take-off
  Site site;    ///< by which late layers (events) are built; its `before` is not set
  /// The problem in the known world; limits and constraints are those that apply to routes.
  Request request;
  /// The same with those that apply to tracks.
  Request track_request;
  std::vector<Goal> via;
  std::vector<std::string> notes;     ///< what the layers say of themselves
  std::vector<std::string> warnings;  ///< what the user should look at
  double setup_time_s = 0;            ///< wall time of building the layers
};

/// Builds layers, volume, points and limits. Throws ConfigError naming the place in the scenario
/// for what the files got wrong, PluginError for a plugin that misbehaves.
/// `calling` is told who is called next, "" when all are done.
Mission build_mission(const Config& config, int threads,
                      const std::function<void(const std::string&)>& calling = {});

/// Makes a layer as the scenario's own are made.
Layer build_layer(const Config& config, const std::string& plugin_name, const Value& parameters,
                  const std::string& id, bool known, Site site, const std::string& key);

/// The scenario's point in local metres; `key` is its place in the file.
Vec3 resolve_point(const Point& point, const Site& site, const std::optional<double>& level_m,
                   const Location& where, const std::string& key);
}  // namespace altiplan::host
