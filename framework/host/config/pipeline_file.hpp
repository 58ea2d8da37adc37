// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/config/scenario_file.hpp"

namespace altiplan::host {

/// A smoother and its parameters, for replanned routes.
struct SmootherEntry {
  std::string plugin;
  Value parameters;
  void describe(Fields& f);
};

/// Keys of `fly` only.
struct FlyKeys {
  Value replan;  ///< id of a plan step, or {plan: …, with: …}; an empty scalar if not given
  std::string when = "unsafe";
  std::vector<SmootherEntry> smooth;
  std::string command = "near";
  double step_s = 1;
  double replan_latency_s = 1;
  std::optional<double> max_time_s;
  void describe(Fields& f);
};

inline Value empty_map() {
  Value map;
  map.kind = Value::Kind::map;
  return map;
}

enum class Verb { plan, smooth, returns, fly };
const char* name(Verb verb);

/// `fly: route` has no pilot: the vehicle just follows the route.
inline constexpr const char* kFollowRoute = "route";

/// A step: one verb and a plugin's name (of `returns` an autopilot's), the plugin's parameters, and
/// the host's keys.
struct StepEntry {
  Verb verb = Verb::plan;
  std::string plugin;
  std::string id;
  Value with = empty_map();
  std::optional<std::string> from;
  std::optional<double> within_s;
  std::optional<std::int64_t> within_iterations;
  std::optional<double> within_mb;
  std::vector<Value> alternatives;   ///< `else`: step maps, bound by the configuration
  std::vector<StepEntry> otherwise;  ///< `alternatives`, bound
  FlyKeys fly;
  std::optional<Path> params;  ///< of `returns`
  Location where;
  std::string path;  ///< "steps.0.else.1"
  void describe(Fields& f);
};

struct PipelineFile {
  int altiplan = 0;
  std::string name;
  std::optional<Path> scenario;
  std::int64_t seed = 0;
  std::vector<Path> plugins;
  std::vector<ConstraintEntry> constraints;
  std::optional<ObjectiveEntry> objective;
  std::vector<MetricEntry> metrics;
  std::vector<Value> steps;  ///< step maps, bound by the configuration
  void describe(Fields& f);
};
}  // namespace altiplan::host
