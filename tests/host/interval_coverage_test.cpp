// SPDX-License-Identifier: Apache-2.0
// How often the 95 % intervals of claims contain what they are about, in simulated studies: each
// kind of interval, with and without repetitions; at night 10,000 studies.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "altiplan/random.hpp"
#include "study/statistics/clustered.hpp"

namespace altiplan::study::interval_coverage_test {
namespace {

/// A simulated study: the values of its pairs and the scenario of each.
struct Sample {
  std::vector<double> values;
  std::vector<std::size_t> groups;
};
using Draw = std::function<double(RandomStream& of_scenario, RandomStream& of_run)>;

/// `of_scenario` draws the same numbers for every repetition.
Sample sample_of(const RandomStream& study, int scenarios, int repetitions, const Draw& draw) {
  Sample sample;
  for (int s = 0; s < scenarios; ++s) {
    for (int r = 0; r < repetitions; ++r) {
      RandomStream of_scenario = study.sub("scenario", std::uint64_t(s));
      RandomStream of_run = of_scenario.sub("run", std::uint64_t(r));
      sample.values.push_back(draw(of_scenario, of_run));
      sample.groups.push_back(std::size_t(s));
    }
  }
  return sample;
}

using Make = std::function<MadeInterval(const Sample&)>;

/// The share of studies whose interval contains the truth.
double simulated_coverage(int studies, const std::string& what, const Draw& draw, int scenarios,
                          int repetitions, double truth, const Make& make) {
  int covered = 0;
  for (int study = 0; study < studies; ++study) {
    const Sample sample =
        sample_of(RandomStream(std::uint64_t(study)).sub(what), scenarios, repetitions, draw);
    const MadeInterval made = make(sample);
    if (!made.interval) {
      ADD_FAILURE() << what << ": " << made.why_none;
      return 0;
    }
    covered += made.interval->low <= truth && truth <= made.interval->high ? 1 : 0;
  }
  return double(covered) / studies;
}

/// It is within 93 to 97 %, give or take three deviations of the simulation. `is_discrete`: few
/// successes or failures allow few intervals, which contain the truth in 92 % or more.
void expect_coverage(int studies, const std::string& what, const Draw& draw, int scenarios,
                     int repetitions, double truth, const Make& make, bool is_discrete = false) {
  const double share = simulated_coverage(studies, what, draw, scenarios, repetitions, truth, make);
  const double chance = 3 * std::sqrt(0.05 * 0.95 / studies);
  EXPECT_GE(share, (is_discrete ? 0.92 : 0.93) - chance) << what;
  EXPECT_LE(share, is_discrete ? 1 : 0.97 + chance) << what;
}

double exponential(RandomStream& stream) { return -std::log(1 - stream.uniform()); }
/// Half of the variance is the scenario's.
double shared_normal(RandomStream& of_scenario, RandomStream& of_run) {
  return (of_scenario.normal() + of_run.normal()) / std::sqrt(2.0);
}
/// Which 1 of a run there is with this chance.
Draw success(double chance) {
  return [chance](RandomStream&, RandomStream& run) { return run.uniform() < chance ? 1.0 : 0.0; };
}
/// A scenario's chance is uniform.
double shared_success(RandomStream& of_scenario, RandomStream& of_run) {
  return of_run.uniform() < of_scenario.uniform() ? 1 : 0;
}

void simulate_shares(int studies) {
  const Make share = [](const Sample& s) { return share_interval(s.values, s.groups, 0.95); };
  expect_coverage(studies, "a half of 30", success(0.5), 30, 1, 0.5, share);
  expect_coverage(studies, "0.8 of 50", success(0.8), 50, 1, 0.8, share);
  expect_coverage(studies, "0.95 of 20", success(0.95), 20, 1, 0.95, share, true);
  expect_coverage(studies, "0.8 of 20 x 5", success(0.8), 20, 5, 0.8, share);
  expect_coverage(studies, "shared, 10 x 5", shared_success, 10, 5, 0.5, share);
  expect_coverage(studies, "shared, 30 x 10", shared_success, 30, 10, 0.5, share);
}

void simulate_differences_of_shares(int studies) {
  const Make difference = [](const Sample& s) {
    return difference_interval(s.values, s.groups, 0.95);
  };
  const auto paired = [](double gain, double loss) {
    return [gain, loss](RandomStream&, RandomStream& run) {
      const double drawn = run.uniform();
      return drawn < gain ? 1.0 : drawn < gain + loss ? -1.0 : 0.0;
    };
  };
  expect_coverage(studies, "0.2 and 0.1 of 50", paired(0.2, 0.1), 50, 1, 0.1, difference);
  expect_coverage(studies, "0.3 and 0.3 of 30", paired(0.3, 0.3), 30, 1, 0, difference);
  expect_coverage(studies, "0.05 and 0.02 of 20", paired(0.05, 0.02), 20, 1, 0.03, difference,
                  true);
  expect_coverage(studies, "0.3 and 0.2 of 20 x 5", paired(0.3, 0.2), 20, 5, 0.1, difference);
  const Draw shared = [](RandomStream& of_scenario, RandomStream& of_run) {
    return shared_success(of_scenario, of_run) - shared_success(of_scenario, of_run);
  };
  expect_coverage(studies, "shared, 20 x 5", shared, 20, 5, 0, difference);
}

void simulate_quantiles(int studies) {
  const auto of = [](double q) {
    return [q](const Sample& s) { return quantile_interval(s.values, s.groups, q, 0.95); };
  };
  const Draw skewed = [](RandomStream&, RandomStream& run) { return exponential(run); };
  for (const int scenarios : {6, 10, 25}) {
    expect_coverage(studies, "median of " + std::to_string(scenarios), skewed, scenarios, 1,
                    std::log(2.0), of(0.5));
  }
  expect_coverage(studies, "p95 of 72", skewed, 72, 1, std::log(20.0), of(0.95));
  expect_coverage(studies, "p95 of 150", skewed, 150, 1, std::log(20.0), of(0.95));
  expect_coverage(studies, "p99 of 400", skewed, 400, 1, std::log(100.0), of(0.99));
  expect_coverage(studies, "p10 of 60", skewed, 60, 1, -std::log(0.9), of(0.1));
  expect_coverage(studies, "median of 10 x 5", shared_normal, 10, 5, 0, of(0.5));
  expect_coverage(studies, "median of 30 x 3", shared_normal, 30, 3, 0, of(0.5));
  expect_coverage(studies, "p90 of 50 x 5", shared_normal, 50, 5, normal_quantile(0.9), of(0.9));
}

void simulate_means(int studies) {
  const Make mean = [](const Sample& s) { return mean_interval(s.values, s.groups, 0.95, 10); };
  const Draw normal = [](RandomStream&, RandomStream& run) { return run.normal(); };
  const Draw skewed = [](RandomStream&, RandomStream& run) { return exponential(run); };
  const Draw even = [](RandomStream&, RandomStream& run) { return run.uniform(); };
  const Draw lognormal = [](RandomStream&, RandomStream& run) { return std::exp(run.normal()); };
  for (const int scenarios : {10, 15, 20, 50}) {
    const std::string of = ", " + std::to_string(scenarios);
    expect_coverage(studies, "normal" + of, normal, scenarios, 1, 0, mean);
    expect_coverage(studies, "uniform" + of, even, scenarios, 1, 0.5, mean);
    expect_coverage(studies, "exponential" + of, skewed, scenarios, 1, 1, mean);
    expect_coverage(studies, "lognormal" + of, lognormal, scenarios, 1, std::exp(0.5), mean);
  }
  expect_coverage(studies, "shared, 10 x 5", shared_normal, 10, 5, 0, mean);
  const Draw both = [](RandomStream& of_scenario, RandomStream& of_run) {
    return exponential(of_scenario) * exponential(of_run);
  };
  expect_coverage(studies, "skewed, shared, 40 x 5", both, 40, 5, 1, mean);
}

/// p-values of means of 10 and 11 scenarios come from intervals of more confidence than these
/// numbers are asked for: even of a long tail they miss the truth as rarely as 15 scenarios' do.
void simulate_p_values_of_few(int studies) {
  const Draw skewed = [](RandomStream&, RandomStream& run) { return exponential(run); };
  const Draw lognormal = [](RandomStream&, RandomStream& run) { return std::exp(run.normal()); };
  const auto expect_rare = [&](double p, const char* what, const Draw& draw, double truth,
                               double limit) {
    for (const int scenarios : {10, 11}) {
      const double missed =
          1 - simulated_coverage(studies, what, draw, scenarios, 1, truth, [&](const Sample& s) {
            return mean_interval(s.values, s.groups, 1 - p, 10);
          });
      EXPECT_LE(missed, limit + 3 * std::sqrt(limit / studies))
          << "p < " << p << " of " << scenarios << ", " << what;
    }
  };
  expect_rare(0.01, "exponential", skewed, 1, 0.01);
  expect_rare(0.001, "exponential", skewed, 1, 0.001);
  expect_rare(0.01, "lognormal", lognormal, std::exp(0.5), 0.02);
  expect_rare(0.001, "lognormal", lognormal, std::exp(0.5), 0.002);
}

/// The chances of 0, 1, … successes of `trials`.
std::vector<double> binomial(int trials, double share) {
  std::vector<double> chances;
  for (int k = 0; k <= trials; ++k) {
    chances.push_back(std::exp(std::lgamma(trials + 1) - std::lgamma(k + 1) -
                               std::lgamma(trials - k + 1) + k * std::log(share) +
                               (trials - k) * std::log1p(-share)));
  }
  return chances;
}

TEST(IntervalCoverage, SharesExactly) {
  // Of all numbers of scenarios from 20 on and shares from 5 to 95 %, without simulation.
  int within = 0;
  int all = 0;
  double least = 1;
  for (int trials = 20; trials <= 400; trials += trials < 60 ? 1 : 5) {
    for (int twentieths = 1; twentieths < 20; ++twentieths) {
      const double share = twentieths / 20.0;
      const std::vector<double> chances = binomial(trials, share);
      double coverage = 0;
      for (int k = 0; k <= trials; ++k) {
        const Interval interval = *wilson(k, trials, 0.95);
        const bool has = interval.low <= share && share <= interval.high;
        coverage += has ? chances[std::size_t(k)] : 0;
      }
      within += coverage >= 0.93 && coverage <= 0.97;
      ++all;
      least = std::min(least, coverage);
    }
  }
  EXPECT_GT(within, 0.95 * all) << "of " << all;
  EXPECT_GT(least, 0.9195);
}

TEST(IntervalCoverage, NoIntervalOf20SuitsAShareOf95PerCent) {
  // An interval contains 0.95 for 18 to 20 successes or for 17 to 20, hardly for fewer: whichever
  // method, its coverage is one of these two.
  const std::vector<double> chances = binomial(20, 0.95);
  const double of_three = chances[18] + chances[19] + chances[20];
  EXPECT_NEAR(of_three, 0.9245, 5e-5);
  EXPECT_NEAR(of_three + chances[17], 0.9841, 5e-5);
  EXPECT_LT(wilson(17, 20, 0.95)->high, 0.95);
  EXPECT_GT(wilson(18, 20, 0.95)->high, 0.95);
}

TEST(IntervalCoverage, Shares) { simulate_shares(1000); }
TEST(IntervalCoverage, DifferencesOfShares) { simulate_differences_of_shares(1000); }
TEST(IntervalCoverage, Quantiles) { simulate_quantiles(1000); }
TEST(IntervalCoverage, Means) { simulate_means(1000); }
TEST(IntervalCoverage, PValuesOfFew) { simulate_p_values_of_few(1000); }

TEST(NightlyIntervalCoverage, Shares) { simulate_shares(10'000); }
TEST(NightlyIntervalCoverage, DifferencesOfShares) { simulate_differences_of_shares(10'000); }
TEST(NightlyIntervalCoverage, Quantiles) { simulate_quantiles(10'000); }
TEST(NightlyIntervalCoverage, Means) { simulate_means(10'000); }
TEST(NightlyIntervalCoverage, PValuesOfFew) { simulate_p_values_of_few(10'000); }
}  // namespace
}  // namespace altiplan::study::interval_coverage_test
