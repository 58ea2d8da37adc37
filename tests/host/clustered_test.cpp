// SPDX-License-Identifier: Apache-2.0
#include "study/statistics/clustered.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace altiplan::host::clustered_test {
using namespace study;
namespace {
using Sample = std::vector<double>;
using Indices = std::vector<std::size_t>;

/// Scenario s has `repetitions` pairs; `second` gives the second's number, the first's is 100.
PairedSample pairs(std::size_t scenarios, int repetitions, double (*second)(std::size_t, int)) {
  PairedSample sample;
  for (std::size_t s = 0; s < scenarios; ++s) {
    for (int r = 0; r < repetitions; ++r) {
      sample.add(100, second(s, r), s);
    }
  }
  return sample;
}

PairedEffect effect(const PairedSample& sample, bool is_ratio = true) {
  return paired_effect(sample, is_ratio, 0.95);
}

TEST(Clustered, RepetitionsAreNoEvidence) {
  const auto longer = [](std::size_t s, int) { return 101 + double(s); };
  const PairedEffect once = effect(pairs(8, 1, longer));
  const PairedEffect often = effect(pairs(8, 20, longer));
  EXPECT_EQ(once.test->p, 2.0 / 256);
  EXPECT_EQ(often.test->p, once.test->p);
  EXPECT_EQ(often.units.count, 8U);
  EXPECT_TRUE(often.units.of_scenarios);
  EXPECT_EQ(often.units.words(), "8 scenarios");
  EXPECT_NEAR(often.interval->low, once.interval->low, 0.01) << "between the same two";
}

TEST(Clustered, OfOneScenarioRepetitionsCount) {
  const PairedEffect one = effect(pairs(1, 8, [](std::size_t, int r) { return 101.0 + r; }));
  EXPECT_EQ(one.test->p, 2.0 / 256);
  EXPECT_EQ(one.units.words(), "8 repetitions");
  EXPECT_TRUE(one.interval);
}

TEST(Clustered, AScenarioCountsWithItsMedian) {
  // One repetition of each scenario is far below: by the pairs' ranks there is nothing to see.
  const PairedEffect made = effect(
      pairs(10, 3, [](std::size_t s, int r) { return r == 0 ? 1 : 101 + double(s); }), false);
  EXPECT_EQ(made.test->rank_biserial, 1);
  EXPECT_EQ(made.test->used, 10U);
}

TEST(Clustered, RatiosOrDifferences) {
  const PairedSample twice = pairs(10, 1, [](std::size_t, int) { return 200.0; });
  EXPECT_EQ(effect(twice, true).median, 2);
  EXPECT_EQ(effect(twice, false).median, 100);
  EXPECT_TRUE(all_positive(twice));
  EXPECT_FALSE(all_positive(pairs(3, 1, [](std::size_t s, int) { return double(s); })));
  EXPECT_TRUE(all_positive({}));
}

TEST(Clustered, OfNothing) {
  const PairedEffect nothing = effect({});
  EXPECT_TRUE(std::isnan(nothing.median));
  EXPECT_FALSE(nothing.interval);
  EXPECT_FALSE(nothing.test);
  EXPECT_EQ(nothing.units.count, 0U);
  EXPECT_FALSE(share_interval({}, {}, 0.95).interval);
  EXPECT_FALSE(difference_interval({}, {}, 0.95).interval);
  EXPECT_FALSE(quantile_interval(Sample{}, Indices{}, 0.5, 0.95).interval);
  EXPECT_FALSE(mean_interval(Sample{}, Indices{}, 0.95, 10).interval);
  EXPECT_TRUE(std::isnan(success_test({}).p));
}

TEST(Clustered, SaysWhyThereIsNoInterval) {
  EXPECT_EQ(why_no_interval({3, true}, 0.95, fewest_units(0.95)),
            "too few scenarios: at least 6 for 95 %");
  EXPECT_EQ(why_no_interval({2, false}, 0.99, fewest_units(0.99)),
            "too few repetitions: at least 8 for 99 %");
  EXPECT_EQ(why_no_interval({6, true}, 0.95, fewest_units(0.95)), "");
  EXPECT_EQ(why_no_interval({71, true}, 0.95, fewest_units(0.95, 0.95)),
            "too few scenarios: at least 72 for 95 %");
  const auto few = effect(pairs(5, 9, [](std::size_t s, int) { return 101 + double(s); }));
  EXPECT_FALSE(few.interval);
  EXPECT_TRUE(few.test);
}

/// The group of each value, `repetitions` values per group.
Indices each(std::size_t scenarios, std::size_t repetitions) {
  Indices groups;
  for (std::size_t at = 0; at < scenarios * repetitions; ++at) {
    groups.push_back(at / repetitions);
  }
  return groups;
}

TEST(Clustered, SharesOfIndependentPairsAreWilsons) {
  const Sample solved{1, 1, 0, 1};
  for (const Indices& groups : {Indices{0, 1, 2, 3}, Indices{7, 7, 7, 7}}) {
    const MadeInterval found = share_interval(solved, groups, 0.95);
    EXPECT_EQ(found.method, "Wilson, 4 pairs");
    EXPECT_EQ(found.interval->low, wilson(3, 4, 0.95)->low);
  }
}

TEST(Clustered, RepetitionsCountForWhatTheyAreWorth) {
  const Indices groups = each(10, 3);
  Sample solved(30, 1.0);
  EXPECT_EQ(share_interval(solved, groups, 0.95).method, "Wilson, 10 scenarios");
  EXPECT_EQ(share_interval(solved, groups, 0.95).interval->low, wilson(10, 10, 0.95)->low);
  // All repetitions of a scenario alike: worth no more than the scenarios.
  solved[0] = solved[1] = solved[2] = 0;
  EXPECT_NEAR(share_interval(solved, groups, 0.95).interval->low, wilson(9, 10, 0.95)->low, 1e-12);
  // One repetition in each of three: nearly as good as independent.
  solved[1] = solved[2] = 1;
  solved[3] = solved[6] = 0;
  const Interval apart = *share_interval(solved, groups, 0.95).interval;
  EXPECT_GT(apart.low, wilson(9, 10, 0.95)->low + 0.1);
  EXPECT_LE(apart.low, wilson(27, 30, 0.95)->low);
  const MadeInterval few =
      share_interval(std::span(solved).first(9), std::span(groups).first(9), 0.95);
  EXPECT_TRUE(few.interval) << "of 3 scenarios it is wide, but it is one";
}

TEST(Clustered, NoDifferenceIsNoCertainty) {
  const Sample none(20, 0.0);
  const MadeInterval found = difference_interval(none, each(20, 1), 0.95);
  EXPECT_EQ(found.method, "Tango, 20 pairs");
  EXPECT_NEAR(found.interval->high, 0.161125, 1e-6);
  EXPECT_EQ(difference_interval(none, each(4, 5), 0.95).interval->high, tango(0, 0, 4, 0.95)->high);
  Sample some(20, 0.0);
  some[0] = some[1] = 1;
  some[2] = -1;
  EXPECT_NEAR(difference_interval(some, each(20, 1), 0.95).interval->low,
              tango(2, 1, 20, 0.95)->low, 1e-12);
}

TEST(Clustered, QuantilesAndMeansOfRepetitions) {
  Sample values;
  for (std::size_t s = 0; s < 10; ++s) {
    values.insert(values.end(), 3, double(s));
  }
  const Indices groups = each(10, 3);
  const MadeInterval middle = quantile_interval(values, groups, 0.5, 0.95);
  EXPECT_EQ(middle.method, "order statistics, 10 scenarios");
  Sample once;
  for (std::size_t s = 0; s < 10; ++s) {
    once.push_back(double(s));
  }
  const Interval of_once = *quantile_interval(once, each(10, 1), 0.5, 0.95).interval;
  EXPECT_NEAR(middle.interval->low, of_once.low, 1);
  EXPECT_NEAR(middle.interval->high, of_once.high, 1);
  EXPECT_EQ(quantile_interval(values, groups, 0.95, 0.95).why_none,
            "too few scenarios: at least 72 for 95 %");
  const MadeInterval average = mean_interval(values, groups, 0.95, 10);
  EXPECT_EQ(average.method, "Student's t, skewness corrected, 10 scenarios");
  EXPECT_NEAR(average.interval->low, mean_interval(once, each(10, 1), 0.95, 10).interval->low,
              1e-12);
  EXPECT_EQ(mean_interval(Sample(30, 2.0), groups, 0.95, 10).why_none, "all values are equal");
  Sample rare(100, 0.0);
  rare[3] = rare[50] = 1;
  EXPECT_EQ(mean_interval(rare, each(100, 1), 0.95, 10).why_none, "all but 2 values are equal")
      << "two of two are no evidence";
  EXPECT_EQ(
      mean_interval(std::span(values).first(27), std::span(groups).first(27), 0.95, 10).why_none,
      "too few scenarios: at least 10 for 95 %");
}

TEST(Clustered, SuccessesOfOneRepetitionAreMcNemars) {
  PairedSample sample;
  for (std::size_t s = 0; s < 20; ++s) {
    sample.add(s < 8 ? 0 : 1, s == 15 ? 0 : 1, s);
  }
  const SuccessTest test = success_test(sample);
  EXPECT_EQ(test.second_more, 8U);
  EXPECT_EQ(test.first_more, 1U);
  EXPECT_EQ(test.units.count, 20U);
  EXPECT_EQ(test.p, mcnemar(1, 8));
}

TEST(Clustered, SuccessesOfManyRepetitionsCountScenarios) {
  PairedSample sample;  // three scenarios which only the second solves, 20 times each
  for (int r = 0; r < 20; ++r) {
    for (std::size_t s = 0; s < 3; ++s) {
      sample.add(0, 1, s);
    }
    sample.add(r % 2, 1 - r % 2, 3);  // as often as the other
  }
  const SuccessTest test = success_test(sample);
  EXPECT_EQ(test.second_more, 3U);
  EXPECT_EQ(test.first_more, 0U);
  EXPECT_EQ(test.p, 0.25) << "60 pairs would give 1e-18";
  PairedSample one;
  for (int r = 0; r < 20; ++r) {
    one.add(0, 1, 5);
  }
  EXPECT_EQ(success_test(one).p, mcnemar(0, 20));
  EXPECT_FALSE(success_test(one).units.of_scenarios);
}
}  // namespace
}  // namespace altiplan::host::clustered_test
