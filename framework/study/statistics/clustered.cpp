// SPDX-License-Identifier: Apache-2.0
#include "study/statistics/clustered.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "host/base/words.hpp"

namespace altiplan::study {
namespace {

/// Without a copy, since it is computed for 10,000 resamples; the sample has no NaN.
double median_in_place(std::span<double> sample) {
  const auto middle = sample.begin() + std::ptrdiff_t(sample.size() / 2);
  std::nth_element(sample.begin(), middle, sample.end());
  return sample.size() % 2 == 1 ? *middle
                                : (*middle + *std::max_element(sample.begin(), middle)) / 2;
}

/// The median difference of each scenario; of each pair if there is one scenario.
std::vector<std::vector<double>> differences_of(const PairedSample& sample) {
  std::map<std::size_t, std::vector<double>> by_scenario;
  for (std::size_t at = 0; at < sample.size(); ++at) {
    by_scenario[sample.groups[at]].push_back(sample.second[at] - sample.first[at]);
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

bool is_of_scenarios(std::span<const std::size_t> groups) {
  return std::any_of(groups.begin(), groups.end(),
                     [&](std::size_t group) { return group != groups.front(); });
}
}  // namespace

std::string Units::words() const {
  return host::counted(count, of_scenarios ? "scenario" : "repetition");
}

Units units_of(std::span<const std::size_t> groups) {
  return {resampled_units(groups), is_of_scenarios(groups)};
}

std::string why_no_bootstrap(std::span<const std::size_t> groups, double confidence) {
  const std::size_t fewest = fewest_units(confidence);
  if (resampled_units(groups) >= fewest) {
    return "";
  }
  const char* what = is_of_scenarios(groups) ? "scenarios" : "repetitions";
  return std::string("too few ") + what + ": at least " + std::to_string(fewest) + " for " +
         host::per_cent(confidence);
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

PairedEffect paired_effect(const PairedSample& sample, bool is_ratio, const RandomStream& stream,
                           double confidence, std::size_t resamples) {
  std::vector<double> changes;
  for (std::size_t at = 0; at < sample.size(); ++at) {
    changes.push_back(is_ratio ? sample.second[at] / sample.first[at]
                               : sample.second[at] - sample.first[at]);
  }
  PairedEffect effect;
  effect.median = median(changes);
  effect.interval =
      bootstrap_interval(changes, sample.groups, median_in_place, stream, confidence, resamples);
  effect.units = units_of(sample.groups);
  std::vector<double> medians;
  for (const std::vector<double>& differences : differences_of(sample)) {
    medians.push_back(median(differences));
  }
  effect.test = wilcoxon(medians);
  return effect;
}

ShareInterval share_interval(std::span<const double> results, std::span<const std::size_t> groups,
                             std::uint64_t seed, double confidence) {
  if (results.empty()) {
    return {};
  }
  const Units units = units_of(groups);
  const double share = mean(results);
  const bool is_independent = units.count == results.size();
  if (is_independent || share == 0 || share == 1) {
    const auto interval =
        wilson(std::llround(share * double(units.count)), std::int64_t(units.count), confidence);
    return {interval, interval ? "Wilson, " + (is_independent ? host::counted(units.count, "pair")
                                                              : units.words())
                               : ""};
  }
  const auto interval = bootstrap_interval(
      results, groups, [](std::span<double> sample) { return mean(sample); },
      RandomStream(seed).sub("share"), confidence);
  return {interval, interval ? "bootstrap of " + units.words() : ""};
}

SuccessTest success_test(const PairedSample& sample) {
  SuccessTest test;
  test.units = units_of(sample.groups);
  for (const std::vector<double>& differences : differences_of(sample)) {
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
