// SPDX-License-Identifier: Apache-2.0
#include "study/plan/undecidable.hpp"

#include <map>
#include <set>

#include "study/claims/claims.hpp"
#include "study/plan/study_selection.hpp"

namespace altiplan::study {
namespace {

/// The pipelines that run in each pair (scenario, repetition).
using Pairs = std::map<std::pair<std::size_t, int>, std::set<std::size_t>>;

Pairs pairs_of(const std::vector<PlannedRun>& runs) {
  Pairs pairs;
  for (const PlannedRun& run : runs) {
    pairs[{run.scenario, run.repetition}].insert(run.pipeline);
  }
  return pairs;
}

/// The scenario of each pair in which all pipelines run that the quantity names.
std::vector<std::size_t> groups_of(const Pairs& pairs, const ClaimQuantity& quantity) {
  std::vector<std::size_t> groups;
  for (const auto& [pair, pipelines] : pairs) {
    bool all = true;
    for (const ClaimValue& value : quantity.values) {
      all = all && pipelines.contains(value.pipeline);
    }
    if (all) {
      groups.push_back(pair.first);
    }
  }
  return groups;
}

std::string named_pipelines(const StudyPlan& plan, const ClaimQuantity& quantity) {
  std::set<std::size_t> named;
  std::string words;
  for (const ClaimValue& value : quantity.values) {
    if (named.insert(value.pipeline).second) {
      words += (words.empty() ? "" : " and ") + plan.pipelines[value.pipeline].name;
    }
  }
  return words;
}
}  // namespace

std::vector<std::string> undecidable_claims(const StudyPlan& plan, StudySelection selection) {
  if (plan.file.claims.empty()) {
    return {};
  }
  const bool is_part = selection.shards > 1;  // all of them decide together
  selection.shard = selection.shards = 1;
  const Pairs pairs = pairs_of(is_part ? selected_runs(plan, selection) : plan.runs);
  std::vector<std::string> names;
  for (const Variant& pipeline : plan.pipelines) {
    names.push_back(pipeline.name);
  }
  std::vector<std::string> sentences;
  for (const ClaimEntry& claim : plan.file.claims) {
    const ClaimQuantity quantity = read_quantity(claim.that, names);
    const std::vector<std::size_t> groups = groups_of(pairs, quantity);
    const std::string why = groups.empty() ? "will have no data: no selected pair has runs of " +
                                                 named_pipelines(plan, quantity)
                                           : shortfall(claim, quantity, groups);
    if (!why.empty()) {
      sentences.push_back("claim " + claim.id + " " + why);
    }
  }
  return sentences;
}
}  // namespace altiplan::study
