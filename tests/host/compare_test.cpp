// SPDX-License-Identifier: Apache-2.0
#include "study/compare/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "altiplan/error.hpp"
#include "study/compare/origin.hpp"

namespace altiplan::host::compare_test {
using namespace study;
namespace {

using Verdict = MetricChange::Verdict;

/// Twenty scenarios with one run each of one pipeline; `of` gives a value of each.
StudyData study(double (*of)(int), const std::string& metric = "length_m",
                const std::string& pipeline = "astar") {
  StudyData data;
  data.stores = {"a.db"};
  data.pipelines = {{pipeline, pipeline, "a.yaml", {}}};
  data.columns = {metric};
  data.file.metrics = {{metric, std::nullopt}};
  for (int n = 0; n < 20; ++n) {
    data.scenarios.push_back({"city" + std::to_string(n), "city", "c.yaml", {}});
    RunRow row;
    row.id = n + 1;
    row.scenario = std::size_t(n);
    row.seed = n;
    row.outcome = "solved";
    row.values = {of(n)};
    data.rows.push_back(row);
  }
  return data;
}

Verdict verdict(const StudyData& first, const StudyData& second, double tolerance = 0.05) {
  return compare_studies(first, second, {{}, tolerance}).metrics.at(0).verdict;
}

double hundred(int n) { return 100 + n; }

TEST(Compare, finds_nothing_between_a_study_and_itself) {
  const Comparison same = compare_studies(study(hundred), study(hundred), {});
  EXPECT_EQ(same.pairs, 20);
  EXPECT_TRUE(same.differing.empty());
  EXPECT_EQ(same.metrics.at(0).verdict, Verdict::same);
  EXPECT_EQ(same.metrics.at(0).effect.median, 1);
  EXPECT_FALSE(same.is_worse());
}

TEST(Compare, calls_worse_what_is_beyond_the_tolerance_with_all_its_interval) {
  const StudyData before = study(hundred);
  const StudyData longer = study([](int n) { return 1.1 * hundred(n); });
  EXPECT_EQ(verdict(before, longer), Verdict::worse);
  EXPECT_TRUE(compare_studies(before, longer, {}).is_worse());
  EXPECT_EQ(verdict(longer, before), Verdict::better);
  EXPECT_EQ(verdict(before, longer, 0.2), Verdict::within);
  const StudyData mixed = study([](int n) { return (n % 2 == 0 ? 1.2 : 0.9) * hundred(n); });
  EXPECT_EQ(verdict(before, mixed), Verdict::unclear);
  EXPECT_FALSE(compare_studies(before, mixed, {}).is_worse());
}

TEST(Compare, knows_which_way_is_better) {
  const StudyData before = study(hundred, "min_clearance_m");
  const StudyData nearer = study([](int n) { return 0.8 * hundred(n); }, "min_clearance_m");
  EXPECT_EQ(verdict(before, nearer), Verdict::worse);
  StudyData told = before;
  told.file.metrics[0].better = "lower";
  EXPECT_EQ(verdict(told, nearer), Verdict::better);
}

TEST(Compare, asks_times_to_differ_significantly_too) {
  // Fifteen are a fifth slower, five much faster: by the median alone it would be worse.
  const auto slower = [](int n) { return (n < 15 ? 1.2 : 0.01) * hundred(n); };
  EXPECT_EQ(verdict(study(hundred), study(slower)), Verdict::worse);
  EXPECT_EQ(verdict(study(hundred, "plan_time_s"), study(slower, "plan_time_s")), Verdict::unclear);
  const auto all_slower = [](int n) { return 1.2 * hundred(n); };
  EXPECT_EQ(verdict(study(hundred, "plan_time_s"), study(all_slower, "plan_time_s")),
            Verdict::worse);
}

TEST(Compare, lists_values_that_differ_but_not_times) {
  const auto one_off = [](int n) { return n == 3 ? std::nextafter(103.0, 200.0) : hundred(n); };
  const Comparison lengths = compare_studies(study(hundred), study(one_off), {});
  ASSERT_EQ(lengths.differing.size(), 1);
  EXPECT_EQ(lengths.differing[0].run, "astar city3 #0");
  EXPECT_EQ(lengths.differing[0].before, 103);
  EXPECT_FALSE(lengths.is_worse());
  EXPECT_TRUE(compare_studies(study(hundred, "plan_time_s"), study(one_off, "plan_time_s"), {})
                  .differing.empty());
}

TEST(Compare, takes_differences_where_a_value_may_be_zero) {
  const StudyData none = study([](int) { return 0.0; }, "flight.collisions");
  const StudyData one = study([](int) { return 1.0; }, "flight.collisions");
  const Comparison comparison = compare_studies(none, one, {});
  EXPECT_FALSE(comparison.metrics.at(0).is_ratio);
  EXPECT_EQ(comparison.metrics.at(0).effect.median, 1);
  EXPECT_EQ(comparison.metrics.at(0).verdict, Verdict::worse);
}

/// The study with a second pipeline, whose values are those of `of`.
StudyData with_jps(StudyData data, double (*of)(int)) {
  data.pipelines.push_back({"jps", "jps", "j.yaml", {}});
  for (int n = 0; n < 20; ++n) {
    data.rows.push_back(data.rows[std::size_t(n)]);
    data.rows.back().pipeline = 1;
    data.rows.back().id += 20;
    data.rows.back().values = {of(n)};
  }
  return data;
}

TEST(Compare, takes_ratios_or_differences_of_all_pipelines_alike) {
  const auto zero_once = [](int n) { return n == 3 ? 0.0 : hundred(n); };
  const StudyData before = with_jps(study(hundred), zero_once);
  const Comparison mixed = compare_studies(before, before, {});
  EXPECT_FALSE(mixed.metrics.at(0).is_ratio);
  EXPECT_FALSE(mixed.metrics.at(1).is_ratio);
  const Comparison in_second =
      compare_studies(with_jps(study(hundred), hundred), with_jps(study(hundred), zero_once), {});
  EXPECT_FALSE(in_second.metrics.at(0).is_ratio);
  const StudyData positive = with_jps(study(hundred), hundred);
  EXPECT_TRUE(compare_studies(positive, positive, {}).metrics.at(1).is_ratio);
}

/// The first scenarios of a study, each with so many repetitions.
StudyData repeated(StudyData data, std::size_t scenarios, int repetitions) {
  data.scenarios.resize(scenarios);
  data.rows.resize(scenarios);
  for (int r = 1; r < repetitions; ++r) {
    for (std::size_t s = 0; s < scenarios; ++s) {
      data.rows.push_back(data.rows[s]);
      data.rows.back().repetition = r;
    }
  }
  return data;
}

TEST(Compare, takes_no_repetition_for_evidence) {
  const auto slower = [](int n) { return 1.2 * hundred(n); };
  const std::string time = "plan_time_s";
  const auto few = compare_studies(repeated(study(hundred, time), 5, 20),
                                   repeated(study(slower, time), 5, 20), {});
  EXPECT_EQ(few.metrics.at(0).pairs, 100);
  EXPECT_EQ(few.metrics.at(0).effect.units.words(), "5 scenarios");
  EXPECT_DOUBLE_EQ(few.metrics.at(0).p, 2.0 / 32);
  EXPECT_FALSE(few.metrics.at(0).effect.interval);
  EXPECT_EQ(few.metrics.at(0).verdict, Verdict::unclear);
  EXPECT_EQ(few.metrics.at(0).why_no_interval, "too few scenarios: at least 6 for 95 %");
  const auto more = compare_studies(repeated(study(hundred, time), 6, 20),
                                    repeated(study(slower, time), 6, 20), {});
  EXPECT_DOUBLE_EQ(more.metrics.at(0).p, 2.0 / 64);
  EXPECT_EQ(more.metrics.at(0).verdict, Verdict::worse);
  EXPECT_EQ(compare_studies(repeated(study(hundred), 2, 3), repeated(study(hundred), 2, 3), {})
                .metrics.at(0)
                .verdict,
            Verdict::same);
}

TEST(Compare, is_not_the_same_where_only_a_repetition_differs) {
  const StudyData before = repeated(study(hundred), 8, 3);
  StudyData after = before;
  after.rows.back().values = {150};  // the scenario's median stays
  EXPECT_EQ(verdict(before, after), Verdict::within);
}

TEST(Compare, sorts_outcomes_into_lost_won_and_others) {
  StudyData before = study(hundred);
  StudyData after = study(hundred);
  after.rows[4].outcome = "crashed";
  after.rows[4].message = "astar: segmentation fault";
  before.rows[5].outcome = "no_route";
  before.rows[6].outcome = "no_route";
  after.rows[6].outcome = "timed_out";
  const Comparison comparison = compare_studies(before, after, {});
  ASSERT_EQ(comparison.lost.size(), 1);
  EXPECT_EQ(comparison.lost[0].run, "astar city4 #0");
  EXPECT_EQ(comparison.lost[0].message, "astar: segmentation fault");
  ASSERT_EQ(comparison.won.size(), 1);
  EXPECT_EQ(comparison.won[0].run, "astar city5 #0");
  ASSERT_EQ(comparison.others.size(), 1);
  EXPECT_EQ(comparison.metrics.at(0).pairs, 17) << "metrics are of pairs that both solved";
  EXPECT_TRUE(comparison.is_worse());
  EXPECT_FALSE(compare_studies(after, after, {}).is_worse());
}

TEST(Compare, pairs_by_name_and_seed) {
  const StudyData before = study(hundred);
  StudyData after = study(hundred);
  after.rows[0].seed = 99;
  after.rows.pop_back();
  const Comparison comparison = compare_studies(before, after, {});
  EXPECT_EQ(comparison.pairs, 18);
  EXPECT_EQ(comparison.other_seeds, 1);
  EXPECT_EQ(comparison.only_first, 1);
  EXPECT_EQ(comparison.only_second, 0);
  EXPECT_FALSE(comparison.is_whole());
  EXPECT_TRUE(compare_studies(after, before, {}).only_second == 1);
  after = before;
  after.rows[0].seed = 99;
  EXPECT_FALSE(compare_studies(before, after, {}).is_whole());
  after = before;
  after.rows.pop_back();
  EXPECT_TRUE(compare_studies(after, before, {}).is_whole()) << "more runs do no harm";
  EXPECT_THROW(compare_studies(before, study(hundred, "length_m", "jps"), {}), Error);
}

TEST(Compare, adjusts_p_over_pipelines) {
  const auto two = [](double (*of)(int)) { return with_jps(study(of), of); };
  const auto longer = [](int n) { return 1.1 * hundred(n); };
  const double alone = compare_studies(study(hundred), study(longer), {}).metrics.at(0).p;
  EXPECT_LT(alone, 1e-3);
  const Comparison both = compare_studies(two(hundred), two(longer), {});
  EXPECT_DOUBLE_EQ(both.metrics.at(0).p, 2 * alone);
}

Json result(const std::string& path, const std::string& content, const std::string& build) {
  return {
      {"version", "1.0"},
      {"files", {{{"path", path}, {"sha256", content}}, {{"path", "/f/map.tif"}, {"sha256", "m"}}}},
      {"plugins", {{{"kind", "planner"}, {"name", "astar"}, {"build", build}}}}};
}

TEST(Compare, says_which_files_and_builds_are_others) {
  const Json then = result("/f/city.yaml", "a", "1");
  EXPECT_TRUE(changed_origins(then, then).empty());
  EXPECT_TRUE(changed_origins(then, result("/moved/city.yaml", "a", "1")).empty());
  EXPECT_EQ(changed_origins(then, result("/moved/city.yaml", "b", "2")),
            (std::vector<std::string>{"'/moved/city.yaml' has changed since",
                                      "planner 'astar' has been rebuilt since"}));
  EXPECT_EQ(changed_origins(then, result("/f/town.yaml", "a", "1")),
            (std::vector<std::string>{"'/f/city.yaml' is no longer used",
                                      "'/f/town.yaml' is newly used"}));
}

TEST(Compare, looks_for_other_origins_where_keys_differ) {
  const auto no_result = [](const RunRow&) { return std::string(); };
  StudyData before = study(hundred);
  StudyData after = before;
  EXPECT_TRUE(compare_studies(before, after, {}).other_origins.empty());
  after.rows[3].key = after.rows[4].key = "other";
  after.pipelines[0].set = {"steps.0.with.weight_g=0.5"};
  after.file.budget.wall_s = 5;
  const Comparison comparison = compare_studies(before, after, {});
  EXPECT_EQ(comparison.other_origins.size(), 2);
  EXPECT_EQ(
      changed_origins(comparison, before, after, no_result, no_result),
      (std::vector<std::string>{"pipeline 'astar' sets different keys", "the budget differs"}));
  int read = 0;
  const auto of_first = [&](const RunRow&) {
    ++read;
    return result("/f/city.yaml", "a", "1").dump();
  };
  const auto of_second = [](const RunRow&) { return result("/f/city.yaml", "b", "1").dump(); };
  EXPECT_EQ(changed_origins(comparison, before, before, of_first, of_second),
            (std::vector<std::string>{"'/f/city.yaml' has changed since"}));
  EXPECT_EQ(read, 1) << "once for each pipeline and scenario file";
}

TEST(Compare, refuses_a_metric_that_no_run_has) {
  try {
    compare_studies(study(hundred), study(hundred), {{"lenght_m"}, 0.05});
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "--metric: no run has a value named 'lenght_m'; did you mean 'length_m'?");
  }
}
}  // namespace
}  // namespace altiplan::host::compare_test
