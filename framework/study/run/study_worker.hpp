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

/// The outcome of a run of a study.
struct RunOutcome {
  Outcome outcome = Outcome::failed;
  std::string message;
  std::string result;  ///< result.json, "" if there is none
  std::string trace;   ///< likewise
  RunValues values;    ///< of the result
};

JobLimits job_limits(const StudyBudget& budget);

/// The configuration of a run, with a check that it is still as planned.
struct PlannedConfig {
  std::function<host::Config()> load;
  std::function<bool(const host::Config&)> is_current = [](const host::Config&) { return true; };
  /// Its errors are the outcome of the run, bad_parameters, and do not mean changed files.
  bool is_on_trial = false;
};

/// The work of one run, in a worker: loads the configuration, runs it, and returns the payload for
/// outcome_of.
std::string study_run(const Job& job, const PlannedConfig& planned, const StudyBudget& budget,
                      bool trace = false);

/// In the parent, for the pool: decides whether to retry the run. An unexplained failure not caused
/// by a limit is doubtful. `name` is the run's.
Appraisal appraisal_of(const Ended& ended, const StudyBudget& budget, const std::string& name);

/// In the parent: the outcome of a run, however it ended.
RunOutcome outcome_of(const Ended& ended, const StudyBudget& budget);
}  // namespace altiplan::study
