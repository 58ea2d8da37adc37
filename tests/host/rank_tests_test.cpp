// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "altiplan/random.hpp"
#include "study/statistics/statistics.hpp"

namespace altiplan::host::rank_tests_test {
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

TEST(McNemar, WorkedExamples) {
  EXPECT_DOUBLE_EQ(mcnemar(0, 5), 2.0 / 32);
  EXPECT_DOUBLE_EQ(mcnemar(1, 5), 2 * 7.0 / 64);
  EXPECT_EQ(mcnemar(0, 0), 1);
  EXPECT_EQ(mcnemar(3, 3), 1);
  EXPECT_TRUE(std::isnan(mcnemar(-1, 2)));
}

TEST(McNemar, IsSymmetricAndFallsWithTheDifference) {
  for (std::int64_t n = 1; n < 200; n += 7) {
    for (std::int64_t first = 0; first <= n; ++first) {
      EXPECT_EQ(mcnemar(first, n - first), mcnemar(n - first, first));
      if (first > 0 && 2 * first <= n) {
        EXPECT_GE(mcnemar(first, n - first), mcnemar(first - 1, n - first + 1));
      }
    }
  }
  EXPECT_EQ(mcnemar(0, 1'000'000), 0);
  EXPECT_GT(mcnemar(500'000, 500'100), 0.9);
}

TEST(Wilcoxon, WorkedExample) {
  // Heights of cross- and self-fertilised corn, Darwin 1876.
  const Sample differences{6, 8, 14, 16, 23, 24, 28, 29, 41, -48, 49, 56, 60, -67, 75};
  const auto test = wilcoxon(differences);
  ASSERT_TRUE(test);
  EXPECT_TRUE(test->exact);
  EXPECT_EQ(test->statistic, 24);
  EXPECT_DOUBLE_EQ(test->p, 0.041259765625);
  EXPECT_DOUBLE_EQ(test->rank_biserial, (96.0 - 24) / 120);
  EXPECT_EQ(test->used, 15U);
}

TEST(Wilcoxon, IsExactOfAtMostFiftyThatAreNotZero) {
  EXPECT_TRUE(wilcoxon(Sample{1, 2, -3})->exact);
  EXPECT_TRUE(wilcoxon(random_sample(1, 50))->exact);
  EXPECT_FALSE(wilcoxon(random_sample(1, 51))->exact);
  Sample with_zeros = random_sample(1, 50);
  with_zeros.insert(with_zeros.begin() + 7, 9, 0.0);
  EXPECT_TRUE(wilcoxon(with_zeros)->exact);
  EXPECT_EQ(wilcoxon(with_zeros)->zeros, 9U);
  EXPECT_EQ(wilcoxon(with_zeros)->used, 50U);
  EXPECT_EQ(wilcoxon(with_zeros)->p, wilcoxon(random_sample(1, 50))->p);
  EXPECT_TRUE(wilcoxon(random_sample(1, 1000), WilcoxonMethod::exact));
  EXPECT_FALSE(wilcoxon(random_sample(1, 1001), WilcoxonMethod::exact));
}

TEST(Wilcoxon, IsExactWithTies) {
  // Ranks 1.5, 1.5, 3, 4: the sum of the negative ones is at most 3 with 5 of the 16 choices of
  // signs: {}, {1.5}, {1.5}, {3} and {1.5, 1.5}.
  const auto tied = wilcoxon(Sample{1, 1, -2, 3});
  EXPECT_TRUE(tied->exact);
  EXPECT_TRUE(tied->ties);
  EXPECT_EQ(tied->statistic, 3);
  EXPECT_DOUBLE_EQ(tied->p, 2 * 5.0 / 16);
}

TEST(Wilcoxon, NeverGivesLessThanAllOnOneSide) {
  // The normal distribution gives 0.042 for five equal differences.
  EXPECT_DOUBLE_EQ(wilcoxon(Sample{1, 1, 1, 1, 1})->p, 2.0 / 32);
  EXPECT_DOUBLE_EQ(wilcoxon(Sample{0, 2, 1, 1, 2, 1, 0})->p, 2.0 / 32);
  EXPECT_LT(wilcoxon(Sample{1, 1, 1, 1, 1}, WilcoxonMethod::approximate)->p, 0.05);
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Sample sample = random_sample(seed, 1 + seed % 20);
    for (double& value : sample) {
      value = std::round(2 * value);
    }
    if (const auto test = wilcoxon(sample)) {
      EXPECT_GE(test->p, std::ldexp(1.0, 1 - int(test->used)) * (1 - 1e-12));
    }
  }
}

