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
  std::size_t runs = 0;    ///< that are wanted
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
  bool traces = false;  ///< keep what the searches did
  std::vector<std::filesystem::path> plugin_path;
  std::string command;  ///< as the user gave it
  std::function<void(const StudyProgress&)> progress;
  std::function<void(const std::string&)> say;  ///< what the user should know
};

struct StudyEnd {
  StudyProgress progress;
  bool is_interrupted = false;
};

/// Does the runs that the store does not hold yet. Throws Error where the store or its work folder
/// cannot be used, or holds another study.
StudyEnd run_study(const StudyPlan& plan, const StudyOptions& options);

/// What is still to be done, and how long it takes by the runs that are stored, or else by one run
/// of each pipeline that is done now and not stored.
struct StudyEstimate {
  std::size_t stored = 0;
  std::size_t left = 0;
  std::size_t measured = 0;  ///< runs that the estimate is from
  bool is_probed = false;    ///< they were done now
  double run_s = 0;          ///< mean time of a run
  double total_s = 0;        ///< of what is left, `jobs` at a time
};
StudyEstimate estimate_study(const StudyPlan& plan, const StudyOptions& options);
}  // namespace altiplan::study
