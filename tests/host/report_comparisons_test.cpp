// SPDX-License-Identifier: Apache-2.0
// What a report compares, and how sure it is of it.
#include <gtest/gtest.h>

#include <string>

#include "report_study.hpp"

namespace altiplan::study::report::report_comparisons_test {
namespace {

TEST(ReportComparisons, ComparesOnThePairsThatBothSolved) {
  StudyData data = study(2, 10);
  data.rows[0].outcome = "timed_out";  // p0 s0
  data.rows[3].values[1] = kNaN;       // p1 s1
  const Analysis analysis = analyse(in_order(data, true), true);
  const Comparison& made = analysis.metrics.front().comparisons.front();
  EXPECT_EQ(analysis.metrics.front().metric, "length_m");
  EXPECT_EQ(made.pairs, 10u);
  EXPECT_EQ(made.used, 8u);
  EXPECT_EQ(made.pipeline, 1u);
  EXPECT_EQ(made.against, 0u);
  EXPECT_TRUE(analysis.metrics.front().is_ratio);
  ASSERT_TRUE(made.effect.test && made.effect.interval);
  EXPECT_DOUBLE_EQ(made.rank_biserial(), 1);  // p1 is always one metre longer
  EXPECT_GE(made.effect.median, made.effect.interval->low);
  EXPECT_LE(made.effect.median, made.effect.interval->high);
  EXPECT_EQ(analysis.success_comparisons.front().only_pipeline, 1u);
  EXPECT_EQ(analysis.success_comparisons.front().test.second_more, 1u);
}

TEST(ReportComparisons, EqualRepetitionsCountOnceInEveryNumber) {
  StudyData data = study(3, 20, 2);
  for (RunRow& row : data.rows) {
    row.values[1] = 1000.0 + 10 * double(row.scenario) + double(row.pipeline);
    row.values[3] = 0.1 + row.repetition;
    row.outcome = row.scenario < 2 ? "no_path" : "solved";
  }
  const Analysis analysis = analyse(in_order(data, true), true);
  const MetricAnalysis& length = analysis.metrics.at(0);
  EXPECT_EQ(length.comparisons.front().used, 18u);
  EXPECT_EQ(length.comparisons.front().pairs, 20u);
  EXPECT_EQ(length.samples.front().values.size(), 18u);
  const MetricAnalysis& time = analysis.metrics.at(1);
  ASSERT_EQ(time.metric, "plan_time_s");
  EXPECT_EQ(time.comparisons.front().used, 36u) << "times are measured in each repetition";
  EXPECT_EQ(time.comparisons.front().pairs, 40u);
  EXPECT_EQ(time.samples.front().values.size(), 36u);
  EXPECT_EQ(analysis.success_comparisons.front().pairs, 20u);
  const auto files = written(data, true);
  const std::string& table = files.at("tables/pairs-length_m.md");
  EXPECT_NE(table.find("| 18 | 20 |"), std::string::npos) << table;
  EXPECT_NE(table.find("equal repetitions count once"), std::string::npos) << table;
  const std::string& common = files.at("tables/common.md");
  EXPECT_NE(common.find("| Length, m | p0 | 18 |"), std::string::npos) << common;
  EXPECT_NE(files.at("figures/boxes-length_m.svg").find("n = 18<"), std::string::npos);
  EXPECT_EQ(files.at("figures/boxes-plan_time_s.svg").find("count once"), std::string::npos);
}

TEST(ReportComparisons, CaptionsSayWhichRepetitionsCountOnce) {
  // p0 and p1 repeat themselves, p2 does not.
  StudyData data = study(3, 4, 2);
  for (RunRow& row : data.rows) {
    const int drawn = row.pipeline == 2 ? row.repetition : 0;
    row.values[1] = 1000.0 + 10 * double(row.scenario) + double(row.pipeline) + drawn;
  }
  const auto files = written(data);
  const std::string of_both = "the repetitions of two pipelines count once if those of both";
  const std::string& table = files.at("tables/pairs-length_m.md");
  EXPECT_NE(table.find(of_both), std::string::npos) << table;
  EXPECT_NE(table.find("| 4 | 4 |"), std::string::npos) << "p0 and p1" << table;
  EXPECT_NE(table.find("| 8 | 8 |"), std::string::npos) << "p0 and p2" << table;
  EXPECT_NE(files.at("tables/success-pairs.md").find(of_both), std::string::npos);
  EXPECT_NE(files.at("tables/metrics.md").find("of a pipeline count once if they are equal"),
            std::string::npos);
  const std::string& common = files.at("tables/common.md");
  EXPECT_EQ(common.find("count once"), std::string::npos) << common;
  EXPECT_NE(common.find("| Length, m | p0 | 8 |"), std::string::npos) << common;
}

TEST(ReportComparisons, EqualRepetitionsOfOneScenarioAreNoRanking) {
  StudyData data = study(3, 1, 5);
  for (RunRow& row : data.rows) {
    row.values[1] = 1000.0 + double(row.pipeline);
  }
  EXPECT_FALSE(analyse(in_order(data, true), true).metrics.front().ranking);
}

TEST(ReportComparisons, RatiosOrDifferencesOfAMetricAlike) {
  StudyData data = study(3, 8);
  EXPECT_TRUE(analyse(in_order(data, true), true).metrics.front().is_ratio);
  data.rows[2].values[1] = 0;  // of p2, which two of three comparisons have
  EXPECT_FALSE(analyse(in_order(data, true), true).metrics.front().is_ratio);
  const auto files = written(data);
  const std::string& csv = files.at("figures/pairs-length_m.csv");
  EXPECT_EQ(csv.find("ratio"), std::string::npos);
  EXPECT_NE(files.at("tables/pairs-length_m.md").find("median difference"), std::string::npos);
}

TEST(ReportComparisons, FigureAndTableNameThePipelinesInOneOrder) {
  const auto files = written(study(2, 8, 3));
  EXPECT_NE(files.at("figures/pairs-length_m.svg").find(">p1 / p0<"), std::string::npos);
  EXPECT_NE(files.at("tables/pairs-length_m.md").find("| p1 | p0 | 1.001 |"), std::string::npos)
      << files.at("tables/pairs-length_m.md");
  const std::string& csv = files.at("figures/pairs-length_m.csv");
  EXPECT_TRUE(csv.starts_with(
      "pipeline,against,effect_is,effect,low,high,n,n_of,n_differ,p,p_holm,rank_biserial,"
      "pairs_both_solved,pairs\r\np1,p0,ratio,1.0009"))
      << csv;
  EXPECT_NE(csv.find(",8,scenarios,8,0.0078125,0.0078125,1,24,24"), std::string::npos) << csv;
  EXPECT_NE(files.at("index.html").find("Left of the dashed line A, the first pipeline"),
            std::string::npos);
}

TEST(ReportComparisons, SaysHowManyScenariosDiffer) {
  StudyData data = study(2, 8);
  for (std::size_t at = 0; at < 10; ++at) {
    data.rows[at].values[1] = 1000;  // five scenarios are equal
  }
  const auto files = written(data);
  EXPECT_NE(files.at("tables/pairs-length_m.md").find("| 8 scenarios, 3 differ | 0.25 |"),
            std::string::npos)
      << files.at("tables/pairs-length_m.md");
  EXPECT_NE(files.at("figures/pairs-length_m.csv").find(",8,scenarios,3,0.25,"), std::string::npos);
}

TEST(ReportComparisons, AShareHasOneInterval) {
  StudyData data = study(2, 10, 3);
  for (RunRow& row : data.rows) {
    if (row.pipeline == 1 && (row.scenario == 4 || (row.scenario == 7 && row.repetition == 0))) {
      row.outcome = "no_route";
    }
  }
  const StudyData ordered = in_order(data, true);
  const Analysis analysis = analyse(ordered, true);
  const JudgedClaim judged = judge_claim(ordered, {"c", "share(p1.solved)", ">= 0.5", 0.95});
  const MadeInterval& shown = analysis.success[1].interval;
  ASSERT_TRUE(shown.interval && judged.interval);
  EXPECT_EQ(shown.method, "Wilson, 10 scenarios");
  EXPECT_EQ(judged.method, shown.method);
  EXPECT_EQ(judged.interval->low, shown.interval->low);
  EXPECT_EQ(judged.interval->high, shown.interval->high);
  EXPECT_EQ(analysis.success[0].interval.method, "Wilson, 10 scenarios");
  // Two scenarios speak for p0, of which one by a single repetition; four runs do.
  const SuccessComparison& made = analysis.success_comparisons.front();
  EXPECT_EQ(made.only_against, 4u);
  EXPECT_EQ(made.test.first_more, 2u);
  EXPECT_EQ(made.test.p, 0.5);
  ASSERT_TRUE(made.difference.interval);
  EXPECT_LT(made.difference.interval->low, -4.0 / 30);
  EXPECT_GT(made.difference.interval->high, 0) << "two scenarios may be chance";
}

TEST(ReportComparisons, OfTooFewScenariosThereIsNoInterval) {
  StudyData data = study(2, 5, 4);
  data.file.claims = {{"longer", "median(p1.length_m / p0.length_m)", "> 1", 0.95},
                      {"harder", "median(p1.expanded / p0.expanded)", "> 1", 0.95}};
  const auto files = written(data);
  const std::string& page = files.at("index.html");
  EXPECT_NE(page.find("none of 2 claims holds, 2 undecided"), std::string::npos);
  EXPECT_NE(page.find("Undecided, too few scenarios (at least 6 for 95 %): longer, harder."),
            std::string::npos);
  for (const std::string once : {"too few scenarios", "have no interval"}) {
    EXPECT_NE(page.find(once), std::string::npos) << once;
    EXPECT_EQ(page.find(once), page.rfind(once)) << once;
  }
}

TEST(ReportComparisons, AVerdictSaysNothingTwice) {
  StudyData data = study(2, 8);
  data.file.claims = {{"about", "median(p1.length_m / p0.length_m)", "0.9..1.1", 0.95}};
  const std::string page = written(data).at("index.html");
  EXPECT_NE(
      page.find("<code>median(p1.length_m / p0.length_m) within 0.9..1.1</code><p>Found: 1.00"),
      std::string::npos);
  EXPECT_NE(page.find("its claim holds"), std::string::npos);
  data.file.claims[0].is = "> 2";
  EXPECT_NE(written(data).at("index.html").find("its claim fails"), std::string::npos);
}

TEST(ReportComparisons, TheHeadlineSaysWhichVerdictsHolmTakes) {
  StudyData data = study(2, 6);  // p = 2 / 2^6 of each, 0.0625 of two
  data.file.claims = {{"one", "median(p1.length_m / p0.length_m)", "> 1", 0.95}};
  EXPECT_NE(written(data).at("index.html").find("its claim holds;"), std::string::npos);
  data.file.claims.push_back({"two", "median(p1.length_m - p0.length_m)", "> 0", 0.95});
  data.file.claims.push_back({"three", "median(p1.length_m - p0.length_m)", "0.5..1.5", 0.9999});
  const std::string page = written(data).at("index.html");
  EXPECT_NE(
      page.find("2 of 3 claims hold, 1 undecided (with Holm&#39;s correction 2 of these become "
                "undecided);"),
      std::string::npos);
}

TEST(ReportComparisons, AMetricIsComparedOnce) {
  StudyData data = study(2, 4);
  for (const char* name : {"length_m", "expanded", "length_m", "no_such_m", "plan_time_s"}) {
    data.file.metrics.push_back({name, {}});
  }
  const Analysis analysis = analyse(in_order(data, false), false);
  ASSERT_EQ(analysis.metrics.size(), 2u);
  EXPECT_EQ(analysis.left_out,
            (std::vector<std::string>{
                "length_m is listed twice.", "no_such_m is not compared: no run has this value.",
                "plan_time_s is not compared: it varies between equal runs."}));
  const auto files = written(data);
  EXPECT_NE(
      files.at("index.html").find("No run has a value &#39;no_such_m&#39;, a metric of the study."),
      std::string::npos);
  EXPECT_EQ(files.at("index.html").find("No run has a value &#39;plan_time_s"), std::string::npos);
}

TEST(ReportComparisons, AScenarioCountsOnceInTests) {
  const Analysis analysis = analyse(in_order(study(3, 6, 5), true), true);
  EXPECT_EQ(analysis.metrics.front().comparisons.front().effect.units.count, 6u);
  EXPECT_EQ(analysis.metrics.front().comparisons.front().used, 30u);
  EXPECT_EQ(analysis.metrics.front().ranking->blocks, 6u);
  const Analysis of_one = analyse(in_order(study(3, 1, 5), true), true);
  EXPECT_EQ(of_one.metrics.front().ranking->blocks, 5u);
}
}  // namespace
}  // namespace altiplan::study::report::report_comparisons_test
