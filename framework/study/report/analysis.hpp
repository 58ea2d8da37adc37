// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/model/study_data.hpp"
#include "study/statistics/clustered.hpp"

namespace altiplan::study::report {

constexpr double kConfidence = 0.95;
constexpr double kAlpha = 0.05;

/// The study with pipelines in the order of its file and scenarios by name, whatever the order in
/// which the stores hold them; without what differs from run to run where `times` is false.
StudyData in_order(StudyData data, bool times);

/// How the runs of a pipeline ended.
struct Success {
  std::size_t runs = 0;
  std::size_t solved = 0;
  ShareInterval interval;
  std::vector<std::pair<std::string, std::size_t>> outcomes;  ///< those that occur, solved first
};

/// A pipeline against another, which comes before it in the study, on the pairs (scenario,
/// repetition) that both have run.
struct SuccessComparison {
  std::size_t pipeline = 0;
  std::size_t against = 0;
  std::size_t pairs = 0;
  std::size_t only_pipeline = 0;  ///< pairs that only this one solved
  std::size_t only_against = 0;
  SuccessTest test;  ///< its first is the one that is compared against
  double p_holm = kNone;
};

/// Likewise on the pairs that both have solved with a number.
struct Comparison {
  std::size_t pipeline = 0;
  std::size_t against = 0;
  std::size_t pairs = 0;  ///< that both have run
  std::size_t used = 0;
  PairedEffect effect;
  double p_holm = kNone;

  double p() const { return effect.test ? effect.test->p : kNone; }
  double rank_biserial() const { return effect.test ? effect.test->rank_biserial : kNone; }
};

/// Average ranks of all pipelines over the blocks that all of them solved.
struct Ranking {
  std::size_t blocks = 0;
  bool of_scenarios = false;  ///< a block is a scenario, else a pair
  Friedman test;
  double critical = kNone;
  std::vector<std::vector<std::size_t>> joined;
};

/// The values of a pipeline's solved runs.
struct Sample {
  std::vector<double> values;
  std::vector<std::size_t> rows;  ///< index into StudyData::rows, one per value
  std::optional<BoxPlot> box;
};

struct MetricAnalysis {
  std::string metric;
  Better better = Better::lower;
  std::vector<Sample> samples;  ///< one per pipeline
  bool is_ratio = false;        ///< effects are ratios: every value is positive; else differences
  std::vector<Comparison> comparisons;
  std::optional<Ranking> ranking;
  std::string why_no_ranking;
};

struct Analysis {
  std::vector<Success> success;  ///< one per pipeline
  std::vector<SuccessComparison> success_comparisons;
  std::vector<MetricAnalysis> metrics;
  std::vector<std::string> left_out;  ///< sentences on metrics that no run has
};

/// `data` and `times` as of in_order.
Analysis analyse(const StudyData& data, bool times);

/// Resamples of a comparison's interval: kResamples, or where so many pipelines are compared on so
/// many pairs that a metric would take a minute, fewer, but 1,000 at least.
std::size_t resamples(std::size_t pairs, std::size_t pipelines);

/// What calls for an explanation: the plugin or its build is at fault, not the problem.
bool unexplained(std::string_view outcome);
/// All outcomes, in the order of figures; `solved` first.
const std::vector<std::string>& outcome_order();
/// "out_of_memory" → "out of memory".
std::string outcome_text(std::string_view outcome);

/// Names of pipelines for figures and tables: of variants the values alone, "weighted[0.3,0.7]" for
/// "weighted[weight_g=0.3,weight_h=0.7]", where that is as clear.
std::vector<std::string> short_names(const StudyData& data);
/// What the values stand for: "weighted[weight_g,weight_h]", one for each entry that is shortened.
std::vector<std::string> short_name_keys(const StudyData& data);

/// How people name a run, on this command line too: "PIPELINE SCENARIO #REPETITION".
std::string run_name(const StudyData& data, const RunRow& row);
/// The rows of each (scenario, repetition), one place per pipeline; kNoRow where it has not run.
constexpr std::size_t kNoRow = std::size_t(-1);
struct Pair {
  std::size_t scenario = 0;
  int repetition = 0;
  std::vector<std::size_t> rows;
};
std::vector<Pair> pairs_of(const StudyData& data);
}  // namespace altiplan::study::report