TEST(Wilcoxon, ChangesSignWithTheDifferences) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Sample sample = random_sample(seed, 1 + seed % 60);
    for (double& value : sample) {
      value = seed % 2 == 0 ? value : std::round(4 * value);
    }
    Sample other = sample;
    std::transform(other.begin(), other.end(), other.begin(), std::negate<>());
    const auto one = wilcoxon(sample);
    const auto two = wilcoxon(other);
    ASSERT_EQ(one.has_value(), two.has_value());
    if (one) {
      EXPECT_DOUBLE_EQ(one->p, two->p);
      EXPECT_DOUBLE_EQ(one->rank_biserial, -two->rank_biserial);
      EXPECT_LE(one->p, 1);
      EXPECT_GE(one->p, 0);
    }
  }
}

TEST(Wilcoxon, OfNoDifference) {
  EXPECT_FALSE(wilcoxon({}));
  EXPECT_FALSE(wilcoxon(Sample{0, 0, 0}));
  EXPECT_FALSE(wilcoxon(Sample{1, kNone}));
  EXPECT_EQ(wilcoxon(Sample{5})->p, 1);
  EXPECT_EQ(wilcoxon(Sample{5})->rank_biserial, 1);
}

TEST(VarghaDelaney, CountsWins) {
  const Sample x{1, 2, 3, 3};
  const Sample y{2, 3};
  double wins = 0;
  for (const double a : x) {
    for (const double b : y) {
      wins += a > b ? 1 : (a == b ? 0.5 : 0);
    }
  }
  EXPECT_DOUBLE_EQ(*vargha_delaney(x, y), wins / 8);
  EXPECT_DOUBLE_EQ(*cliffs_delta(x, y), 2 * wins / 8 - 1);
  EXPECT_DOUBLE_EQ(*vargha_delaney(y, x), 1 - wins / 8);
  EXPECT_EQ(*vargha_delaney(Sample{kInfinity}, Sample{1}), 1);
  EXPECT_FALSE(vargha_delaney(x, {}));
  EXPECT_FALSE(cliffs_delta(x, Sample{kNone}));
}

TEST(Holm, WorkedExample) {
  const Sample adjusted = holm(Sample{0.01, 0.04, 0.03, 0.005});
  const Sample expected{0.03, 0.06, 0.06, 0.02};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(adjusted[i], expected[i]);
  }
  EXPECT_TRUE(holm({}).empty());
}

TEST(Holm, IsMonotoneAndBetweenTheRawAndBonferronis) {
  RandomStream stream(9);
  for (int study = 0; study < 200; ++study) {
    Sample p(std::size_t(stream.integer(1, 12)));
    std::generate(p.begin(), p.end(), [&] { return std::pow(stream.uniform(), 3); });
    const Sample adjusted = holm(p);
    for (std::size_t i = 0; i < p.size(); ++i) {
      EXPECT_GE(adjusted[i], p[i]);
      EXPECT_LE(adjusted[i], std::min(1.0, double(p.size()) * p[i]));
      for (std::size_t j = 0; j < p.size(); ++j) {
        EXPECT_FALSE(p[i] < p[j] && adjusted[i] > adjusted[j]);
      }
    }
  }
}

