// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/model/study_data.hpp"
#include "study/statistics/clustered.hpp"

namespace altiplan::study {

/// The change of a metric of one pipeline, over the pairs of runs that both solved.
struct MetricChange {
  enum class Verdict {
    same,     ///< every pair has the same value
    within,   ///< the interval lies within the tolerance
    better,   ///< the whole interval is beyond the tolerance, for the better
    worse,    ///< likewise, for the worse
    unclear,  ///< the interval decides neither, or there is none
    none      ///< no pair has the metric
  };
  std::string pipeline;
  std::string metric;
  std::size_t pairs = 0;
  double before = kNone;  ///< median of the first
  double after = kNone;
  /// True if the change is the ratio of the second to the first, which requires all values of the
  /// metric to be positive; otherwise it is the difference.
  bool is_ratio = true;
  PairedEffect effect;          ///< interval of 95 %
  std::string why_no_interval;  ///< "too few scenarios: at least 6 for 95 %"
  /// If there are too few scenarios for an interval and the metric does not depend on time: the
  /// minimum and maximum change of a pair, which then decide.
  std::optional<Interval> range;
  double p = kNone;  ///< Wilcoxon, adjusted after Holm over the pipelines
  Verdict verdict = Verdict::none;
};

/// Two outcomes of the same run.
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

/// A pair of runs with different inputs (files, settings or builds): their keys differ.
struct OtherOrigin {
  const RunRow* first = nullptr;  ///< rows of the studies compared
  const RunRow* second = nullptr;
};

struct Comparison {
  std::size_t pairs = 0;
  std::size_t only_first = 0;  ///< runs missing in the other store
  std::size_t only_second = 0;
  std::size_t other_seeds =
      0;  ///< runs of the same name with different seeds: different problems, not compared
  std::vector<OtherOrigin> other_origins;
  std::vector<OutcomeChange> lost;    ///< solved only in the first
  std::vector<OutcomeChange> won;     ///< solved only in the second
  std::vector<OutcomeChange> others;  ///< unsolved for different reasons
  std::vector<ValueChange>
      differing;  ///< of the compared metrics that do not depend on the machine
  std::vector<MetricChange> metrics;

  /// True if a run newly fails, or a metric is worse.
  bool is_worse() const;
  /// True if outcomes and all other compared metrics are the same.
  bool differs_in_times_only() const;
  /// True if each run of the first can be compared with one of the second.
  bool is_whole() const { return only_first == 0 && other_seeds == 0; }
};

struct CompareOptions {
  std::vector<std::string> metrics;  ///< none: those of the first store's study
  double tolerance = 0.05;
};

/// Pairs runs by pipeline, scenario and repetition. Throws Error if no runs pair, or if no run has
/// a metric.
Comparison compare_studies(const StudyData& first, const StudyData& second,
                           const CompareOptions& options);
}  // namespace altiplan::study
