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

/// The share of studies whose interval contains the truth is within 93 to 97 %, give or take three
/// deviations of the simulation. `is_discrete`: few successes or failures allow few intervals,
/// which contain it in 92 % or more.
void expect_coverage(int studies, const std::string& what, const Draw& draw, int scenarios,
                     int repetitions, double truth, const Make& make, bool is_discrete = false) {
  int covered = 0;
  for (int study = 0; study < studies; ++study) {
    const Sample sample =
        sample_of(RandomStream(std::uint64_t(study)).sub(what), scenarios, repetitions, draw);
    const MadeInterval made = make(sample);
    ASSERT_TRUE(made.interval) << what << ": " << made.why_none;
    covered += made.interval->low <= truth && truth <= made.interval->high ? 1 : 0;
  }
  const double share = double(covered) / studies;
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
  const Make mean = [](const Sample& s) { return mean_interval(s.values, s.groups, 0.95); };
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

TEST(IntervalCoverage, Shares) { simulate_shares(1000); }
TEST(IntervalCoverage, DifferencesOfShares) { simulate_differences_of_shares(1000); }
TEST(IntervalCoverage, Quantiles) { simulate_quantiles(1000); }
TEST(IntervalCoverage, Means) { simulate_means(1000); }

TEST(NightlyIntervalCoverage, Shares) { simulate_shares(10'000); }
TEST(NightlyIntervalCoverage, DifferencesOfShares) { simulate_differences_of_shares(10'000); }
TEST(NightlyIntervalCoverage, Quantiles) { simulate_quantiles(10'000); }
TEST(NightlyIntervalCoverage, Means) { simulate_means(10'000); }
}  // namespace
}  // namespace altiplan::study::interval_coverage_test
