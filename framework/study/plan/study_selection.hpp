// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "study/plan/study_plan.hpp"

namespace altiplan::study {

/// Every run that there is to the study, in the order of the file, without keys. Throws ConfigError
/// for more than ten millions.
std::vector<PlannedRun> all_runs(const StudyPlan& plan);

/// What is asked for, in the order in which it is run: that of a hash, so that nothing that drifts
/// on the machine favours a pipeline. Whether a run is chosen, and its place among the others, do
/// not depend on the machine. Keys are not set yet.
std::vector<PlannedRun> selected_runs(const StudyPlan& plan, const StudySelection& selection);
}  // namespace altiplan::study
