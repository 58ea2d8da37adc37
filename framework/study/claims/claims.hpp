// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "altiplan/error.hpp"
#include "study/claims/claim_text.hpp"
#include "study/model/study_data.hpp"
#include "study/statistics/statistics.hpp"

namespace altiplan::study {

/// The problems of a claim, given the names of the study's pipelines (all variants): syntax errors,
/// unknown functions or pipelines, an id of several variants. `that` and `is` are the locations of
/// the claim's texts, `key` is "claims.0".
std::vector<Problem> check_claim(const ClaimEntry& claim, const std::vector<std::string>& pipelines,
                                 const Location& that, const Location& is, const std::string& key);

/// A claim holds if the whole interval satisfies the comparison, and fails if none of it does.
/// min() and max() have no interval: the estimate decides.
enum class Verdict { holds, fails, undecided, no_data };
std::string_view name_of(Verdict verdict);  ///< "holds", "fails", "undecided", "no data"

struct JudgedClaim {
  ClaimEntry claim;
  Verdict verdict = Verdict::no_data;
  double estimate = kNone;
  std::optional<Interval> interval;
  std::string method;        ///< of the interval: "order statistics, 100 scenarios"; "" without one
  std::size_t used = 0;      ///< pairs in which every named value exists
  std::size_t pairs = 0;     ///< all pairs (scenario, repetition) with a run
  bool lacks_runs = false;   ///< no pair has runs of all pipelines named
  bool has_too_few = false;  ///< scenarios or repetitions for an interval
  bool measured = false;     ///< names a time or memory, which vary between equal runs
  std::string why_no_interval;  ///< "too few scenarios: at least 6 for 95 %"; "" with one
  double p = kNone;  ///< 1 - the highest confidence that decides the claim; NaN without interval
  double p_holm = kNone;  ///< adjusted for all claims that are judged together
  std::string stated;     ///< "changed after 12 runs"; "" if it reads as before the first run
  std::string words;      ///< the verdict and its reasons, in sentences
  std::string reasons;    ///< the reasons alone, shown beside expression, range and verdict
};

/// The required range of the claim: "<= 0.95", "within 0.9..1.1".
std::string wanted(const ClaimEntry& claim);

/// Evaluates the claim on the study's runs. A value counts if its run has it and solved the
/// problem; values that describe failures (is_of_every_run) count in every run that has them.
JudgedClaim judge_claim(const StudyData& data, const ClaimEntry& claim);

/// All claims of the study, with `p` and `p_holm`.
std::vector<JudgedClaim> judge_claims(const StudyData& data);
/// True if it holds or fails by its own interval, but not with Holm's correction.
bool becomes_undecided(const JudgedClaim& judged);
/// A sentence on what Holm's correction leaves of the verdicts of several claims; "" of fewer.
std::string multiplicity(const std::vector<JudgedClaim>& claims);
/// Fills in `p_holm`.
void adjust(std::vector<JudgedClaim>& claims);

/// A sentence for each reason that may be that of many claims, without runs or with too few, and
/// the claims; their own words do not say it again.
std::vector<std::string> common_reasons(const std::vector<JudgedClaim>& claims);

/// What so few runs keep from the claim even if every pair counts: "will be undecided: too few
/// scenarios: at least 6 for 95 %", "cannot hold: …"; "" if it may hold. `groups` has the scenario
/// of each pair (scenario, repetition) that is to be run.
std::string shortfall(const ClaimEntry& claim, const ClaimQuantity& quantity,
                      std::span<const std::size_t> groups);

/// Values that are 0 or 1: solved, flight.reached, steps.ID.accepted and steps.ID.budget_hit.
bool is_yes_or_no(std::string_view value);
/// Those, flight.collisions, flight.min_separation_m and peak_memory_mb: claims on these are about
/// the runs that did not solve as well.
bool is_of_every_run(std::string_view value);
}  // namespace altiplan::study
