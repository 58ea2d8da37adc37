// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "study/plan/study_plan.hpp"

namespace altiplan::study {

struct StudyProgress {
  std::size_t runs = 0;    ///< that are selected
  std::size_t before = 0;  ///< stored when this call began, recovered ones included
  std::size_t done = 0;    ///< by this call
  std::map<std::string, std::size_t> outcomes;  ///< of this call
  double elapsed_s = 0;
};

struct StudyOptions {
  std::filesystem::path store;
  int jobs = 1;
  int reuse = 1;
  bool fresh = false;
  bool traces = false;  ///< store traces of the searches
  bool results = true;  ///< store result.json, not its values alone
  std::vector<std::filesystem::path> plugin_path;
  std::string command;  ///< the command line
  std::function<void(const StudyProgress&)> progress;
  std::function<void(const std::string&)> say;  ///< receives warnings for the user
};

struct StudyEnd {
  StudyProgress progress;
  bool is_interrupted = false;
};

/// Executes the runs that are not stored yet. Throws Error if the store or its work folder cannot
/// be used, or belongs to another study.
StudyEnd run_study(const StudyPlan& plan, const StudyOptions& options);

/// The remaining runs and their estimated time, from the stored runs, or else from one run of each
/// pipeline (of 50, if there are more) made now and not stored.
struct StudyEstimate {
  std::size_t stored = 0;
  std::size_t left = 0;
  std::size_t measured = 0;  ///< runs that the estimate is based on
  bool is_probed = false;    ///< those runs were made now
  double run_s = 0;          ///< mean time of a run
  double total_s = 0;        ///< of the remaining runs, with `jobs` in parallel
};
StudyEstimate estimate_study(const StudyPlan& plan, const StudyOptions& options);
}  // namespace altiplan::study
