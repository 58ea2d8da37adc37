// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "host/config/config.hpp"
#include "study/model/study_file.hpp"
#include "study/pool/worker_pool.hpp"

namespace altiplan::study {

/// What became of a run of a study.
struct RunOutcome {
  std::string outcome;  ///< a status of a run, or crashed, out_of_memory, bad_output, refused
  std::string message;
  std::string result;  ///< result.json, "" where there is none
  std::string trace;   ///< likewise
};

JobLimits job_limits(const StudyBudget& budget);

/// In place of an outcome where the machine did not let the run be done as planned, which says
/// nothing about its pipeline: a file cannot be read, the system gives no thread. Not to be stored.
inline constexpr const char* kNotDone = "not done";
/// Likewise: its files are others than those that were planned with.
inline constexpr const char* kChanged = "changed";

/// The configuration of a run, and whether it is still what was planned.
struct PlannedConfig {
  std::function<host::Config()> load;
  std::function<bool(const host::Config&)> is_current = [](const host::Config&) { return true; };
  /// The configuration is on trial: what is wrong with it is the run's outcome, kBadParameters, and
  /// says nothing of changed files.
  bool is_on_trial = false;
};

inline constexpr const char* kBadParameters = "bad_parameters";

/// The work of one run, in a worker: gets the configuration, runs it, and returns the payload that
/// outcome_of reads.
std::string study_run(const Job& job, const PlannedConfig& planned, const StudyBudget& budget,
                      bool trace = false);

/// In the parent, for the pool: whether to do the run again. An unexplained failure that no limit
/// has brought about is doubtful. `name` is that of the run.
Appraisal appraisal_of(const Ended& ended, const StudyBudget& budget, const std::string& name);

/// In the parent: the outcome, whichever way the run ended.
RunOutcome outcome_of(const Ended& ended, const StudyBudget& budget);
}  // namespace altiplan::study
