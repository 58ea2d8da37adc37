// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "altiplan/error.hpp"
#include "study/model/study_data.hpp"
#include "study/statistics/statistics.hpp"

namespace altiplan::study {

/// What is wrong with a claim, by the names of the study's pipelines (all variants): what cannot be
/// read, a function or a pipeline that there is none of, one that stands for several variants.
/// `that` and `is` are where the claim's texts stand, `key` is "claims.0".
std::vector<Problem> check_claim(const ClaimEntry& claim, const std::vector<std::string>& pipelines,
                                 const Location& that, const Location& is, const std::string& key);

/// An interval holds a claim where all of it satisfies the comparison, and fails it where nothing
/// of it does. min() and max() have none: the estimate decides.
enum class Verdict { holds, fails, undecided, no_data };
std::string_view name_of(Verdict verdict);  ///< "holds", "fails", "undecided", "no data"

struct JudgedClaim {
  ClaimEntry claim;
  Verdict verdict = Verdict::no_data;
  double estimate = kNone;
  std::optional<Interval> interval;
  std::string method;           ///< of the interval: "bootstrap over 100 scenarios"; "" without one
  std::size_t used = 0;         ///< pairs in which everything named has a value
  std::size_t pairs = 0;        ///< of scenario and repetition, all that have a run
  bool measured = false;        ///< names a time or memory, which vary from run to run
  std::string why_no_interval;  ///< "too few scenarios: at least 6 for 95 %"; "" with one
  std::string words;            ///< the verdict and its reasons in plain words, sentences
  std::string reasons;          ///< the same beside expression, range and verdict
};

/// What the claim wants: "<= 0.95", "within 0.9..1.1".
std::string wanted(const ClaimEntry& claim);

/// Evaluates the claim on the study's runs. A value counts where its run has it and solved the
/// problem; those which say how a run went wrong (is_of_every_run) count in every run that has
/// them.
JudgedClaim judge_claim(const StudyData& data, const ClaimEntry& claim);

/// Values that are 0 or 1: solved, flight.reached, steps.ID.accepted and steps.ID.budget_hit.
bool is_yes_or_no(std::string_view value);
/// Those, flight.collisions, flight.min_separation_m and peak_memory_mb: leaving out the runs that
/// did not solve would leave out what a claim on these is about.
bool is_of_every_run(std::string_view value);
/// Times and memory: names that end in time_s or memory_mb.
bool is_measured(std::string_view value);
}  // namespace altiplan::study
