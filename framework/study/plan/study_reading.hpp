// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "host/import_export/scenario_set.hpp"
#include "study/model/run_values.hpp"
#include "study/plan/study_plan.hpp"

namespace altiplan::study {

/// Collects problems, each reported once however many runs it affects.
class StudyProblems {
 public:
  void add(Location where, std::string key, std::string message) {
    add({std::move(where), std::move(key), std::move(message)});
  }
  void add(const Problem& problem) {
    if (reported_.insert(problem.text()).second) {
      all_.push_back(problem);
    }
  }
  bool empty() const { return all_.empty(); }
  void finish() const {
    if (!all_.empty()) {
      throw ConfigError(all_);
    }
  }

 private:
  std::vector<Problem> all_;
  std::set<std::string> reported_;
};

/// Expands the study's entries to variants, and keeps the line of the study that each value is
/// from.
class StudyVariants {
 public:
  explicit StudyVariants(StudyProblems& problems) : problems_(problems) {}

  /// `prefix` is prepended to each key: "scenario." for scenarios. Each cell of `set` is combined
  /// with each of a published set, if there is one.
  void add(std::vector<Variant>& all, const std::string& of, const Path& file, const Value& set,
           const std::string& prefix, const std::string& path, const Location& where,
           const std::vector<host::SetScenario>& published = {});

  /// Keeps the location of an assignment made by the study itself.
  void remember(const std::string& assignment, const Location& where, const std::string& key) {
    assigned_at_["--set " + assignment] = {where, key};
  }

  /// The problem with the location in the study where its value is set.
  Problem placed(const Problem& problem) const;

 private:
  StudyProblems& problems_;
  std::map<std::string, std::pair<Location, std::string>> assigned_at_;
  std::set<std::string> ids_;
  std::set<std::string> names_;
};

/// The study with its variants, without runs.
StudyPlan read_study(const std::filesystem::path& study, StudyProblems& problems,
                     StudyVariants& variants,
                     const std::vector<std::filesystem::path>& plugin_path);

/// The parts of each pipeline of the study, as far as its file can be read.
std::vector<PipelineParts> parts_of(const StudyPlan& plan);

/// Names of the objectives that runs of the study are measured by.
std::vector<std::string> own_metrics(const StudyPlan& plan);
}  // namespace altiplan::study
