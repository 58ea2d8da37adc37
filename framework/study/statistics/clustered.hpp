// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "study/statistics/statistics.hpp"

namespace altiplan::study {

// Statistics of studies whose scenarios have repetitions. These are no independent evidence: tests
// count a scenario once, intervals draw whole scenarios. Of one scenario, repetitions are what is
// counted and drawn. `groups` has the scenario of each value.

/// What a test counts.
struct Units {
  std::size_t count = 0;
  bool of_scenarios = false;  ///< else repetitions of one

  std::string words() const;  ///< "20 scenarios", "5 repetitions"
};
Units units_of(std::span<const std::size_t> groups);

/// Why a bootstrap gives no interval: "too few scenarios: at least 6 for 95 %"; "" where it does.
std::string why_no_bootstrap(std::span<const std::size_t> groups, double confidence);

/// The numbers of pairs of runs.
struct PairedSample {
  std::vector<double> first;
  std::vector<double> second;
  std::vector<std::size_t> groups;

  void add(double of_first, double of_second, std::size_t group);
  std::size_t size() const { return groups.size(); }
};

/// Whether second / first can be taken, or their difference only.
bool all_positive(const PairedSample& sample);

/// How the second differs from the first.
struct PairedEffect {
  double median = kNone;             ///< over the pairs, of second / first or second - first
  std::optional<Interval> interval;  ///< bootstrap
  Units units;                       ///< of the test
  std::optional<Wilcoxon> test;      ///< on the units' medians of second - first
};
PairedEffect paired_effect(const PairedSample& sample, bool is_ratio, const RandomStream& stream,
                           double confidence, std::size_t resamples = kResamples);

/// The interval of a share, and how it was found: "Wilson, 20 pairs", "bootstrap of 20 scenarios".
struct ShareInterval {
  std::optional<Interval> interval;
  std::string method;  ///< "" without an interval
};
/// `results` are 0 or 1; nothing of none. Wilson's interval where they are independent: one
/// per scenario, or all of one scenario. Where all agree a bootstrap would see no variation and be
/// certain after two scenarios: then Wilson's with each scenario as one trial. Else the bootstrap.
/// Two intervals of the same share are the same, whoever asks, by the seed of the study.
ShareInterval share_interval(std::span<const double> results, std::span<const std::size_t> groups,
                             std::uint64_t seed, double confidence);

/// In how many scenarios one of two succeeded more often than the other, and the exact sign test of
/// these numbers; with one pair per scenario that is McNemar's test.
struct SuccessTest {
  Units units;
  std::size_t first_more = 0;
  std::size_t second_more = 0;
  double p = kNone;  ///< two-sided; NaN without pairs
};
/// A pair's numbers are 1 where it succeeded, 0 where it did not.
SuccessTest success_test(const PairedSample& sample);
}  // namespace altiplan::study
