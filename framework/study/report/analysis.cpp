// SPDX-License-Identifier: Apache-2.0
#include "study/report/analysis.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "study/claims/claims.hpp"
#include "study/figures/text.hpp"
#include "study/model/run_values.hpp"

namespace altiplan::study::report {
namespace {

std::vector<Success> success_of(const StudyData& data) {
  struct Results {
    std::vector<double> solved;  // 0 or 1
    std::vector<std::size_t> scenarios;

    void add(const RunRow& row, bool is_once) {
      if (!is_once || scenarios.empty() || scenarios.back() != row.scenario) {
        solved.push_back(row.solved() ? 1 : 0);
        scenarios.push_back(row.scenario);
      }
    }
    MadeInterval interval() const { return share_interval(solved, scenarios, kConfidence); }
  };
  std::vector<Success> all(data.pipelines.size());
  std::vector<Results> results(data.pipelines.size());
  std::vector<Results> of_valid(data.pipelines.size());
  std::vector<std::map<std::string, std::size_t>> counts(data.pipelines.size());
  const std::vector<bool> repeat = repeat_themselves(data);
  for (const RunRow& row : data.rows) {
    ++all[row.pipeline].runs;
    all[row.pipeline].solved += row.solved();
    results[row.pipeline].add(row, repeat[row.pipeline]);
    if (row.outcome != "invalid_problem") {
      ++all[row.pipeline].valid;
      of_valid[row.pipeline].add(row, repeat[row.pipeline]);
    }
    ++counts[row.pipeline][row.outcome];
  }
  for (std::size_t p = 0; p < all.size(); ++p) {
    all[p].interval = results[p].interval();
    all[p].of_valid = of_valid[p].interval();
    for (const std::string& outcome : outcome_order()) {
      if (const auto found = counts[p].find(outcome); found != counts[p].end()) {
        all[p].outcomes.emplace_back(*found);
        counts[p].erase(found);
      }
    }
    all[p].outcomes.insert(all[p].outcomes.end(), counts[p].begin(), counts[p].end());
  }
  return all;
}

std::vector<SuccessComparison> compare_success(const StudyData& data,
                                               const std::vector<Pair>& pairs) {
  std::vector<SuccessComparison> all;
  std::vector<double> p;
  const std::vector<bool> repeat = repeat_themselves(data);
  for (std::size_t against = 0; against < data.pipelines.size(); ++against) {
    for (std::size_t pipeline = against + 1; pipeline < data.pipelines.size(); ++pipeline) {
      SuccessComparison comparison;
      comparison.pipeline = pipeline;
      comparison.against = against;
      PairedSample sample;
      std::vector<double> differences;
      const bool is_once = repeat[pipeline] && repeat[against];
      for (const Pair& pair : pairs) {
        if (pair.rows[pipeline] != kNoRow && pair.rows[against] != kNoRow &&
            !(is_once && sample.has(pair.scenario))) {
          const bool solved = data.rows[pair.rows[pipeline]].solved();
          const bool other_solved = data.rows[pair.rows[against]].solved();
          comparison.only_pipeline += solved && !other_solved;
          comparison.only_against += other_solved && !solved;
          sample.add(other_solved ? 1 : 0, solved ? 1 : 0, pair.scenario);
          differences.push_back(sample.second.back() - sample.first.back());
        }
      }
      comparison.pairs = sample.size();
      comparison.difference = difference_interval(differences, sample.groups, kConfidence);
      comparison.test = success_test(sample);
      p.push_back(comparison.test.p);
      all.push_back(comparison);
    }
  }
  const std::vector<double> adjusted = holm(p);
  for (std::size_t at = 0; at < all.size(); ++at) {
    all[at].p_holm = adjusted[at];
  }
  return all;
}

/// A metric's values on pairs, and their statistics.
class MetricAnalyser {
 public:
  MetricAnalyser(const StudyData& data, const std::vector<Pair>& pairs, const std::string& metric)
      : data_(data),
        pairs_(pairs),
        repeat_(is_measured(metric) ? std::vector<bool>(data.pipelines.size())
                                    : repeat_themselves(data)),
        column_(data.column(metric)),
        is_of_every_run_(is_of_every_run(metric)) {
    analysis_.metric = metric;
    analysis_.repeating = is_measured(metric) ? Repeating::none : repeating(data);
    analysis_.better = better(data, metric);
  }

