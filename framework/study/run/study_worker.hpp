// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "host/config/config.hpp"
#include "study/model/outcome.hpp"
#include "study/model/run_values.hpp"
#include "study/model/study_file.hpp"
#include "study/workers/worker_pool.hpp"

namespace altiplan::study {

/// What became of a run of a study.
struct RunOutcome {
  Outcome outcome = Outcome::failed;
  std::string message;
  std::string result;  ///< result.json, "" where there is none
  std::string trace;   ///< likewise
  RunValues values;    ///< of the result
};

JobLimits job_limits(const StudyBudget& budget);

/// The configuration of a run, and whether it is still what was planned.
struct PlannedConfig {
  std::function<host::Config()> load;
  std::function<bool(const host::Config&)> is_current = [](const host::Config&) { return true; };
  /// What is wrong with it is the run's outcome, bad_parameters, and says nothing of changed files.
  bool is_on_trial = false;
};

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
