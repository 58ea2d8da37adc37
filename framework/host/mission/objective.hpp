// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/objective.hpp"
#include "host/config/config.hpp"

namespace altiplan::host {

/// The objective in force, in the world of `site`; null: length. Throws as build_layer does, and
/// ConfigError where the planner of a step cannot minimise it.
std::shared_ptr<const Objective> objective_of(const Config& config, const Site& site);

/// The same as far as can be told without the world, which some objectives need to be made.
void expect_minimised(const Config& config);

/// The constraint `limit` of these parameters, whose key in the files is `key`. Throws likewise.
std::shared_ptr<const Constraint> limit_of(const Config& config, const Value& parameters,
                                           const Site& site, const std::string& key);

/// An objective that routes are measured by, under its name in results.
struct Metric {
  std::string name;
  std::shared_ptr<const Objective> of;
};

/// Costs by such objectives, by name.
using MetricValues = std::vector<std::pair<std::string, double>>;

/// Those of the scenario, then those of the pipeline; `calling` as of build_mission. Throws as
/// build_layer does.
std::vector<Metric> metrics_of(const Config& config, const Site& site,
                               const std::function<void(const std::string&)>& calling);

/// Costs of a route by each.
MetricValues measured(const Route& route, const Request& request,
                      const std::vector<Metric>& metrics);
/// Costs of a track of times (s) and places, whose first is the start.
MetricValues measured(const std::vector<std::pair<double, Vec3>>& track, const Request& request,
                      const std::vector<Metric>& metrics);
}  // namespace altiplan::host
