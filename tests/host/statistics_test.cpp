// SPDX-License-Identifier: Apache-2.0
#include "study/statistics/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "altiplan/random.hpp"

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
  EXPECT_TRUE(std::isnan(student_quantile(1, 3)));
  EXPECT_TRUE(std::isnan(student_quantile(0.5, 0)));
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
      const auto interval = wilson(double(successes), double(trials), 0.95);
      ASSERT_TRUE(interval);
      EXPECT_LE(0, interval->low);
      EXPECT_LE(interval->low, share);
      EXPECT_LE(share, interval->high);
      EXPECT_LE(interval->high, 1);
      EXPECT_LT(interval->low, interval->high);
      const auto other = wilson(double(trials - successes), double(trials), 0.95);
      EXPECT_NEAR(other->low, 1 - interval->high, 1e-15);
      const auto more = wilson(double(10 * successes), double(10 * trials), 0.95);
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

TEST(Intervals, TangoHasAWidthWithoutAnyDifference) {
  const auto none = tango(0, 0, 20, 0.95);
  ASSERT_TRUE(none);
  // The difference at which no discordant pair among 20 is as likely as its score allows.
  EXPECT_NEAR(none->high, 0.161125, 1e-6);
  EXPECT_NEAR(none->low, -none->high, 1e-12);
  const auto gained = tango(9, 2, 40, 0.95);
  const auto lost = tango(2, 9, 40, 0.95);
  EXPECT_LT(gained->low, 7.0 / 40);
  EXPECT_GT(gained->high, 7.0 / 40);
  EXPECT_NEAR(gained->low, -lost->high, 1e-12);
  EXPECT_NEAR(gained->high, -lost->low, 1e-12);
  EXPECT_EQ(tango(20, 0, 20, 0.95)->high, 1);
  EXPECT_GT(tango(20, 0, 20, 0.95)->low, 0.5);
  EXPECT_FALSE(tango(3, 3, 5, 0.95));
  EXPECT_FALSE(tango(0, 0, 0, 0.95));
  EXPECT_FALSE(tango(-1, 0, 5, 0.95));
  EXPECT_FALSE(tango(1, 0, 5, 1));
}

TEST(Intervals, QuantilesNeedAsManyUnitsAsReachBeyondThem) {
  EXPECT_EQ(fewest_units(0.5), 2U);
  EXPECT_EQ(fewest_units(0.9), 5U);
  EXPECT_EQ(fewest_units(0.95), 6U);
  EXPECT_EQ(fewest_units(0.99), 8U);
  EXPECT_EQ(fewest_units(1), 0U);
  EXPECT_EQ(fewest_units(0.95, 0.9), 36U);
  EXPECT_EQ(fewest_units(0.95, 0.95), 72U) << "0.95^71 is 0.0262";
  EXPECT_EQ(fewest_units(0.95, 0.05), 72U);
  EXPECT_EQ(fewest_units(0.95, 0.99), 368U);
  EXPECT_EQ(fewest_units(0.999, 0.95), 149U);
  EXPECT_EQ(fewest_units(0.95, 0), 0U);
  for (const double q : {0.1, 0.5, 0.95}) {
    const std::size_t fewest = fewest_units(0.95, q);
    EXPECT_TRUE(quantile_interval(random_sample(3, fewest), q, double(fewest), 0.95));
    EXPECT_FALSE(quantile_interval(random_sample(3, fewest - 1), q, double(fewest - 1), 0.95));
    EXPECT_FALSE(quantile_interval(random_sample(3, 50 * fewest), q, double(fewest - 1), 0.95))
        << "repetitions are no scenarios";
  }
}

TEST(Intervals, QuantilesLieBetweenOrderStatistics) {
  Sample sample(72);
  std::iota(sample.begin(), sample.end(), 1.0);
  std::reverse(sample.begin(), sample.end());
  const auto far = quantile_interval(sample, 0.95, 72, 0.95);
  ASSERT_TRUE(far);
  EXPECT_NEAR(far->low, 64.9159, 1e-4);  // the rank itself, as the values are the ranks
  EXPECT_NEAR(far->high, 71.9980, 1e-4);
  // Each value three times, worth as much as once: the same ends.
  Sample thrice;
  for (const double value : sample) {
    thrice.insert(thrice.end(), 3, value);
  }
  const auto repeated = quantile_interval(thrice, 0.95, 72, 0.95);
  EXPECT_NEAR(repeated->low, far->low, 1);
  EXPECT_EQ(repeated->high, 72);
  const Sample equal(6, 3.5);
  EXPECT_EQ(quantile_interval(equal, 0.5, 6, 0.95)->low, 3.5);
  EXPECT_EQ(quantile_interval(equal, 0.5, 6, 0.95)->high, 3.5);
  EXPECT_FALSE(quantile_interval({}, 0.5, 6, 0.95));
  EXPECT_FALSE(quantile_interval(Sample{1, 2, 3, 4, 5, kNone}, 0.5, 6, 0.95));
  EXPECT_EQ(quantile_interval(Sample{1, 2, 3, 4, 5, kInfinity}, 0.5, 6, 0.95)->high, kInfinity);
}

TEST(Intervals, MeansLeanWhereTheTailIs) {
  const Sample even{-3, -2, -2, -1, -1, 1, 1, 2, 2, 3};
  const auto symmetric = mean_interval(10, even, 0.95);
  ASSERT_TRUE(symmetric);
  EXPECT_NEAR(symmetric->low + symmetric->high, 20, 1e-12);
  const double half = 2.2621572 * std::sqrt(38.0 / 9 / 10);
  EXPECT_NEAR(symmetric->high - 10, half, 1e-6) << "Student's t";
  const Sample slight{-3, -2, -2, -1, -1, 1, 1, 2, 2, 3.2};
  EXPECT_NEAR(mean_interval(10, slight, 0.95)->high - 10, half, 0.1) << "as chance may have it";
  const auto skewed = mean_interval(10, Sample{-1, -1, -1, -1, -1, -1, -1, -1, -1, 9}, 0.95);
  EXPECT_NEAR(10 - skewed->low, 2.2621572, 1e-6) << "Student's t, whose error is 1 here";
  EXPECT_GT(skewed->high - 10, 2 * (10 - skewed->low));
  EXPECT_FALSE(mean_interval(10, Sample(10, 0.0), 0.95)) << "others may be rare";
  EXPECT_FALSE(mean_interval(10, std::span(even).first(3), 0.95)) << "too few";
  EXPECT_NEAR(mean_interval(10, even, 0.96)->high - 10, 2.3984 * std::sqrt(38.0 / 9 / 10), 1e-4);
  EXPECT_NEAR(mean_interval(10, even, 0.99)->high - 10, 5.8409 * std::sqrt(38.0 / 9 / 10), 1e-4)
      << "Student's t of 3 degrees: 12 units would do for 9";
  EXPECT_FALSE(mean_interval(10, even, 1));
  EXPECT_FALSE(mean_interval(kInfinity, even, 0.95));
}
}  // namespace
}  // namespace altiplan::host::statistics_test
