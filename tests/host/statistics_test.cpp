// SPDX-License-Identifier: Apache-2.0
#include "study/statistics/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

namespace altiplan::host::statistics_test {
using namespace study;
namespace {
using Sample = std::vector<double>;
using Indices = std::vector<std::size_t>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Sample random_sample(std::uint64_t seed, std::size_t n) {
  RandomStream stream(seed);
  Sample sample(n);
  std::generate(sample.begin(), sample.end(), [&] { return stream.normal(); });
  return sample;
}

double mean_of(std::span<double> sample) { return mean(sample); }

TEST(Distributions, QuantilesInvertTails) {
  for (double p = 0.0005; p < 1; p += 0.001) {
    EXPECT_NEAR(normal_tail(-normal_quantile(p)), p, 1e-15);
  }
  EXPECT_EQ(normal_quantile(0), -kInfinity);
  EXPECT_EQ(normal_quantile(1), kInfinity);
  for (const int k : {2, 3, 10, 100}) {
    for (const double p : {0.01, 0.5, 0.95, 0.9999}) {
      EXPECT_NEAR(studentized_range(studentized_range_quantile(p, k), k), p, 1e-13);
    }
  }
}

TEST(Distributions, OutsideOfTheirRangeAreNaN) {
  EXPECT_TRUE(std::isnan(normal_quantile(-0.1)));
  EXPECT_TRUE(std::isnan(normal_quantile(1.1)));
  EXPECT_TRUE(std::isnan(normal_quantile(kNone)));
  EXPECT_TRUE(std::isnan(chi_squared_tail(1, 0)));
  EXPECT_TRUE(std::isnan(chi_squared_tail(kNone, 3)));
  EXPECT_EQ(chi_squared_tail(-1, 3), 1);
  EXPECT_EQ(chi_squared_tail(kInfinity, 3), 0);
  EXPECT_EQ(chi_squared_tail(1e6, 4), 0);
  EXPECT_TRUE(std::isnan(studentized_range_quantile(0, 3)));
  EXPECT_TRUE(std::isnan(studentized_range_quantile(0.95, 1)));
  EXPECT_EQ(studentized_range(0, 3), 0);
  EXPECT_EQ(studentized_range(kInfinity, 3), 1);
  // The smallest and the largest that a call may be given: Boost.Math is not to throw.
  EXPECT_LT(normal_quantile(5e-324), -38);
  EXPECT_GT(normal_quantile(1 - 1e-16), 8);
  EXPECT_EQ(chi_squared_tail(kInfinity, 1), 0);
  EXPECT_NEAR(chi_squared_tail(5e-324, 1), 1, 1e-15);
  EXPECT_NEAR(chi_squared_tail(1e9, 1'000'000'000), 0.5, 1e-4);
  EXPECT_GT(studentized_range_quantile(1 - 1e-16, 3), 10);
  EXPECT_EQ(mcnemar(0, 0), 1);
  EXPECT_TRUE(std::isnan(mcnemar(-1, 2)));
  EXPECT_EQ(mcnemar(0, 1'000'000'000), 0);
  EXPECT_EQ(mcnemar(1'000'000'000, 1'000'000'000), 1);
}

TEST(Summaries, OfNothingAndOfNaN) {
  EXPECT_TRUE(std::isnan(mean({})));
  EXPECT_TRUE(std::isnan(median({})));
  EXPECT_TRUE(std::isnan(median(Sample{1, kNone, 3})));
  EXPECT_TRUE(std::isnan(mean(Sample{1, kNone, 3})));
  EXPECT_TRUE(std::isnan(quantile(Sample{1, 2}, 1.5)));
  EXPECT_EQ(median(Sample{7}), 7);
  EXPECT_EQ(median(Sample{1, 2, kInfinity, kInfinity}), kInfinity);
  EXPECT_EQ(median(Sample{kInfinity, 1, 2}), 2);
  EXPECT_EQ(median(Sample{1, kInfinity}), kInfinity);
  EXPECT_EQ(median(Sample{-kInfinity, 1}), -kInfinity);
}

TEST(Summaries, BoxPlot) {
  const Sample sample{10, 1, 2, 3, 4, 5, 6, 7, 8, 100, -50};
  const auto box = box_plot(sample);
  ASSERT_TRUE(box);
  EXPECT_EQ(box->median, 5);
  EXPECT_EQ(box->q1, 2.5);
  EXPECT_EQ(box->q3, 7.5);
  EXPECT_EQ(box->low_whisker, 1);
  EXPECT_EQ(box->high_whisker, 10);
  EXPECT_EQ(box->outliers, (Indices{9, 10}));
  const auto equal = box_plot(Sample{3, 3, 3});
  EXPECT_EQ(equal->low_whisker, 3);
  EXPECT_EQ(equal->high_whisker, 3);
  EXPECT_TRUE(equal->outliers.empty());
  EXPECT_FALSE(box_plot({}));
  EXPECT_FALSE(box_plot(Sample{1, kNone}));
  EXPECT_FALSE(box_plot(Sample{1, kInfinity}));
}

TEST(Summaries, NoWhiskerEndsInsideTheBox) {
  // The upper quartile, 3.75, lies between 0 and the outlier.
  const auto box = box_plot(Sample{0, 0, 0, 15});
  EXPECT_EQ(box->q3, 3.75);
  EXPECT_EQ(box->high_whisker, 3.75);
  EXPECT_EQ(box->outliers, (Indices{3}));
}

TEST(Curves, ARunThatDidNotSolveNeverCounts) {
  const auto curve = solved_by(Sample{3, kNone, 1, 1, kNone});
  EXPECT_EQ(curve, (std::vector<CurvePoint>{{1, 0.4}, {3, 0.6}}));
  EXPECT_TRUE(solved_by(Sample{kNone}).empty());
  EXPECT_TRUE(solved_by({}).empty());
}

TEST(Curves, PerformanceProfile) {
  // Problems: a is best, b is best (a twice as dear), only a solves, nobody solves.
  const auto curves = performance_profile({{1, 4, 5, kNone}, {3, 2, kNone, kNone}});
  ASSERT_TRUE(curves);
  EXPECT_EQ((*curves)[0], (std::vector<CurvePoint>{{1, 0.5}, {2, 0.75}}));
  EXPECT_EQ((*curves)[1], (std::vector<CurvePoint>{{1, 0.25}, {3, 0.5}}));
}

TEST(Curves, PerformanceProfileOfZeroCosts) {
  const auto curves = performance_profile({{0, 0}, {0, 5}});
  EXPECT_EQ((*curves)[0], (std::vector<CurvePoint>{{1, 1}}));
  EXPECT_EQ((*curves)[1], (std::vector<CurvePoint>{{1, 0.5}}));  // 5 / 0 is never reached
  EXPECT_FALSE(performance_profile({{1, 2}, {1}}));
  EXPECT_FALSE(performance_profile({{1, -2}}));
  EXPECT_FALSE(performance_profile({{1, kInfinity}}));
  EXPECT_TRUE(performance_profile({})->empty());
}

TEST(Intervals, WilsonContainsTheShareAndNarrows) {
  for (std::int64_t trials = 1; trials < 60; ++trials) {
    for (std::int64_t successes = 0; successes <= trials; ++successes) {
      const double share = double(successes) / double(trials);
      const auto interval = wilson(successes, trials, 0.95);
      ASSERT_TRUE(interval);
      EXPECT_LE(0, interval->low);
      EXPECT_LE(interval->low, share);
      EXPECT_LE(share, interval->high);
      EXPECT_LE(interval->high, 1);
      EXPECT_LT(interval->low, interval->high);
      const auto other = wilson(trials - successes, trials, 0.95);
      EXPECT_NEAR(other->low, 1 - interval->high, 1e-15);
      const auto more = wilson(10 * successes, 10 * trials, 0.95);
      EXPECT_LT(more->high - more->low, interval->high - interval->low);
    }
  }
}

TEST(Intervals, WilsonOfNothing) {
  EXPECT_FALSE(wilson(0, 0, 0.95));
  EXPECT_FALSE(wilson(3, 2, 0.95));
  EXPECT_FALSE(wilson(-1, 2, 0.95));
  EXPECT_FALSE(wilson(1, 2, 1));
  EXPECT_FALSE(wilson(1, 2, kNone));
}

TEST(Bootstrap, OnGivenIndices) {
  const Sample sample{1, 2, 6};
  // Means 1, 2, 3, 4, 5: the 80% interval is from quantile 0.1 to 0.9.
  const std::vector<Indices> resamples{
      {0, 0, 0}, {1, 1, 1}, {0, 1, 2}, {2, 2, 0, 0, 2, 1, 1}, {2, 2, 2, 1}};
  Sample means;
  for (const Indices& indices : resamples) {
    double sum = 0;
    for (const std::size_t index : indices) {
      sum += sample[index];
    }
    means.push_back(sum / double(indices.size()));
  }
  const auto interval = bootstrap_interval(sample, mean_of, resamples, 0.8);
  ASSERT_TRUE(interval);
  EXPECT_DOUBLE_EQ(interval->low, quantile(means, 0.1));
  EXPECT_DOUBLE_EQ(interval->high, quantile(means, 0.9));
  EXPECT_DOUBLE_EQ(interval->low, 1.4);
}

TEST(Bootstrap, RefusesWhatGivesNoInterval) {
  const Sample sample{1, 2};
  EXPECT_FALSE(bootstrap_interval(sample, mean_of, std::vector<Indices>{}, 0.9));
  EXPECT_FALSE(bootstrap_interval(sample, mean_of, std::vector<Indices>{{}}, 0.9));
  EXPECT_FALSE(bootstrap_interval(sample, mean_of, std::vector<Indices>{{0, 2}}, 0.9));
  EXPECT_FALSE(bootstrap_interval({}, mean_of, std::vector<Indices>{{0}}, 0.9));
  EXPECT_FALSE(bootstrap_interval(sample, mean_of, std::vector<Indices>{{0, 1}}, 1));
  const RandomStream stream(1);
  EXPECT_FALSE(bootstrap_interval(Sample{1}, Indices{0}, mean_of, stream, 0.9));
  EXPECT_FALSE(bootstrap_interval(sample, Indices{0}, mean_of, stream, 0.9));
  const Indices each{0, 1, 2, 3, 4, 5};
  EXPECT_TRUE(bootstrap_interval(Sample{1, 2, 3, 4, 5, 6}, each, mean_of, stream, 0.9));
  EXPECT_FALSE(bootstrap_interval(Sample{1, 2, 3, 4, 5, kNone}, each, mean_of, stream, 0.9));
  EXPECT_FALSE(bootstrap_interval(Sample{1, 2, 3, 4, 5, 6}, each, mean_of, stream, 1));
}

TEST(Bootstrap, NeedsAsManyUnitsAsCarryIt) {
  EXPECT_EQ(fewest_units(0.5), 2U);
  EXPECT_EQ(fewest_units(0.9), 5U);
  EXPECT_EQ(fewest_units(0.95), 6U);
  EXPECT_EQ(fewest_units(0.99), 8U);
  EXPECT_EQ(fewest_units(1), 0U);
  EXPECT_EQ(fewest_units(0.95, 0.95), 59U) << "0.95^58 is 0.051";
  EXPECT_EQ(fewest_units(0.95, 0.05), 59U);
  EXPECT_EQ(fewest_units(0.999, 0.95), 135U);
  const RandomStream stream(1);
  const auto of_units = [&](std::size_t units, std::size_t repetitions, double confidence) {
    Sample sample;
    Indices groups;
    for (std::size_t at = 0; at < units * repetitions; ++at) {
      sample.push_back(double(at));
      groups.push_back(at % units);
    }
    EXPECT_EQ(resampled_units(groups), units);
    return bootstrap_interval(sample, groups, mean_of, stream, confidence);
  };
  for (const double confidence : {0.8, 0.95, 0.99}) {
    const std::size_t fewest = fewest_units(confidence);
    EXPECT_TRUE(of_units(fewest, 1, confidence));
    EXPECT_TRUE(of_units(fewest, 3, confidence));
    EXPECT_FALSE(of_units(fewest - 1, 1, confidence));
    EXPECT_FALSE(of_units(fewest - 1, 50, confidence)) << "repetitions are no scenarios";
  }
  EXPECT_EQ(resampled_units(Indices{4, 4, 4}), 3U) << "of one scenario, repetitions are drawn";
}

TEST(Bootstrap, DrawsWholeGroups) {
  const Indices groups{7, 7, 3, 7, 3, 5};
  const RandomStream stream(4);
  std::array<int, 6> drawn{};
  for (std::size_t number = 0; number < 3000; ++number) {
    const Indices indices = resample(groups, stream, number);
    std::array<int, 6> count{};
    for (const std::size_t index : indices) {
      ++count[index];
      ++drawn[index];
    }
    ASSERT_EQ(count[0], count[1]);
    ASSERT_EQ(count[0], count[3]);
    ASSERT_EQ(count[2], count[4]);
    ASSERT_EQ(count[0] + count[2] + count[5], 3);
  }
  for (const int times : drawn) {
    EXPECT_NEAR(times, 3000, 200);  // each once per resample on average; 4.5 deviations
  }
}

TEST(Bootstrap, TwoGroupsAreDrawnAsSuch) {
  std::set<std::size_t> lengths;
  for (std::size_t number = 0; number < 50; ++number) {
    lengths.insert(resample(Indices{0, 0, 0, 1}, RandomStream(4), number).size());
  }
  EXPECT_EQ(lengths, (std::set<std::size_t>{2, 4, 6}));
}

TEST(Bootstrap, OneGroupIsDrawnByValue) {
  const Indices indices = resample(Indices{2, 2, 2, 2, 2, 2, 2, 2}, RandomStream(4), 0);
  EXPECT_EQ(indices.size(), 8U);
  EXPECT_LT(std::set<std::size_t>(indices.begin(), indices.end()).size(), 8U);
  EXPECT_TRUE(resample({}, RandomStream(4), 0).empty());
}

TEST(Bootstrap, IsReproducibleAndOfItsStream) {
  const Indices groups{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  // A change of these changes every stored report.
  EXPECT_EQ(resample(groups, RandomStream(1), 0), (Indices{8, 5, 6, 1, 3, 6, 9, 8, 4, 7}));
  EXPECT_NE(resample(groups, RandomStream(1), 0), resample(groups, RandomStream(1), 1));
  EXPECT_NE(resample(groups, RandomStream(1), 0), resample(groups, RandomStream(2), 0));
  const Sample sample = random_sample(3, 10);
  const auto once = bootstrap_interval(sample, groups, mean_of, RandomStream(1), 0.95);
  const auto again = bootstrap_interval(sample, groups, mean_of, RandomStream(1), 0.95);
  EXPECT_EQ(once->low, again->low);
  EXPECT_EQ(once->high, again->high);
}

TEST(Bootstrap, CoversAsOftenAsItSays) {
  int covered = 0;
  for (std::uint64_t study = 0; study < 100; ++study) {
    const Sample sample = random_sample(study, 40);
    Indices groups(sample.size());
    std::iota(groups.begin(), groups.end(), std::size_t{0});
    const auto interval = bootstrap_interval(sample, groups, mean_of, RandomStream(study), 0.9);
    covered += interval->low <= 0 && 0 <= interval->high ? 1 : 0;
  }
  EXPECT_NEAR(covered, 90, 9);  // 3 deviations
}
}  // namespace
}  // namespace altiplan::host::statistics_test
