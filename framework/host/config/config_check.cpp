// SPDX-License-Identifier: Apache-2.0
#include "host/config/config_check.hpp"

#include <algorithm>
#include <tuple>

#include "altiplan/attributed.hpp"
#include "host/base/input.hpp"
#include "host/base/machine_fault.hpp"
#include "host/base/words.hpp"
#include "host/config/yaml.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;

void Checker::check_plugin(std::string_view kind, const std::string& name, const Value& parameters,
                           const Location& where, const std::string& path, const std::string& key) {
  if (name.empty()) {
    return;  // already reported
  }
  const PluginEntry* entry = nullptr;
  try {
    entry = &plugin(*config_.registry, kind, name);
  } catch (const PluginError&) {
    throw;  // a library that offers the name is refused: exit code 4
  } catch (const MachineFault&) {
    throw;
  } catch (const Error& error) {
    problem(where, key, error.what());
    return;
  }
  check_report(attributed([&] { return "describing the " + std::string(kind) + " '" + name + "'"; },
                          [&] { return entry->describe(&parameters, path); }),
               path);
}

void Checker::check_report(const ParamReport& report, const std::string& path) {
  add(report.problems);
  for (const BoundField& field : report.fields) {
    if (field.spec.type == FieldType::path && field.where && field.value_json.size() > 2) {
      const Value text = parse_yaml(field.value_json, "");
      check_file(text.text, *field.where, path + "." + field.spec.name);
    }
  }
}

void Checker::check_file(const std::string& file, const Location& where, const std::string& key) {
  if (const std::string why = file_problem(file); !why.empty()) {
    problem(where, key, why);
  } else if (std::find(config_.files.begin(), config_.files.end(), file) == config_.files.end()) {
    config_.files.emplace_back(file);
  }
}

void Checker::finish() {
  if (problems_.empty()) {
    return;
  }
  const auto order = [&](const Problem& problem) {
    const bool second =
        !config_.pipeline_path.empty() && problem.where.file != config_.pipeline_path.string();
    return std::tuple(second, problem.where.line, problem.where.column);
  };
  std::stable_sort(problems_.begin(), problems_.end(),
                   [&](const Problem& a, const Problem& b) { return order(a) < order(b); });
  throw ConfigError(std::move(problems_));
}

std::string item(const std::string& list, std::size_t index) {
  return list + "." + std::to_string(index);
}

Location place_of(const Value& value, std::string_view key) {
  const std::size_t dot = key.find('.');
  const std::string_view first = key.substr(0, dot);
  const auto within = [&](const Value& inner, const Location& where) {
    return dot == key.npos ? where : place_of(inner, key.substr(dot + 1));
  };
  for (const Value::Entry& entry : value.entries) {
    if (entry.key == first) {
      return within(entry.value, entry.where);
    }
  }
  for (std::size_t n = 0; n < value.items.size(); ++n) {
    if (std::to_string(n) == first) {
      return within(value.items[n], value.items[n].where);
    }
  }
  return value.where;
}

std::string Ids::free_id(const std::string& name) {
  int& last = last_.try_emplace(name, 1).first->second;
  std::string id = last == 1 ? name : name + "_" + std::to_string(last);
  while (contains(id)) {
    id = name + "_" + std::to_string(++last);
  }
  return id;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string near = nearest_name(word, candidates);
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

void check_objective(Checker& checker, const ObjectiveEntry& entry, const Value& tree,
                     const std::string& path) {
  const std::string inner = path + "." + entry.plugin;
  checker.check_plugin("objective", entry.plugin, entry.parameters, place_of(tree, entry.plugin),
                       inner, path);
  if (entry.plugin == "weighted") {
    WeightedParams weighted;
    bind(weighted, &entry.parameters);  // its problems are reported above
    for (std::size_t i = 0; i < weighted.of.size(); ++i) {
      const ObjectiveTerm& term = weighted.of[i];
      check_objective(checker, {term.plugin, term.parameters},
                      entry.parameters.find("of")->items[i], item(inner + ".of", i));
    }
  }
}

namespace {
/// Values that every run, step or flight has already (docs/reference/studies.md).
constexpr const char* kValuesOfRuns[] = {"length_m",           "waypoints",
                                         "max_turn_deg",       "max_climb_deg",
                                         "min_radius_m",       "min_clearance_m",
                                         "smoothness_rad",     "min_ground_clearance_m",
                                         "duration_s",         "plan_time_s",
                                         "smooth_time_s",      "expanded",
                                         "setup_time_s",       "solved",
                                         "wall_time_s",        "cpu_time_s",
                                         "peak_memory_mb",     "time_s",
                                         "energy_wh",          "accepted",
                                         "budget_hit",         "collisions",
                                         "min_separation_m",   "reached",
                                         "cross_track_max_m",  "cross_track_p999_m",
                                         "height_error_max_m", "replans",
                                         "replan_time_s",      "handovers"};

/// Why a metric cannot have this name; "" if it can.
std::string name_problem(const std::string& name, const Ids& names) {
  if (!is_snake_case(name)) {
    return "expected lower-case letters, digits and '_', starting with a letter, found " +
           excerpt(name);
  }
  const bool is_built_in = std::find(std::begin(kValuesOfRuns), std::end(kValuesOfRuns), name) !=
                           std::end(kValuesOfRuns);
  if (is_built_in) {
    return "every result has a value '" + name + "' already: give this metric another id";
  }
  return names.contains(name) ? "there is a metric '" + name + "' already: give this one an id"
                              : "";
}
}  // namespace

void check_metrics(Checker& checker, std::vector<MetricEntry>& entries, const Value& tree,
                   Ids& names) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    MetricEntry& entry = entries[i];
    const Value& at = tree.find("metrics")->items[i];
    const std::string path = item("metrics", i);
    check_objective(checker, {entry.plugin, entry.parameters}, at, path);
    const bool is_named = !entry.id.empty();
    if (!is_named) {
      entry.id = entry.plugin;
    }
    if (entry.id.empty()) {
      continue;  // already reported
    }
    if (const std::string why = name_problem(entry.id, names); !why.empty()) {
      checker.problem(place_of(at, is_named ? "id" : entry.plugin), path, why);
    }
    names.insert(entry.id);
  }
}

void check_constraints(Checker& checker, const std::vector<ConstraintEntry>& entries,
                       const Value& tree) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::string path = item("constraints", i);
    const ConstraintEntry& entry = entries[i];
    checker.check_plugin("constraint", entry.plugin, entry.parameters,
                         place_of(tree.find("constraints")->items[i], entry.plugin),
                         path + "." + entry.plugin, path);
    if (entry.plugin == "limit") {
      LimitParams limit;
      bind(limit, &entry.parameters);  // its problems are reported above
      if (const Value* of = entry.parameters.find("of")) {
        check_objective(checker, {limit.of.plugin, limit.of.parameters}, *of, path + ".limit.of");
      }
    }
  }
}
}  // namespace altiplan::host
