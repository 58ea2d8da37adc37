// SPDX-License-Identifier: Apache-2.0
#include "study/statistics/clustered.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "host/base/words.hpp"

namespace altiplan::study {
namespace {

/// The sum of each scenario's deviations from the mean, as one of a sample with that mean; of each
/// value if there is one scenario.
std::vector<double> deviations_of(std::span<const double> values,
                                  std::span<const std::size_t> groups) {
  const double mean_of_all = mean(values);
  std::map<std::size_t, double> sums;
  std::vector<double> deviations;
  for (std::size_t at = 0; at < values.size(); ++at) {
    sums[groups[at]] += values[at] - mean_of_all;
    deviations.push_back(values[at] - mean_of_all);
  }
  if (sums.size() > 1) {
    deviations.clear();
    for (const auto& [scenario, sum] : sums) {
      deviations.push_back(sum * double(sums.size()) / double(values.size()));
    }
  }
  return deviations;
}

double sum_of_squares(std::span<const double> values) {
  return std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
}

/// The number of independent values whose mean varies as much as that of these. What the scenarios
/// add to the variance is estimated from few of them: it counts the more, the longer the tail of
/// Student's t.
double effective_size(std::span<const double> values, std::span<const std::size_t> groups,
                      double confidence) {
  const double size = double(values.size());
  const std::vector<double> deviations = deviations_of(values, groups);
  const double units = double(deviations.size());
  if (units == size) {
    return size;
  }
  std::vector<double> each(values.begin(), values.end());
  const double mean_of_all = mean(values);
  std::for_each(each.begin(), each.end(), [&](double& value) { value -= mean_of_all; });
  const double variance = sum_of_squares(each) / size;
  if (!(variance > 0)) {
    return units;
  }
  const double of_mean = sum_of_squares(deviations) / (units - 1) / units;
  const double tail = student_quantile((1 + confidence) / 2, int(units) - 1) /
                      normal_quantile((1 + confidence) / 2);
  const double added = std::max(of_mean / variance - 1 / size, 0.0) * tail * tail;
  return std::clamp(1 / (1 / size + added), units, size);
}

/// The most frequent of these values, of 12 digits, occurs so often.
std::size_t greatest_count(std::span<const double> values) {
  std::map<double, std::size_t> counts;
  std::size_t most = 0;
  for (const double value : values) {
    most = std::max(most, ++counts[in_12_digits(value)]);
  }
  return most;
}

std::string method_of(const char* name, std::span<const double> values, const Units& units) {
  return std::string(name) + ", " +
         (units.count == values.size() ? host::counted(units.count, "pair") : units.words());
}

/// The logarithm of the ratio of two values of 12 digits, in as many decimals, so that equal ratios
/// are tied.
double log_ratio(double first, double second) {
  return std::round(std::log(second / first) * 1e12) / 1e12;
}

/// The differences of each scenario, or the logarithms of ratios; of each pair if there is one
/// scenario.
std::vector<std::vector<double>> differences_of(const PairedSample& sample, bool is_ratio) {
  std::map<std::size_t, std::vector<double>> by_scenario;
  for (std::size_t at = 0; at < sample.size(); ++at) {
    by_scenario[sample.groups[at]].push_back(is_ratio
                                                 ? log_ratio(sample.first[at], sample.second[at])
                                                 : sample.second[at] - sample.first[at]);
  }
  std::vector<std::vector<double>> units;
  for (const auto& [scenario, differences] : by_scenario) {
    if (by_scenario.size() > 1) {
      units.push_back(differences);
      continue;
    }
    for (const double difference : differences) {
      units.push_back({difference});
    }
  }
  return units;
}

}  // namespace

std::string Units::words() const {
  return host::counted(count, of_scenarios ? "scenario" : "repetition");
}

Units units_of(std::span<const std::size_t> groups) {
  const std::set<std::size_t> scenarios(groups.begin(), groups.end());
  return scenarios.size() > 1 ? Units{scenarios.size(), true} : Units{groups.size(), false};
}

std::string why_no_interval(const Units& units, double confidence, std::size_t fewest) {
  if (units.count >= fewest) {
    return "";
  }
  return std::string("too few ") + (units.of_scenarios ? "scenarios" : "repetitions") +
         ": at least " + std::to_string(fewest) + " for " + host::per_cent(confidence);
}

MadeInterval share_interval(std::span<const double> results, std::span<const std::size_t> groups,
                            double confidence) {
  if (results.empty()) {
    return {};
  }
  const double size = effective_size(results, groups, confidence);
  const double share = mean(results);
  return {wilson(share == 1 ? size : share * size, size, confidence),
          method_of("Wilson", results, units_of(groups)), ""};
}

MadeInterval difference_interval(std::span<const double> differences,
                                 std::span<const std::size_t> groups, double confidence) {
  if (differences.empty()) {
    return {};
  }
  const double size = effective_size(differences, groups, confidence);
  const auto share_of = [&](double value) {
    return double(std::count(differences.begin(), differences.end(), value)) /
           double(differences.size());
  };
  return {tango(share_of(1) * size, share_of(-1) * size, size, confidence),
          method_of("Tango", differences, units_of(groups)), ""};
}

MadeInterval quantile_interval(std::span<const double> values, std::span<const std::size_t> groups,
                               double q, double confidence) {
  if (values.empty()) {
    return {};
  }
  const Units units = units_of(groups);
  MadeInterval made;
  made.why_none = why_no_interval(units, confidence, fewest_units(confidence, q));
  if (!made.why_none.empty()) {
    return made;
  }
  const double estimate = quantile(values, q);
  std::vector<double> below;
  for (const double value : values) {
    below.push_back(value <= estimate ? 1 : 0);
  }
  made.interval =
      quantile_interval(values, q, effective_size(below, groups, confidence), confidence);
  made.method = method_of("order statistics", values, units);
  return made;
}

MadeInterval mean_interval(std::span<const double> values, std::span<const std::size_t> groups,
                           double confidence, std::size_t fewest) {
  if (values.empty()) {
    return {};
  }
  const Units units = units_of(groups);
  MadeInterval made;
  made.why_none = why_no_interval(units, confidence, fewest);
  if (!made.why_none.empty()) {
    return made;
  }
  const std::vector<double> deviations = deviations_of(values, groups);
  const std::size_t others = deviations.size() - greatest_count(deviations);
  if (others < fewest && 2 * others < deviations.size()) {
    made.why_none = others == 0 ? "all values are equal"
                                : "all but " + std::to_string(others) + " values are equal";
    return made;
  }
  made.interval = mean_interval(mean(values), deviations, confidence);
  made.method = method_of("Student's t, skewness corrected", values, units);
  return made;
}

void PairedSample::add(double of_first, double of_second, std::size_t group) {
  first.push_back(of_first);
  second.push_back(of_second);
  groups.push_back(group);
}

bool all_positive(const PairedSample& sample) {
  const auto is_positive = [](double value) { return value > 0; };
  return std::all_of(sample.first.begin(), sample.first.end(), is_positive) &&
         std::all_of(sample.second.begin(), sample.second.end(), is_positive);
}

PairedEffect paired_effect(const PairedSample& sample, bool is_ratio, double confidence) {
  std::vector<double> changes;
  for (std::size_t at = 0; at < sample.size(); ++at) {
    changes.push_back(is_ratio ? sample.second[at] / sample.first[at]
                               : sample.second[at] - sample.first[at]);
  }
  PairedEffect effect;
  effect.median = median(changes);
  effect.interval = quantile_interval(changes, sample.groups, 0.5, confidence).interval;
  effect.units = units_of(sample.groups);
  std::vector<double> medians;
  for (const std::vector<double>& differences : differences_of(sample, is_ratio)) {
    medians.push_back(median(differences));
  }
  effect.test = wilcoxon(medians);
  return effect;
}

SuccessTest success_test(const PairedSample& sample) {
  SuccessTest test;
  test.units = units_of(sample.groups);
  for (const std::vector<double>& differences : differences_of(sample, false)) {
    double more = 0;
    for (const double difference : differences) {
      more += difference;
    }
    test.first_more += more < 0;
    test.second_more += more > 0;
  }
  if (sample.size() > 0) {
    test.p = mcnemar(std::int64_t(test.first_more), std::int64_t(test.second_more));
  }
  return test;
}
}  // namespace altiplan::study
