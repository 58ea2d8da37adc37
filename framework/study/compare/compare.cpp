// SPDX-License-Identifier: Apache-2.0
#include "study/compare/compare.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <tuple>

#include "altiplan/error.hpp"
#include "host/config/config_check.hpp"
#include "study/claims/claims.hpp"

namespace altiplan::study {
namespace {

constexpr double kConfidence = 0.95;

struct Pair {
  const RunRow* first = nullptr;
  const RunRow* second = nullptr;
  std::size_t pipeline = 0;  ///< indices into the first study's
  std::size_t scenario = 0;
};

using Cell = std::tuple<std::string, std::string, int>;

/// Later rows of the same cell, made with other files or builds, replace earlier ones.
std::map<Cell, const RunRow*> cells_of(const StudyData& data) {
  std::map<Cell, const RunRow*> cells;
  for (const RunRow& row : data.rows) {
    const RunRow*& there = cells[{data.pipelines[row.pipeline].name,
                                  data.scenarios[row.scenario].name, row.repetition}];
    if (there == nullptr || std::tie(there->store, there->id) < std::tie(row.store, row.id)) {
      there = &row;
    }
  }
  return cells;
}

std::string name_of(const StudyData& data, const Pair& pair) {
  return run_name(data.pipelines[pair.pipeline].name, data.scenarios[pair.scenario].name,
                  pair.first->repetition);
}

double value_of(const StudyData& data, const RunRow& row, const std::string& metric) {
  const std::size_t column = data.column(metric);
  return column < row.values.size() ? row.values[column] : kNone;
}

class Comparer {
 public:
  Comparer(const StudyData& first, const StudyData& second, const CompareOptions& options)
      : first_(first), second_(second), options_(options) {}

  Comparison compare() {
    make_pairs();
    compare_origins();
    compare_outcomes();
    const std::vector<std::string> metrics =
        options_.metrics.empty() ? compared_metrics(first_) : options_.metrics;
    for (const std::string& metric : metrics) {
      expect_known(metric);
      if (!is_measured(metric)) {
        compare_values(metric);
      }
      compare_metric(metric);
    }
    return std::move(comparison_);
  }

 private:
  void make_pairs() {
    const auto of_first = cells_of(first_);
    const auto of_second = cells_of(second_);
    for (const auto& [cell, row] : of_first) {
      const auto found = of_second.find(cell);
      if (found == of_second.end()) {
        ++comparison_.only_first;
      } else if (row->seed != found->second->seed) {
        ++comparison_.other_seeds;
      } else {
        pairs_.push_back({row, found->second, row->pipeline, row->scenario});
      }
    }
    comparison_.only_second = of_second.size() - pairs_.size() - comparison_.other_seeds;
    comparison_.pairs = pairs_.size();
    if (pairs_.empty()) {
      throw Error(
          "the studies have no run in common: pipeline, scenario, repetition and seed must "
          "be the same (" +
          std::to_string(of_first.size()) + " runs in '" + first_.stores.front() + "', " +
          std::to_string(of_second.size()) + " in '" + second_.stores.front() + "')");
    }
    // In the order of the study, not by name.
    std::stable_sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
      return std::tie(a.pipeline, a.scenario, a.first->repetition) <
             std::tie(b.pipeline, b.scenario, b.first->repetition);
    });
  }

  void compare_origins() {
    for (const Pair& pair : pairs_) {
      if (pair.first->key != pair.second->key) {
        comparison_.other_origins.push_back({pair.first, pair.second});
      }
    }
  }

  void compare_outcomes() {
    for (const Pair& pair : pairs_) {
      const RunRow& before = *pair.first;
      const RunRow& after = *pair.second;
      if (before.outcome != after.outcome) {
        auto& list = before.solved()  ? comparison_.lost
                     : after.solved() ? comparison_.won
                                      : comparison_.others;
        list.push_back({name_of(first_, pair), before.outcome, after.outcome, after.message});
      }
    }
  }

  void expect_known(const std::string& metric) const {
    if (!options_.metrics.empty() && first_.column(metric) == first_.columns.size() &&
        second_.column(metric) == second_.columns.size()) {
      throw Error("--metric: no run has a value named '" + metric + "'" +
                  host::did_you_mean(metric, first_.columns));
    }
  }

  /// Over the pairs that both solved with the metric; the groups are scenarios.
  PairedSample sample(const std::string& metric, std::size_t pipeline) const {
    PairedSample sample;
    for (const Pair& pair : pairs_) {
      const double before = value_of(first_, *pair.first, metric);
      const double after = value_of(second_, *pair.second, metric);
      if (pair.pipeline == pipeline && pair.first->solved() && pair.second->solved() &&
          std::isfinite(before) && std::isfinite(after)) {
        sample.add(before, after, pair.scenario);
      }
    }
    return sample;
  }