  MetricAnalysis operator()() {
    take_samples();
    compare_all();
    std::vector<double> p;
    for (const Comparison& comparison : analysis_.comparisons) {
      p.push_back(comparison.p());
    }
    const std::vector<double> adjusted = holm(p);
    for (std::size_t at = 0; at < adjusted.size(); ++at) {
      analysis_.comparisons[at].p_holm = adjusted[at];
    }
    rank();
    return std::move(analysis_);
  }

 private:
  /// NaN for a run that is missing, did not solve (except for values that describe failures), or
  /// lacks the number.
  double value(std::size_t row) const {
    if (row == kNoRow || !(is_of_every_run_ || data_.rows[row].solved())) {
      return kNone;
    }
    const double found = data_.rows[row].values[column_];
    return std::isfinite(found) ? found : kNone;
  }

  void take_samples() {
    analysis_.samples.resize(data_.pipelines.size());
    for (std::size_t at = 0; at < data_.rows.size(); ++at) {
      if (const double found = value(at); !std::isnan(found)) {
        const RunRow& row = data_.rows[at];
        Sample& sample = analysis_.samples[row.pipeline];
        if (repeat_[row.pipeline] && !sample.rows.empty() &&
            data_.rows[sample.rows.back()].scenario == row.scenario) {
          continue;
        }
        sample.values.push_back(found);
        sample.rows.push_back(at);
      }
    }
    analysis_.is_ratio = true;
    for (Sample& sample : analysis_.samples) {
      sample.box = box_plot(sample.values);
      analysis_.is_ratio =
          analysis_.is_ratio && std::all_of(sample.values.begin(), sample.values.end(),
                                            [](double value) { return value > 0; });
    }
  }

  void compare_all() {
    for (std::size_t a = 0; a < data_.pipelines.size(); ++a) {
      for (std::size_t b = a + 1; b < data_.pipelines.size(); ++b) {
        analysis_.comparisons.push_back(compare(a, b));
      }
    }
  }

  Comparison compare(std::size_t against, std::size_t pipeline) const {
    Comparison comparison;
    comparison.pipeline = pipeline;
    comparison.against = against;
    const bool is_once = repeat_[against] && repeat_[pipeline];
    PairedSample sample;
    const Pair* last = nullptr;  // counted
    for (const Pair& pair : pairs_) {
      if (pair.rows[against] == kNoRow || pair.rows[pipeline] == kNoRow ||
          (is_once && last != nullptr && last->scenario == pair.scenario)) {
        continue;
      }
      last = &pair;
      ++comparison.pairs;
      const double x = value(pair.rows[against]);
      const double y = value(pair.rows[pipeline]);
      if (!std::isnan(x) && !std::isnan(y)) {
        sample.add(x, y, pair.scenario);
      }
    }
    comparison.used = sample.size();
    comparison.effect = paired_effect(sample, analysis_.is_ratio, kConfidence);
    return comparison;
  }

  void rank() {
    const std::size_t count = data_.pipelines.size();
    if (count < 3) {
      analysis_.why_no_ranking = "Ranks need three pipelines.";
      return;
    }
    // One list per scenario and pipeline, of the pairs that all pipelines solved.
    std::map<std::size_t, std::vector<std::vector<double>>> scenarios;
    for (const Pair& pair : distinct_pairs(data_, analysis_.metric)) {
      std::vector<double> values;
      for (const std::size_t row : pair.rows) {
        values.push_back(value(row));
      }
      if (std::none_of(values.begin(), values.end(), [](double v) { return std::isnan(v); })) {
        auto& lists = scenarios[pair.scenario];
        lists.resize(count);
        for (std::size_t p = 0; p < count; ++p) {
          lists[p].push_back(analysis_.better == Better::lower ? values[p] : -values[p]);
        }
      }
    }
    std::vector<std::vector<double>> treatments(count);
    for (const auto& [scenario, lists] : scenarios) {
      for (std::size_t p = 0; p < count; ++p) {
        if (scenarios.size() > 1) {
          treatments[p].push_back(median(lists[p]));
        } else {
          treatments[p] = lists[p];
        }
      }
    }
    finish_ranking(treatments, scenarios.size() > 1);
  }

  void finish_ranking(const std::vector<std::vector<double>>& treatments, bool of_scenarios) {
    const std::size_t blocks = treatments.front().size();
    const auto test = blocks < 2 ? std::nullopt : friedman(treatments);
    if (!test) {
      analysis_.why_no_ranking =
          "Ranks need two scenarios or repetitions that all pipelines solved; found " +
          std::to_string(blocks) + ".";
      return;
    }
    const double critical =
        critical_difference(int(treatments.size()), std::int64_t(blocks), kAlpha);
    analysis_.ranking =
        Ranking{blocks, of_scenarios, *test, critical, joined(test->average_ranks, critical)};
  }

