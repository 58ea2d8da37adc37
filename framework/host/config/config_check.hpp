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
  /// Whether anything below the key is wrong.
  bool has_problem_within(const std::string& key) const {
    return std::any_of(problems_.begin(), problems_.end(),
                       [&](const Problem& problem) { return problem.key.starts_with(key + "."); });
  }
  /// The parameters of a plugin, and the files that they name; `key` is where its name stands.
  void check_plugin(std::string_view kind, const std::string& name, const Value& parameters,
                    const Location& where, const std::string& path, const std::string& key);
  /// The problems of a report, and the files that its fields name.
  void check_report(const ParamReport& report, const std::string& path);
  /// Throws ConfigError if there is a problem: the pipeline's first, each file's from its top.
  void finish();

 private:
  void check_file(const std::string& file, const Location& where, const std::string& key);

  Config& config_;
  std::vector<Problem> problems_;
};

/// The ids of one kind that are taken.
class Ids : public std::set<std::string> {
 public:
  /// The name, then name_2, name_3 …: the first that is free. Goes on from the number it gave
  /// last, since thousands of entries of one plugin may leave their ids out.
  std::string free_id(const std::string& name);

 private:
  std::map<std::string, int> last_;
};

/// "steps.3"
std::string item(const std::string& list, std::size_t index);

/// Where a key of a map stands; the map itself where it does not.
Location place_of(const Value& map, std::string_view key);

/// "; did you mean 'x'?", or nothing.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

void check_constraints(Checker& checker, const std::vector<ConstraintEntry>& entries,
                       const Value& tree);
/// Layers, moving obstacles, points and events; gives those without an id theirs.
void check_scenario(Checker& checker, ScenarioFile& scenario, const Value& tree);
/// Binds the pipeline's steps into config.steps, gives them ids and checks them.
void check_steps(Checker& checker, Config& config);

/// The kind of plugin that the step's name stands for: `plan: NAME` looks for a planner, then for a
/// local planner.
const char* kind_of_step(Registry& registry, const StepEntry& step);
}  // namespace altiplan::host