  void compare_values(const std::string& metric) {
    for (const Pair& pair : pairs_) {
      const double before = value_of(first_, *pair.first, metric);
      const double after = value_of(second_, *pair.second, metric);
      if (std::isfinite(before) && std::isfinite(after) && before != after) {
        comparison_.differing.push_back({name_of(first_, pair), metric, before, after});
      }
    }
  }

  void compare_metric(const std::string& metric) {
    std::map<std::size_t, PairedSample> samples;  // by pipeline
    for (const Pair& pair : pairs_) {
      samples.try_emplace(pair.pipeline);
    }
    bool is_ratio = true;
    for (auto& [pipeline, pairs] : samples) {
      pairs = sample(metric, pipeline);
      is_ratio = is_ratio && all_positive(pairs);
    }
    std::vector<MetricChange> changes;
    std::vector<double> p;
    for (const auto& [pipeline, pairs] : samples) {
      changes.push_back(change_of(metric, pipeline, pairs, is_ratio));
      p.push_back(changes.back().p);
    }
    const std::vector<double> adjusted = holm(p);
    for (std::size_t n = 0; n < changes.size(); ++n) {
      changes[n].p = adjusted[n];
      judge(changes[n]);
      comparison_.metrics.push_back(changes[n]);
    }
  }

  MetricChange change_of(const std::string& metric, std::size_t pipeline, const PairedSample& pairs,
                         bool is_ratio) const {
    MetricChange change;
    change.pipeline = first_.pipelines[pipeline].name;
    change.metric = metric;
    change.pairs = pairs.size();
    change.is_ratio = is_ratio;
    if (change.pairs == 0) {
      return change;
    }
    change.before = median(pairs.first);
    change.after = median(pairs.second);
    change.effect = paired_effect(pairs, is_ratio, kConfidence);
    change.why_no_interval =
        why_no_interval(units_of(pairs.groups), kConfidence, fewest_units(kConfidence));
    change.p = change.effect.test ? change.effect.test->p : kNone;
    if (pairs.first == pairs.second) {
      change.verdict = MetricChange::Verdict::same;
    }
    if (!change.effect.interval && !is_measured(change.metric)) {
      change.range = range_of(pairs, is_ratio);
    }
    return change;
  }

  /// The minimum and maximum change of a pair.
  static Interval range_of(const PairedSample& pairs, bool is_ratio) {
    Interval range{std::numeric_limits<double>::infinity(),
                   -std::numeric_limits<double>::infinity()};
    for (std::size_t at = 0; at < pairs.size(); ++at) {
      const double change =
          is_ratio ? pairs.second[at] / pairs.first[at] : pairs.second[at] - pairs.first[at];
      range = {std::min(range.low, change), std::max(range.high, change)};
    }
    return range;
  }

  /// By the interval alone if the value depends only on files and program. Times and memory must
  /// also differ significantly.
  void judge(MetricChange& change) const {
    using Verdict = MetricChange::Verdict;
    if (change.pairs == 0 || change.verdict == Verdict::same) {
      return;
    }
    if (!change.effect.interval && !change.range) {
      change.verdict = Verdict::unclear;
      return;
    }
    const Interval interval = change.range ? *change.range : *change.effect.interval;
    const bool measured = is_measured(change.metric);
    const double base = change.is_ratio ? 1 : 0;
    const double reach = options_.tolerance * (change.is_ratio ? 1 : std::abs(change.before));
    const bool significant = !measured || change.p < 1 - kConfidence;
    const bool is_lower_better = better(first_, change.metric) == Better::lower;
    if (interval.low > base + reach && significant) {
      change.verdict = is_lower_better ? Verdict::worse : Verdict::better;
    } else if (interval.high < base - reach && significant) {
      change.verdict = is_lower_better ? Verdict::better : Verdict::worse;
    } else if (interval.low >= base - reach && interval.high <= base + reach) {
      change.verdict = Verdict::within;
    } else {
      change.verdict = Verdict::unclear;
    }
  }

  const StudyData& first_;
  const StudyData& second_;
  const CompareOptions& options_;
  std::vector<Pair> pairs_;
  Comparison comparison_;
};
}  // namespace

bool Comparison::differs_in_times_only() const {
  const auto any = [&](bool measured, auto&& is) {
    return std::any_of(metrics.begin(), metrics.end(), [&](const MetricChange& change) {
      return is_measured(change.metric) == measured && change.pairs > 0 && is(change);
    });
  };
  const auto differs = [](const MetricChange& change) {
    return change.verdict != MetricChange::Verdict::same;
  };
  return any(true, differs) && any(false, std::not_fn(differs)) && !any(false, differs) &&
         lost.empty() && won.empty() && others.empty() && differing.empty();
}

bool Comparison::is_worse() const {
  return !lost.empty() || std::any_of(metrics.begin(), metrics.end(), [](const auto& change) {
    return change.verdict == MetricChange::Verdict::worse;
  });
}

Comparison compare_studies(const StudyData& first, const StudyData& second,
                           const CompareOptions& options) {
  return Comparer(first, second, options).compare();
}
}  // namespace altiplan::study
