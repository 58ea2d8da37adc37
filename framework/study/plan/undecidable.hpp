// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "study/plan/study_plan.hpp"

namespace altiplan::study {

/// A sentence for each claim that the selected runs cannot decide, or that cannot hold, whatever
/// they give. Of shards, all count.
std::vector<std::string> undecidable_claims(const StudyPlan& plan, StudySelection selection);
}  // namespace altiplan::study
