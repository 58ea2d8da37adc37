// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "study/plan/study_plan.hpp"

namespace altiplan::study {

/// Every run of the study, in the order of the file, without keys. Throws ConfigError for more than
/// ten million.
std::vector<PlannedRun> all_runs(const StudyPlan& plan);

/// The selected runs in execution order: by a hash, so that drift of the machine favours no
/// pipeline. Selection and order do not depend on the machine. Keys are not set yet.
std::vector<PlannedRun> selected_runs(const StudyPlan& plan, const StudySelection& selection);
}  // namespace altiplan::study