TEST(Holm, ATestThatWasNotMadeDoesNotCount) {
  const Sample adjusted = holm(Sample{kNone, 0.01, 0.02});
  EXPECT_TRUE(std::isnan(adjusted[0]));
  EXPECT_DOUBLE_EQ(adjusted[1], 0.02);
  EXPECT_DOUBLE_EQ(adjusted[2], 0.02);
}

TEST(Friedman, ThreeBlocksInOneOrder) {
  const auto test = friedman({{1, 10, 5}, {2, 20, 6}, {3, 30, 7}});
  ASSERT_TRUE(test);
  EXPECT_EQ(test->average_ranks, (Sample{1, 2, 3}));
  EXPECT_DOUBLE_EQ(test->statistic, 6);
  EXPECT_DOUBLE_EQ(test->p, std::exp(-3.0));
}

TEST(Friedman, OfTiesAloneAndOfTooLittle) {
  const auto tied = friedman({{1, 2}, {1, 2}, {1, 2}});
  ASSERT_TRUE(tied);
  EXPECT_TRUE(std::isnan(tied->statistic));
  EXPECT_TRUE(std::isnan(tied->p));
  EXPECT_EQ(tied->average_ranks, (Sample{2, 2, 2}));
  EXPECT_FALSE(friedman({{1, 2}, {1, 2}}));
  EXPECT_FALSE(friedman({{}, {}, {}}));
  EXPECT_FALSE(friedman({{1, 2}, {1, 2}, {1}}));
  EXPECT_FALSE(friedman({{1, 2}, {1, 2}, {1, kNone}}));
}

// Demšar 2006, table 5a: critical values of the Nemenyi test for 2 to 10 classifiers.
TEST(Nemenyi, DemsarsTable) {
  const Sample at_5{1.960, 2.343, 2.569, 2.728, 2.850, 2.949, 3.031, 3.102, 3.164};
  const Sample at_10{1.645, 2.052, 2.291, 2.459, 2.589, 2.693, 2.780, 2.855, 2.920};
  for (int k = 2; k <= 10; ++k) {
    const double unit = std::sqrt(k * (k + 1) / 6.0);
    // Its digits are those of a table of the range, divided by √2.
    EXPECT_NEAR(critical_difference(k, 1, 0.05) / unit, at_5[std::size_t(k - 2)], 0.0011);
    EXPECT_NEAR(critical_difference(k, 1, 0.10) / unit, at_10[std::size_t(k - 2)], 0.0011);
  }
  EXPECT_TRUE(std::isnan(critical_difference(1, 10, 0.05)));
  EXPECT_TRUE(std::isnan(critical_difference(3, 0, 0.05)));
  EXPECT_TRUE(std::isnan(critical_difference(3, 10, 0)));
}

// The same paper's example, 4 classifiers on 14 data sets.
TEST(Nemenyi, DemsarsExample) {
  const Sample average_ranks{3.143, 2.000, 2.893, 1.964};
  const double at_5 = critical_difference(4, 14, 0.05);
  const double at_10 = critical_difference(4, 14, 0.10);
  EXPECT_NEAR(at_5, 1.25, 0.005);
  EXPECT_NEAR(at_10, 1.12, 0.005);
  EXPECT_EQ(joined(average_ranks, at_5), (std::vector<Indices>{{3, 1, 2, 0}}));
  EXPECT_EQ(joined(average_ranks, at_10), (std::vector<Indices>{{3, 1, 2}, {2, 0}}));
}

TEST(Nemenyi, BarsJoinTwoOrMore) {
  EXPECT_TRUE(joined(Sample{1, 2, 3}, 1).empty());  // differ by the critical difference
  EXPECT_EQ(joined(Sample{1, 2, 3}, 1.5), (std::vector<Indices>{{0, 1}, {1, 2}}));
  EXPECT_TRUE(joined({}, 1).empty());
  EXPECT_TRUE(joined(Sample{1, 2}, kNone).empty());
  EXPECT_TRUE(joined(Sample{1, kNone}, 5).empty());
}
}  // namespace
}  // namespace altiplan::host::rank_tests_test