  const StudyData& data_;
  const std::vector<Pair>& pairs_;
  std::vector<bool> repeat_;  ///< pipelines whose repetitions have equal values: one counts
  std::size_t column_;
  bool is_of_every_run_;
  MetricAnalysis analysis_;
};
/// The trade between two metrics; no pipelines where none has both values.
Trade trade_of(const StudyData& data, const std::array<std::string, 2>& metrics) {
  const std::vector<Pair> pairs = distinct_pairs(data, metrics[0]);
  Trade trade;
  trade.metrics = metrics;
  const auto value = [&](std::size_t row, std::size_t k) {
    const bool is_solved = row != kNoRow && data.rows[row].solved();
    const double found = is_solved ? data.rows[row].values[data.column(metrics[k])] : kNone;
    return std::isfinite(found) ? (trade.is_negated[k] ? -found : found) : kNone;
  };
  const auto has_both = [&](std::size_t row) {
    return !std::isnan(value(row, 0)) && !std::isnan(value(row, 1));
  };
  for (std::size_t k = 0; k < 2; ++k) {
    trade.is_negated[k] = better(data, metrics[k]) == Better::higher;
  }
  for (std::size_t p = 0; p < data.pipelines.size(); ++p) {
    if (std::any_of(pairs.begin(), pairs.end(),
                    [&](const Pair& pair) { return has_both(pair.rows[p]); })) {
      trade.pipelines.push_back(p);
    }
  }
  std::vector<std::array<std::vector<double>, 2>> values(trade.pipelines.size());
  for (const Pair& pair : pairs) {
    if (std::all_of(trade.pipelines.begin(), trade.pipelines.end(),
                    [&](std::size_t p) { return has_both(pair.rows[p]); })) {
      ++trade.pairs;
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i][0].push_back(value(pair.rows[trade.pipelines[i]], 0));
        values[i][1].push_back(value(pair.rows[trade.pipelines[i]], 1));
      }
    }
  }
  if (trade.pipelines.empty() || trade.pairs == 0) {
    trade.pipelines.clear();
    return trade;
  }
  for (const auto& [first, second] : values) {
    trade.places.push_back({median(first), median(second)});
  }
  Place best{};
  for (std::size_t k = 0; k < 2; ++k) {
    const auto [least, most] =
        std::minmax_element(trade.places.begin(), trade.places.end(),
                            [&](const Place& a, const Place& b) { return a[k] < b[k]; });
    best[k] = (*least)[k];
    trade.reference[k] = (*most)[k] + 0.1 * ((*most)[k] - best[k]);
  }
  trade.front = non_dominated(trade.places);
  trade.hypervolume = hypervolume(trade.places, trade.reference);
  const double all = (trade.reference[0] - best[0]) * (trade.reference[1] - best[1]);
  trade.share = all > 0 ? trade.hypervolume / all : kNone;
  return trade;
}
}  // namespace

Analysis analyse(const StudyData& data, bool times) {
  Analysis analysis;
  const std::vector<Pair> pairs = pairs_of(data);
  analysis.success = success_of(data);
  analysis.success_comparisons = compare_success(data, pairs);
  analysis.repeating = repeating(data);
  std::set<std::string> files;  // of figures, named by their metric
  for (const std::string& metric : compared_metrics(data)) {
    if (!files.insert(slug(metric)).second) {
      analysis.left_out.push_back(metric + " is listed twice.");
    } else if (data.column(metric) < data.columns.size()) {
      analysis.metrics.push_back(MetricAnalyser(data, pairs, metric)());
    } else {
      analysis.left_out.push_back(metric + (!times && is_measured(metric)
                                                ? " is not compared: it varies between equal runs."
                                                : " is not compared: no run has this value."));
    }
  }
  for (std::size_t a = 0; a < analysis.metrics.size(); ++a) {
    for (std::size_t b = a + 1; b < analysis.metrics.size(); ++b) {
      const std::string& first = analysis.metrics[a].metric;
      const std::string& second = analysis.metrics[b].metric;
      if (!is_own_metric(first) || !is_own_metric(second)) {
        continue;
      }
      analysis.trades.push_back(trade_of(data, {first, second}));
      if (analysis.trades.back().pipelines.empty()) {
        analysis.trades.pop_back();
        analysis.left_out.push_back(first + " and " + second +
                                    " are not weighed: no pair (scenario, repetition) has both of "
                                    "every pipeline that solved.");
      }
    }
  }
  return analysis;
}
}  // namespace altiplan::study::report
