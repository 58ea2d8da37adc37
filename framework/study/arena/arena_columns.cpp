// SPDX-License-Identifier: Apache-2.0
#include "study/arena/arena_columns.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

namespace altiplan::study {
namespace {

bool is_number(std::string_view text) {
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && stop == text.data() + text.size();
}

std::string plain(std::string_view name) {
  std::string column;
  for (const char c : name) {
    const bool capital = c >= 'A' && c <= 'Z';
    const bool kept = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    const char as = capital ? char(c - 'A' + 'a') : kept ? c : '_';
    if (as != '_' || (!column.empty() && column.back() != '_')) {
      column += as;
    }
  }
  while (column.ends_with('_')) {
    column.pop_back();
  }
  return column.empty() || (column[0] >= '0' && column[0] <= '9') ? "value_" + column : column;
}

using Settings = std::map<std::string, std::string>;  // value by key

Settings settings_of(const StoredVariant& variant) {
  Settings settings;
  for (const std::string& assignment : variant.set) {
    const std::size_t equals = assignment.find('=');
    settings[assignment.substr(0, equals)] =
        equals == assignment.npos ? "" : assignment.substr(equals + 1);
  }
  return settings;
}

/// The scenario files whose variants all set the same keys, which distinguish them.
std::set<std::string> files_with_parameters(const StudyData& data) {
  std::map<std::string, std::set<std::vector<std::string>>> keys;
  for (const StoredVariant& scenario : data.scenarios) {
    std::vector<std::string> set;
    for (const auto& [key, value] : settings_of(scenario)) {
      set.push_back(key);
    }
    keys[scenario.of].insert(set);
  }
  std::set<std::string> files;
  for (const auto& [file, sets] : keys) {
    if (sets.size() == 1 && !sets.begin()->empty()) {
      files.insert(file);
    }
  }
  return files;
}
}  // namespace

ColumnNames::ColumnNames()
    : taken_{"id",       "experimentid", "plannerid", "experiment", "planner",
             "version",  "name",         "totaltime", "timelimit",  "memorylimit",
             "runcount", "hostname",     "cpuinfo",   "date",       "seed",
             "setup",    "settings",     "runid",     "value",      "description"} {}

std::string ColumnNames::add(std::string_view name) {
  const std::string wanted = plain(name);
  std::string column = wanted;
  for (int n = 2; std::find(taken_.begin(), taken_.end(), column) != taken_.end(); ++n) {
    column = wanted + "_" + std::to_string(n);
  }
  taken_.push_back(column);
  return column;
}

namespace {
/// OMPL's columns, each with the value of ours that means the same.
const std::vector<std::pair<ArenaColumn, const char*>>& ompl_columns() {
  static const std::vector<std::pair<ArenaColumn, const char*>> kOmpl{
      {{"approximate_solution", "BOOLEAN"}, ""},
      {{"correct_solution", "BOOLEAN"}, ""},
      {{"graph_states", "INTEGER"}, "expanded"},
      {{"memory", "REAL"}, "peak_memory_mb"},
      {{"solution_clearance", "REAL"}, "min_clearance_m"},
      {{"solution_length", "REAL"}, "length_m"},
      {{"solution_segments", "INTEGER"}, "waypoints"},
      {{"solution_smoothness", "REAL"}, "smoothness_rad"},
      {{"solved", "BOOLEAN"}, "solved"},
      {{"status", "ENUM"}, ""},
      {{"time", "REAL"}, "plan_time_s"}};
  return kOmpl;
}
}  // namespace

std::string value_of_column(const std::string& column) {
  for (const auto& [ompl, ours] : ompl_columns()) {
    // OMPL's smoothness is another sum than ours.
    if (ompl.name == column && *ours != '\0' && column != "solution_smoothness") {
      return ours;
    }
  }
  return column;
}

std::vector<ArenaColumn> arena_columns(const StudyData& data, ColumnNames& names) {
  std::vector<ArenaColumn> columns;
  std::set<std::string> done;
  for (const auto& [column, ours] : ompl_columns()) {
    columns.push_back({names.add(column.name), column.type, data.column(ours)});
    done.insert(ours);
  }
  for (std::size_t n = 0; n < data.columns.size(); ++n) {
    if (!done.contains(data.columns[n])) {
      columns.push_back({names.add(data.columns[n]), "REAL", n});
    }
  }
  return columns;
}

ArenaExperiments arena_experiments(const StudyData& data, ColumnNames& names) {
  const std::set<std::string> by_parameters = files_with_parameters(data);
  ArenaExperiments all;
  std::vector<Settings> settings;
  for (const StoredVariant& scenario : data.scenarios) {
    const bool of_file = by_parameters.contains(scenario.of);
    settings.push_back(of_file ? settings_of(scenario) : Settings());
    all.experiments.push_back({of_file ? scenario.of : scenario.name, {}});
  }
  std::map<std::string, bool> numbers;  // by key
  for (const Settings& of_scenario : settings) {
    for (const auto& [key, value] : of_scenario) {
      numbers[key] = numbers.emplace(key, true).first->second && is_number(value);
    }
  }
  for (const auto& [key, are_numbers] : numbers) {
    const bool prefixed = key.starts_with("scenario.");
    all.parameters.push_back({key, names.add(prefixed ? key.substr(9) : key), are_numbers});
  }
  for (std::size_t n = 0; n < settings.size(); ++n) {
    for (const ArenaParameter& parameter : all.parameters) {
      const auto found = settings[n].find(parameter.key);
      all.experiments[n].parameters.push_back(found == settings[n].end() ? "" : found->second);
    }
  }
  return all;
}

const std::vector<ArenaStatus>& arena_statuses() {
  static const std::vector<ArenaStatus> kStatuses{{0, "", "Unknown status"},
                                                  {4, "timed_out", "Timeout"},
                                                  {6, "solved", "Exact solution"},
                                                  {7, "crashed", "Crash"},
                                                  {16, "no_route", "No route"},
                                                  {17, "cancelled", "Cancelled"},
                                                  {18, "invalid_problem", "Invalid start or goal"},
                                                  {19, "rejected", "Rejected by the judge"},
                                                  {20, "failed", "Failed"},
                                                  {21, "collided", "Collided in flight"},
                                                  {22, "not_reached", "Goal not reached in flight"},
                                                  {23, "out_of_memory", "Out of memory"},
                                                  {24, "bad_output", "Unreadable result"},
                                                  {25, "refused", "Plugin refused"}};
  return kStatuses;
}

int arena_status(std::string_view outcome) {
  for (const ArenaStatus& status : arena_statuses()) {
    if (status.outcome == outcome) {
      return status.value;
    }
  }
  return 0;
}
}  // namespace altiplan::study
