// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/model/study_data.hpp"
#include "study/statistics/clustered.hpp"

namespace altiplan::study {

/// What a metric came to with one pipeline, over the pairs of runs that both solved.
struct MetricChange {
  enum class Verdict {
    same,     ///< every pair has the same value
    within,   ///< the interval lies within the tolerance
    better,   ///< the whole interval lies beyond the tolerance, on the good side
    worse,    ///< likewise, on the bad one
    unclear,  ///< the interval says neither, or there is none
    none      ///< no pair has the metric
  };
  std::string pipeline;
  std::string metric;
  std::size_t pairs = 0;
  double before = kNone;  ///< median of the first
  double after = kNone;
  /// The change is a ratio of the second to the first: all values that the metric has with any
  /// pipeline are positive. Else the difference.
  bool is_ratio = true;
  PairedEffect effect;          ///< interval of 95 %
  std::string why_no_interval;  ///< "too few scenarios: at least 6 for 95 %"
  /// Of too few scenarios for an interval, where no clock decides: from the least change of a pair
  /// to the greatest, which then decides.
  std::optional<Interval> range;
  double p = kNone;  ///< Wilcoxon, adjusted after Holm over the pipelines
  Verdict verdict = Verdict::none;
};

/// Two results of what should be one run.
struct OutcomeChange {
  std::string run;  ///< "PIPELINE SCENARIO #REPETITION"
  std::string before;
  std::string after;
  std::string message;  ///< of the second
};

struct ValueChange {
  std::string run;
  std::string metric;
  double before = 0;
  double after = 0;
};

/// A pair of runs that were not made from the same files, settings and builds: their keys differ.
struct OtherOrigin {
  const RunRow* first = nullptr;  ///< rows of the studies compared
  const RunRow* second = nullptr;
};

struct Comparison {
  std::size_t pairs = 0;
  std::size_t only_first = 0;  ///< runs that the other store has not
  std::size_t only_second = 0;
  std::size_t other_seeds = 0;  ///< runs of one name with two seeds: two problems, not compared
  std::vector<OtherOrigin> other_origins;
  std::vector<OutcomeChange> lost;     ///< solved in the first alone
  std::vector<OutcomeChange> won;      ///< in the second alone
  std::vector<OutcomeChange> others;   ///< another reason not to solve
  std::vector<ValueChange> differing;  ///< of the compared metrics that depend on no machine
  std::vector<MetricChange> metrics;

  /// Whether a success was lost, or a metric is worse.
  bool is_worse() const;
  /// Whether each run of the first has one of the second that it can be compared with.
  bool is_whole() const { return only_first == 0 && other_seeds == 0; }
};

struct CompareOptions {
  std::vector<std::string> metrics;  ///< none: those of the first store's study
  double tolerance = 0.05;
};

/// Pairs runs by pipeline, scenario and repetition. Throws Error where no run pairs, or a metric
/// is one that no run has.
Comparison compare_studies(const StudyData& first, const StudyData& second,
                           const CompareOptions& options);
}  // namespace altiplan::study
