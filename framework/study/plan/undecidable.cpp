// SPDX-License-Identifier: Apache-2.0
#include "study/plan/undecidable.hpp"

#include <set>

#include "study/claims/claims.hpp"

namespace altiplan::study {

std::vector<std::string> undecidable_claims(const StudyPlan& plan) {
  std::set<std::pair<std::size_t, int>> pairs;
  for (const PlannedRun& run : plan.runs) {
    pairs.insert({run.scenario, run.repetition});
  }
  std::vector<std::size_t> groups;
  for (const auto& [scenario, repetition] : pairs) {
    groups.push_back(scenario);
  }
  std::vector<std::string> names;
  for (const Variant& pipeline : plan.pipelines) {
    names.push_back(pipeline.name);
  }
  std::vector<std::string> sentences;
  for (const ClaimEntry& claim : plan.file.claims) {
    if (const std::string why = why_undecidable(claim, names, groups); !why.empty()) {
      sentences.push_back("claim " + claim.id + " will be undecided: " + why);
    }
  }
  return sentences;
}
}  // namespace altiplan::study
