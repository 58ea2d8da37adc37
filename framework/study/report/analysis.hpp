// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "study/model/study_data.hpp"
#include "study/statistics/clustered.hpp"

namespace altiplan::study::report {

inline constexpr double kConfidence = 0.95;
inline constexpr double kAlpha = 0.05;

/// The study with pipelines in the order of its file and scenarios by name, whatever their order in
/// the stores; without values that vary between equal runs if `times` is false.
StudyData in_order(StudyData data, bool times);

/// What the study plans and has no run of.
struct Absent {
  std::vector<std::string> pipelines;  ///< names
  std::size_t scenarios = 0;           ///< number
};
/// Takes them out of a study that has runs.
Absent take_absent(StudyData& data);

/// The outcomes of a pipeline's runs.
struct Success {
  std::size_t runs = 0;
  std::size_t solved = 0;
  MadeInterval interval;
  std::size_t valid = 0;                                      ///< runs whose problem is valid
  MadeInterval of_valid;                                      ///< of the share of those that solved
  std::vector<std::pair<std::string, std::size_t>> outcomes;  ///< those that occur, solved first
};

/// A pipeline compared with an earlier one of the study, on the pairs (scenario, repetition) that
/// both have run.
struct SuccessComparison {
  std::size_t pipeline = 0;
  std::size_t against = 0;
  std::size_t pairs = 0;          ///< one per scenario if both repeat themselves
  std::size_t only_pipeline = 0;  ///< pairs that only this one solved
  std::size_t only_against = 0;
  MadeInterval difference;  ///< of its share of solved pairs from the other's
  SuccessTest test;         ///< its first is the pipeline compared against
  double p_holm = kNone;
};

/// Likewise on the pairs that both have solved with a finite value.
struct Comparison {
  std::size_t pipeline = 0;
  std::size_t against = 0;
  std::size_t pairs = 0;  ///< that both have run; one per scenario if both have equal repetitions
  std::size_t used = 0;
  PairedEffect effect;
  double p_holm = kNone;

  double p() const { return effect.test ? effect.test->p : kNone; }
  double rank_biserial() const { return effect.test ? effect.test->rank_biserial : kNone; }
};

/// Average ranks of all pipelines over the blocks that all of them solved.
struct Ranking {
  std::size_t blocks = 0;
  bool of_scenarios = false;  ///< a block is a scenario, otherwise a pair
  Friedman test;
  double critical = kNone;
  std::vector<std::vector<std::size_t>> joined;
};

/// The values of a pipeline's solved runs; of a scenario's equal repetitions of the first.
struct Sample {
  std::vector<double> values;
  std::vector<std::size_t> rows;  ///< index into StudyData::rows, one per value
  std::optional<BoxPlot> box;
};

/// The number of pipelines whose repetitions are equal, of which one counts.
enum class Repeating { none, one, some, all };

struct MetricAnalysis {
  std::string metric;
  Better better = Better::lower;
  std::vector<Sample> samples;            ///< one per pipeline
  Repeating repeating = Repeating::none;  ///< none if it is measured
  bool is_ratio = false;  ///< effects are ratios (all values positive), otherwise differences
  std::vector<Comparison> comparisons;
  std::optional<Ranking> ranking;
  std::string why_no_ranking;
};

/// The pipelines in two metrics of one's own: medians over the pairs that all of them solved.
struct Trade {
  std::array<std::string, 2> metrics;
  std::array<bool, 2> is_negated{};    ///< more is better: negated in places
  std::vector<std::size_t> pipelines;  ///< those that solved any run with both values
  std::vector<Place> places;           ///< one per entry of pipelines; less is better
  std::size_t pairs = 0;               ///< that all of them solved
  std::vector<std::size_t> front;      ///< indices into places
  Place reference{};                   ///< worst of both values, and a tenth of the range more
  double hypervolume = 0;
  double share = 0;  ///< of the rectangle from the best of both values
};

struct Analysis {
  std::vector<Success> success;  ///< one per pipeline
  std::vector<SuccessComparison> success_comparisons;
  Repeating repeating = Repeating::none;
  std::vector<MetricAnalysis> metrics;
  std::vector<Trade> trades;          ///< of each two metrics of one's own
  std::vector<std::string> left_out;  ///< sentences on metrics that no run has, and trades
};

/// `data` and `times` as for in_order.
Analysis analyse(const StudyData& data, bool times);

/// True for outcomes caused by the plugin or its build, not by the problem.
bool unexplained(std::string_view outcome);
/// All outcomes, in the order of figures; `solved` first.
const std::vector<std::string>& outcome_order();
/// "out_of_memory" → "out of memory".
std::string outcome_text(std::string_view outcome);

/// Names of pipelines for figures and tables: of variants only the values, "weighted[0.3,0.7]" for
/// "weighted[weight_g=0.3,weight_h=0.7]", if unambiguous.
std::vector<std::string> short_names(const StudyData& data);
/// The keys of the values: "weighted[weight_g,weight_h]", one for each shortened entry.
std::vector<std::string> short_name_keys(const StudyData& data);

/// The name of a run, on the command line too: "PIPELINE SCENARIO #REPETITION".
std::string run_name(const StudyData& data, const RunRow& row);
/// The rows of each (scenario, repetition), one entry per pipeline; kNoRow if it has not run.
inline constexpr std::size_t kNoRow = std::size_t(-1);
struct Pair {
  std::size_t scenario = 0;
  int repetition = 0;
  std::vector<std::size_t> rows;
};
std::vector<Pair> pairs_of(const StudyData& data);
/// Those with values of their own of the metric: if all pipelines repeat themselves, one of each
/// scenario; all of a time or memory.
std::vector<Pair> distinct_pairs(const StudyData& data, const std::string& metric);
Repeating repeating(const StudyData& data);
/// What a table or figure has: each pipeline's values, pairs of two pipelines, pairs of all.
enum class Counted { values, pairs, common_pairs };
/// For captions: " (equal repetitions count once)", in which of them; "" if none do.
std::string counted_once(Repeating repeating, Counted counted);
}  // namespace altiplan::study::report
