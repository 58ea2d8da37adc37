// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "study/statistics/statistics.hpp"

namespace altiplan::study {

// Statistics of studies whose scenarios have repetitions. Repetitions are not independent: tests
// count each scenario once, intervals take values for as many independent ones as they are worth.
// With a single scenario, repetitions are independent. `groups` has the scenario of each value.

/// The units that a test counts.
struct Units {
  std::size_t count = 0;
  bool of_scenarios = false;  ///< otherwise repetitions of one

  std::string words() const;  ///< "20 scenarios", "5 repetitions"
};
Units units_of(std::span<const std::size_t> groups);

/// Why there is no interval that needs so many units: "too few scenarios: at least 6 for 95 %"; ""
/// if there is one.
std::string why_no_interval(const Units& units, double confidence, std::size_t fewest);

/// An interval and its method: "Wilson, 20 pairs", "order statistics, 20 scenarios"; or why there
/// is none.
struct MadeInterval {
  std::optional<Interval> interval;
  std::string method;
  std::string why_none;
};

// Of values with repetitions, Wilson's and Tango's intervals and those of quantiles take the number
// of pairs whose mean would vary as much as that of these does between scenarios: between the
// number of scenarios and that of the values, the former if all agree. E. L. Korn, B. I. Graubard,
// Survey Methodology 24, 1998, 193–201. All have neither interval nor reason without values.

/// Of the share of results that are 1; the others are 0.
MadeInterval share_interval(std::span<const double> results, std::span<const std::size_t> groups,
                            double confidence);
/// Of the difference of two shares: 1 if only the first of a pair succeeded, -1 if only the second,
/// 0 otherwise.
MadeInterval difference_interval(std::span<const double> differences,
                                 std::span<const std::size_t> groups, double confidence);
MadeInterval quantile_interval(std::span<const double> values, std::span<const std::size_t> groups,
                               double q, double confidence);
/// Of the mean over all values, whose units are the scenarios: at least `fewest`. None if more than
/// half are equal and fewer than that differ: how often these occur cannot be seen.
MadeInterval mean_interval(std::span<const double> values, std::span<const std::size_t> groups,
                           double confidence, std::size_t fewest);

/// The numbers of pairs of runs.
struct PairedSample {
  std::vector<double> first;
  std::vector<double> second;
  std::vector<std::size_t> groups;

  void add(double of_first, double of_second, std::size_t group);
  std::size_t size() const { return groups.size(); }
  /// True if the last pair is of this scenario.
  bool has(std::size_t group) const { return !groups.empty() && groups.back() == group; }
};

/// True if second / first is defined, false if only their difference is.
bool all_positive(const PairedSample& sample);

/// The difference of the second from the first.
struct PairedEffect {
  double median = kNone;             ///< over the pairs, of second / first or second - first
  std::optional<Interval> interval;  ///< between order statistics
  Units units;                       ///< of the test
  std::optional<Wilcoxon>
      test;  ///< on the units' medians of second - first, of ratios of their log
};
PairedEffect paired_effect(const PairedSample& sample, bool is_ratio, double confidence);

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
