// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "host/config/config.hpp"

namespace altiplan::host {

/// Collects the problems of a configuration, so that the user sees all of them at once.
class Checker {
 public:
  explicit Checker(Config& config) : config_(config) {}

  void problem(Location where, std::string key, std::string message) {
    problems_.push_back({std::move(where), std::move(key), std::move(message)});
  }
  void add(const std::vector<Problem>& problems) {
    problems_.insert(problems_.end(), problems.begin(), problems.end());
  }
  /// True if there is a problem below the key.
  bool has_problem_within(const std::string& key) const {
    return std::any_of(problems_.begin(), problems_.end(),
                       [&](const Problem& problem) { return problem.key.starts_with(key + "."); });
  }
  /// Checks the parameters of a plugin, and the files that they name; `key` holds its name.
  void check_plugin(std::string_view kind, const std::string& name, const Value& parameters,
                    const Location& where, const std::string& path, const std::string& key);
  /// Adds the problems of a report, and checks the files that its fields name.
  void check_report(const ParamReport& report, const std::string& path);
  /// Throws ConfigError if there are problems: the pipeline's first, each file's from top to
  /// bottom.
  void finish();
  /// Adds a file that results depend on; a problem if it cannot be read.
  void check_file(const std::string& file, const Location& where, const std::string& key);

 private:
  Config& config_;
  std::vector<Problem> problems_;
};

/// The ids in use of one kind.
class Ids : public std::set<std::string> {
 public:
  /// The first free id of name, name_2, name_3 … Continues from the last number given, since
  /// thousands of entries of one plugin may omit their ids.
  std::string free_id(const std::string& name);

 private:
  std::map<std::string, int> last_;
};

/// "steps.3"
std::string item(const std::string& list, std::size_t index);

/// Location of a key such as "stops.3.hold_s"; of what holds it if it is not there.
Location place_of(const Value& value, std::string_view key);

/// "; did you mean 'x'?", or "".
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

/// Checks an objective and those that it adds up; `path` is that of its map.
void check_objective(Checker& checker, const ObjectiveEntry& entry, const Value& tree,
                     const std::string& path);
/// Checks the metrics of a file, and names those without an id; `names` are those of both files.
void check_metrics(Checker& checker, std::vector<MetricEntry>& entries, const Value& tree,
                   Ids& names);
void check_constraints(Checker& checker, const std::vector<ConstraintEntry>& entries,
                       const Value& tree);
/// Checks layers, moving obstacles, points and events; assigns missing ids.
void check_scenario(Checker& checker, ScenarioFile& scenario, const Value& tree);
/// Binds the pipeline's steps into config.steps, assigns missing ids and checks them.
void check_steps(Checker& checker, Config& config);

/// The plan steps, alternatives and replans whose planners cannot minimise such an objective.
std::vector<Problem> planner_problems(const Config& config, const Objective& objective);

/// The kind of plugin that the step names: `plan: NAME` looks for a planner, then for a local
/// planner.
const char* kind_of_step(Registry& registry, const StepEntry& step);
}  // namespace altiplan::host
