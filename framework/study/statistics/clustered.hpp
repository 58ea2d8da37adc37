// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "study/statistics/statistics.hpp"

namespace altiplan::study {

// Statistics of studies whose scenarios have repetitions. Repetitions are not independent: tests
// count each scenario once, bootstrap intervals resample whole scenarios. With a single scenario,
// repetitions are counted and resampled. `groups` has the scenario of each value.

/// The units that a test counts.
struct Units {
  std::size_t count = 0;
  bool of_scenarios = false;  ///< otherwise repetitions of one

  std::string words() const;  ///< "20 scenarios", "5 repetitions"
};
Units units_of(std::span<const std::size_t> groups);

/// Why a bootstrap gives no interval: "too few scenarios: at least 6 for 95 %"; "" if it does.
std::string why_no_bootstrap(std::span<const std::size_t> groups, double confidence);

/// The numbers of pairs of runs.
struct PairedSample {
  std::vector<double> first;
  std::vector<double> second;
  std::vector<std::size_t> groups;

  void add(double of_first, double of_second, std::size_t group);
  std::size_t size() const { return groups.size(); }
};

/// True if second / first is defined, false if only their difference is.
bool all_positive(const PairedSample& sample);

/// The difference of the second from the first.
struct PairedEffect {
  double median = kNone;             ///< over the pairs, of second / first or second - first
  std::optional<Interval> interval;  ///< bootstrap
  Units units;                       ///< of the test
  std::optional<Wilcoxon> test;      ///< on the units' medians of second - first
};
PairedEffect paired_effect(const PairedSample& sample, bool is_ratio, const RandomStream& stream,
                           double confidence, std::size_t resamples = kResamples);

/// The interval of a share and its method: "Wilson, 20 pairs", "bootstrap of 20 scenarios".
struct ShareInterval {
  std::optional<Interval> interval;
  std::string method;  ///< "" without an interval
};
/// `results` are 0 or 1; no interval if empty. Wilson's interval if they are independent: one per
/// scenario, or all of one scenario. If all results agree, Wilson's with each scenario as one
/// trial, since a bootstrap would see no variation. Otherwise the bootstrap.
/// Seeded from the study, so that intervals of the same share are identical everywhere.
ShareInterval share_interval(std::span<const double> results, std::span<const std::size_t> groups,
                             std::uint64_t seed, double confidence);

/// The numbers of scenarios in which one of two succeeded more often than the other, and their
/// exact sign test; with one pair per scenario this is McNemar's test.
struct SuccessTest {
  Units units;
  std::size_t first_more = 0;
  std::size_t second_more = 0;
  double p = kNone;  ///< two-sided; NaN without pairs
};
/// A pair's numbers are 1 for success and 0 for failure.
SuccessTest success_test(const PairedSample& sample);
}  // namespace altiplan::study
