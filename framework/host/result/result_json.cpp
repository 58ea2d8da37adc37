// SPDX-License-Identifier: Apache-2.0
#include "host/result/result_json.hpp"

#include "altiplan_build.hpp"
#include "host/result/legs_json.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "host/base/sha256.hpp"

namespace altiplan::host {
namespace {

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json reason_json(Reason reason) {
  return reason == Reason::none ? Json(nullptr) : Json(name(reason));
}

Json counters_json(const Counters& counters) {
  Json json = Json::object();
  for (const Counter& counter : counters) {
    json[counter.name] = counter.value;
  }
  return json;
}

std::int64_t expanded(const StepResult& step) {
  for (const Counter& counter : step.counters) {
    if (counter.name == "expanded") {
      return counter.value;
    }
  }
  return 0;
}

/// Metrics of the whole run: of the accepted route, and of the planning that led to it.
Json run_metrics(const Config& config, const RunResult& result) {
  Json json = to_json(Measures{});
  if (result.accepted) {
    const StepResult& step = result.steps[*result.accepted];
    json = to_json(*step.measures, step.metrics);
  } else {
    for (const auto* entries : {&config.scenario.metrics, &config.pipeline.metrics}) {
      for (const MetricEntry& entry : *entries) {
        json[entry.id] = nullptr;
      }
    }
    for (auto& [key, value] : json.items()) {
      value = nullptr;
    }
  }
  double plan_time = 0;
  double smooth_time = 0;
  std::int64_t nodes = 0;
  for (const StepResult& step : result.steps) {
    if (step.verb == Verb::plan) {
      plan_time += step.time_s;
      nodes += expanded(step);
    } else if (step.verb == Verb::smooth) {
      smooth_time += step.time_s;
    }
  }
  json["plan_time_s"] = plan_time;
  json["smooth_time_s"] = smooth_time;
  json["expanded"] = nodes;
  return json;
}

Json flight_json(const FlightResult& flight) {
  Json json;
  json["status"] = name(flight.status);
  json["reason"] = reason_json(flight.reason);
  json["message"] = flight.message;
  json["link"] = flight.link ? Json(*flight.link) : Json(nullptr);
  json["metrics"] = to_json(flight.measures, flight.metrics);
  json["check"] = to_json(flight.check);
  json["counters"] = counters_json(flight.counters);
  json["collisions"] = flight.collisions;
  json["min_separation_m"] = number(flight.min_separation_m);
  json["reached"] = flight.reached;
  json["cross_track_max_m"] = number(flight.cross_track_max_m);
  json["cross_track_p999_m"] = number(flight.cross_track_p999_m);
  json["height_error_max_m"] = number(flight.height_error_max_m);
  json["handovers"] = Json::array();
  for (const Handover& handover : flight.handovers) {
    json["handovers"].push_back(
        {{"at_s", handover.at_s}, {"to", handover.to}, {"why", handover.why}});
  }
  json["replans"] = Json::array();
  for (const Replan& replan : flight.replans) {
    json["replans"].push_back({{"at_s", replan.at_s},
                               {"step", replan.step},
                               {"status", name(replan.status)},
                               {"reason", reason_json(replan.reason)},
                               {"message", replan.message},
                               {"time_s", replan.time_s},
                               {"counters", counters_json(replan.counters)}});
  }
  json["track"] = Json::array();
  for (const auto& [t, p] : flight.track) {
    json["track"].push_back({t, p.x(), p.y(), p.z()});
  }
  return json;
}

Json lonlat_json(const Route& route, const Frame& frame) {
  if (!frame.has_position()) {
    return nullptr;
  }
  Json json = Json::array();
  for (const Vec3& p : route.chords(kChordTolerance)) {
    const auto at = frame.to_lonlat(p.x(), p.y());
    json.push_back({at[0], at[1], p.z()});
  }
  return json;
}

/// Of passes after which something is done.
Json stops_json(const std::vector<Pass>& passes) {
  Json stops = Json::array();
  for (const Pass& pass : passes) {
    const Vec3& at = pass.points.back();
    const Stop& stop = pass.stop;
    if (stop.acts()) {
      stops.push_back({{"at_m", {at.x(), at.y(), at.z()}},
                       {"hold_s", stop.hold_s},
                       {"lands", stop.lands},
                       {"drops", stop.drops}});
    }
  }
  return stops;
}

/// A map of keys to values; where something is removed, which may happen twice at one key, a list.
Json set_json(const std::vector<std::string>& set) {
  const bool removes = std::any_of(set.begin(), set.end(),
                                   [](const std::string& text) { return text.starts_with('~'); });
  if (removes) {
    return set;
  }
  Json json = Json::object();
  for (const std::string& assignment : set) {
    const std::size_t equals = assignment.find('=');
    json[assignment.substr(0, equals)] = assignment.substr(equals + 1);
  }
  return json;
}

Json overrides_json(const Config& config) {
  Json json = Json::object();
  if (config.overrides.scenario) {
    json["scenario"] = config.scenario_path.string();
  }
  if (config.overrides.seed) {
    json["seed"] = *config.overrides.seed;
  }
  if (!config.overrides.set.empty()) {
    json["set"] = set_json(config.overrides.set);
  }
  return json;
}
}  // namespace

std::vector<std::string> set_texts(const Json& overrides) {
  std::vector<std::string> texts;
  if (const auto set = overrides.find("set"); set != overrides.end()) {
    for (const auto& [key, value] : set->items()) {
      texts.push_back((set->is_object() ? key + "=" : "") + value.get<std::string>());
    }
  }
  return texts;
}

Json plugins_json(const Config& config) {
  std::set<std::pair<std::string, std::string>> used;
  const auto use = [&](std::string_view kind, std::string_view plugin_name) {
    used.emplace(kind, plugin_name);
  };
  for (const LayerEntry& layer : config.scenario.environment) {
    use("environment", layer.plugin);
  }
  for (const EventEntry& event : config.scenario.events) {
    if (event.add) {
      use("environment", event.add->plugin);
    }
  }
  for (const auto* entries : {&config.scenario.constraints, &config.pipeline.constraints}) {
    for (const ConstraintEntry& entry : *entries) {
      use("constraint", entry.plugin);
    }
  }
  for_each_objective(config, [&](const std::string& name, const Value&, const std::string&) {
    use("objective", name);
  });
  if (config.scenario.task) {
    use("task", config.scenario.task->plugin);
  }
  const auto use_step = [&](const StepEntry& step) {
    for (const char* kind : {"planner", "local_planner", "smoother"}) {
      use(kind, step.plugin);
    }
    for (const SmootherEntry& smoother : step.fly.smooth) {
      use("smoother", smoother.plugin);
    }
  };
  for (const StepEntry& step : config.steps) {
    use_step(step);
    for (const StepEntry& other : step.otherwise) {
      use_step(other);
    }
  }
  Json json = Json::array();
  for (const auto& [kind, plugin_name] : used) {
    if (const Library* library = config.registry->offering(kind, std::string(plugin_name))) {
      json.push_back({{"kind", kind},
                      {"name", plugin_name},
                      {"build", library->build},
                      {"checksum", library->checksum}});
    }
  }
  return json;
}

Json to_json(const Route& route) {
  Json json = Json::array();
  for (const Vec3& p : route.chords(kChordTolerance)) {
    json.push_back({number(p.x()), number(p.y()), number(p.z())});
  }
  return json;
}

Json to_json(const CheckResult& check) {
  Json violations = Json::array();
  for (const Violation& violation : check.violations) {
    violations.push_back({{"constraint", violation.constraint},
                          {"at", violation.at},
                          {"value", number(violation.value)},
                          {"limit", number(violation.limit)},
                          {"unit", violation.unit},
                          {"layer", violation.layer},
                          {"message", violation.message}});
  }
  return {{"ok", check.ok()}, {"violations", std::move(violations)}};
}

Json to_json(const Measures& m) {
  return {{"length_m", number(m.length_m)},
          {"waypoints", m.waypoints},
          {"max_turn_deg", number(m.max_turn_deg)},
          {"max_climb_deg", number(m.max_climb_deg)},
          {"min_radius_m", number(m.min_radius_m)},
          {"min_clearance_m", number(m.min_clearance_m)},
          {"min_ground_clearance_m", number(m.min_ground_clearance_m)},
          {"smoothness_rad", number(m.smoothness_rad)},
          {"duration_s", number(m.duration_s)},
          {"time_s", number(m.time_s)},
          {"energy_wh", number(m.energy_wh)}};
}

Json to_json(const Measures& measures, const MetricValues& own) {
  Json json = to_json(measures);
  for (const auto& [name, value] : own) {
    json[name] = number(value);
  }
  return json;
}

Json to_json(const std::optional<Cost>& cost) {
  return {{"cost", cost ? number(cost->cost) : Json(nullptr)},
          {"bound", cost ? number(cost->bound) : Json(nullptr)}};
}

Json to_json(const StepResult& step) {
  Json json;
  json["id"] = step.id;
  json["verb"] = name(step.verb);
  json["plugin"] = step.plugin;
  json["instead_of"] = step.instead_of ? Json(*step.instead_of) : Json(nullptr);
  json["accepted"] = step.accepted;
  json["status"] = name(step.status);
  json["reason"] = reason_json(step.reason);
  json["message"] = step.message;
  json["proved"] = step.proved;
  json["budget_hit"] = step.budget_hit;
  json["time_s"] = step.time_s;
  json["setup_time_s"] = step.setup_time_s;
  if (step.first_route_s) {
    json["first_route_s"] = *step.first_route_s;
  }
  json["counters"] = counters_json(step.counters);
  json["route"] = to_json(step.route);
  json["legs"] = legs_json(step.route);
  json["metrics"] = step.measures ? to_json(*step.measures, step.metrics) : Json(nullptr);
  json["check"] = step.check ? to_json(*step.check) : Json(nullptr);
  json.update(to_json(step.cost));
  if (step.verb == Verb::returns) {
    json["returns"] = step.returns.empty() ? Json(nullptr) : parse_json(step.returns);
  }
  return json;
}

Json result_json(const Config& config, const RunResult& result) {
  Json json;
  json["altiplan"] = kFileFormat;
  json["version"] = ALTIPLAN_VERSION;
  if (result.folder) {
    json["folder"] = *result.folder;
  }
  json["pipeline"] = config.pipeline_path.string();
  json["scenario"] = config.scenario_path.string();
  json["files"] = Json::array();
  for (const auto& file : config.files) {
    json["files"].push_back({{"path", file.string()}, {"sha256", sha256(file)}});
  }
  json["plugins"] = plugins_json(config);
  json["overrides"] = overrides_json(config);
  json["seed"] = config.seed;
  json["status"] = name(result.status);
  json["reason"] = reason_json(result.reason);
  json["message"] = result.message;
  json["budget_hit"] = result.budget_hit;
  json["setup_time_s"] = result.setup_time_s;
  json["steps"] = Json::array();
  for (const StepResult& step : result.steps) {
    json["steps"].push_back(to_json(step));
  }
  const StepResult* accepted = result.accepted ? &result.steps[*result.accepted] : nullptr;
  json["route"] = accepted ? to_json(accepted->route) : Json(nullptr);
  json["legs"] = accepted ? legs_json(accepted->route) : Json(nullptr);
  json["route_lonlat"] = accepted ? lonlat_json(accepted->route, result.frame) : Json(nullptr);
  json["metrics"] = run_metrics(config, result);
  json["check"] = accepted ? to_json(*accepted->check) : Json(nullptr);
  json.update(to_json(accepted ? accepted->cost : std::nullopt));
  if (config.scenario.reference) {
    json["reference"] = *config.scenario.reference;
  }
  if (result.task) {
    json["task"] = {
        {"plugin", config.scenario.task->plugin},  {"passes", result.task->passes.size()},
        {"flights", result.task->flights},         {"time_s", number(result.task->time_s)},
        {"bound_s", number(result.task->bound_s)}, {"stops", stops_json(result.task->passes)}};
  }
  json["flight"] = result.flight ? flight_json(*result.flight) : Json(nullptr);
  json["trace"] = result.trace ? Json(*result.trace) : Json(nullptr);
  return json;
}

std::string file_text(const Json& json) { return json_text(json, 1) + "\n"; }
}  // namespace altiplan::host
