// SPDX-License-Identifier: Apache-2.0
// What altiplan reproduce marks: figures of made-up runs against those of a documentation, with all
// of its runs and with a part of them.
#include <gtest/gtest.h>

#include "study/claims/claims.hpp"
#include "study/reproduce/reproduce.hpp"

namespace altiplan::study::compare_figure_test {
namespace {

/// A pipeline p over so many scenarios: x is 1, 2, 3 …, one is always 1, late_m missing in all but
/// the first two.
StudyData runs(std::size_t scenarios) {
  StudyData data;
  data.columns = {"flight.late_m", "one", "plan_time_s", "x"};
  data.pipelines = {{"p", "p", "", {}}};
  for (std::size_t s = 0; s < scenarios; ++s) {
    data.scenarios.push_back({"s" + std::to_string(s), "s", "", {}});
    RunRow row;
    row.scenario = s;
    row.outcome = "solved";
    row.values = {s < 2 ? 1 : kNone, 1, 0.001, double(s + 1)};
    data.rows.push_back(row);
  }
  return data;
}

ReproducedFigure compared(const StudyData& data, const std::string& that,
                          const std::string& documentation, bool is_sample) {
  static PaperFigure figure;
  figure = {"figure", {"f", that, "== 0", kSampleConfidence}, false, false, "", documentation};
  return compare_figure(data, figure, is_sample);
}

Mark whole(const std::string& that, const std::string& documentation) {
  return compared(runs(20), that, documentation, false).mark;
}
Mark sample(const std::string& that, const std::string& documentation) {
  return compared(runs(20), that, documentation, true).mark;
}

TEST(CompareFigure, AllRunsGiveEveryDigit) {
  EXPECT_EQ(compared(runs(20), "median(p.x)", "10.5", false).here, "10.5");
  EXPECT_EQ(whole("median(p.x)", "10.5"), Mark::equal);
  EXPECT_EQ(whole("median(p.x)", "10.50"), Mark::equal);
  EXPECT_EQ(whole("median(p.x)", "10.6"), Mark::differs);
  EXPECT_EQ(whole("max(p.x)", "20"), Mark::equal);
  EXPECT_EQ(whole("max(p.x)", "21"), Mark::differs);
  EXPECT_EQ(whole("share(p.x <= 5)", "25.0 %"), Mark::equal);
  EXPECT_EQ(whole("share(p.x <= 5)", "5/20"), Mark::equal);
  EXPECT_EQ(whole("share(p.x <= 5)", "6/20"), Mark::differs);
  EXPECT_EQ(whole("mean(p.flight.late_m)", "2/20"), Mark::equal) << "runs that have it";
  EXPECT_EQ(whole("mean(p.flight.late_m)", "3/20"), Mark::differs);
  EXPECT_EQ(whole("mean(p.flight.missing)", "3"), Mark::differs) << "no run has it";
}

TEST(CompareFigure, ASharesCountIsOfAllRunsAsInTheReport) {
  StudyData data = runs(20);
  StudyData twice = data;
  twice.rows.clear();
  for (RunRow& row : data.rows) {
    row.outcome = row.scenario < 2 ? "no_path" : "solved";
    for (row.repetition = 0; row.repetition < 2; ++row.repetition) {
      twice.rows.push_back(row);
    }
  }
  const ReproducedFigure figure = compared(twice, "share(p.solved)", "36/40", false);
  EXPECT_EQ(figure.here, "36/40");
  EXPECT_EQ(figure.mark, Mark::equal);
  EXPECT_EQ(compared(twice, "share(p.solved)", "36/40", true).mark, Mark::within);
  EXPECT_EQ(compared(twice, "median(p.x)", "18/20", false).mark, Mark::equal)
      << "as the report's tables of metrics, where equal repetitions count once";
}

TEST(CompareFigure, TimesAreNeverJudged) {
  EXPECT_EQ(whole("median(p.plan_time_s)", "77"), Mark::time);
  EXPECT_EQ(sample("median(p.plan_time_s / p.x)", "77"), Mark::time);
  EXPECT_EQ(whole("median(p.plan_time_s)", "9/20"), Mark::differs) << "how many have it is no time";
}

TEST(CompareFigure, ASamplesIntervalHoldsTheFigure) {
  EXPECT_EQ(sample("median(p.x)", "12.3"), Mark::within);
  EXPECT_EQ(sample("median(p.x)", "25"), Mark::differs);
  EXPECT_EQ(sample("mean(p.x)", "12.3"), Mark::within);
  EXPECT_EQ(sample("mean(p.x)", "18"), Mark::differs);
  EXPECT_EQ(sample("share(p.x <= 5)", "40/100"), Mark::within);
  EXPECT_EQ(sample("share(p.x <= 5)", "90/100"), Mark::differs);
  EXPECT_EQ(sample("mean(p.flight.late_m)", "20/100"), Mark::within);
  EXPECT_EQ(sample("mean(p.flight.late_m)", "90/100"), Mark::differs);
  EXPECT_EQ(sample("median(p.one)", "2"), Mark::differs) << "20 of 20 are 1";
}

TEST(CompareFigure, AnExtremeOfASampleIsNoFartherOut) {
  EXPECT_EQ(sample("max(p.x)", "20"), Mark::within);
  EXPECT_EQ(sample("max(p.x)", "300"), Mark::within);
  EXPECT_EQ(sample("max(p.x)", "19"), Mark::differs);
  EXPECT_EQ(sample("min(p.x)", "0"), Mark::within);
  EXPECT_EQ(sample("min(p.x)", "2"), Mark::differs);
}

TEST(CompareFigure, TooFewRunsDecideNothing) {
  const ReproducedFigure few = compared(runs(10), "median(p.x)", "999", true);
  EXPECT_EQ(few.mark, Mark::too_few);
  EXPECT_EQ(few.why, "too few scenarios: at least 11 for 99.9 %");
  const ReproducedFigure far = compared(runs(20), "p95(p.x)", "999", true);
  EXPECT_EQ(far.mark, Mark::too_few) << "20 runs do not reach so far";
  EXPECT_EQ(far.why, "too few scenarios: at least 149 for 99.9 %");
  EXPECT_EQ(sample("mean(p.one)", "1"), Mark::within);
  EXPECT_EQ(sample("mean(p.one)", "1.1"), Mark::too_few) << "other values may be rare";
  EXPECT_EQ(sample("mean(p.flight.missing)", "1"), Mark::too_few);
}

TEST(CompareFigure, OnlyAContraryVerdictOfASampleDiffers) {
  const auto verdict = [](const std::string& that, const std::string& is,
                          const std::string& documentation, bool is_sample) {
    const PaperFigure figure{"verdict", {"c", that, is, 0.95}, true, true, "", documentation};
    return compare_figure(runs(20), figure, is_sample).mark;
  };
  EXPECT_EQ(verdict("median(p.x)", "<= 19", "holds", false), Mark::equal);
  EXPECT_EQ(verdict("median(p.x)", "<= 19", "undecided", false), Mark::differs);
  EXPECT_EQ(verdict("median(p.x)", "<= 19", "undecided", true), Mark::too_few);
  EXPECT_EQ(verdict("median(p.x)", "<= 19", "fails", true), Mark::differs);
  EXPECT_EQ(verdict("median(p.x)", "<= 1", "holds", true), Mark::differs);
  EXPECT_EQ(verdict("median(p.x)", "<= 11", "holds", true), Mark::too_few) << "undecided here";
  EXPECT_EQ(verdict("max(p.x)", "<= 30", "fails", true), Mark::too_few) << "others may be larger";
  EXPECT_EQ(verdict("max(p.x)", "<= 10", "holds", true), Mark::differs);
  EXPECT_EQ(verdict("median(p.plan_time_s)", "<= 1", "fails", false), Mark::time);
}

TEST(CompareFigure, AClaimsEstimateKeepsItsOwnInterval) {
  PaperFigure figure{"measured",        {"c", "median(p.x)", "<= 1", 0.95}, true, false, "",
                     "10.5 [6.0, 15.0]"};
  const ReproducedFigure all = compare_figure(runs(20), figure, false);
  const JudgedClaim judged = judge_claim(runs(20), figure.claim);
  figure.documentation = all.here;
  EXPECT_EQ(compare_figure(runs(20), figure, false).mark, Mark::equal);
  ASSERT_TRUE(judged.interval);
  EXPECT_NEAR(std::stod(all.here.substr(6)), judged.interval->low, 0.051) << all.here;
  EXPECT_EQ(compare_figure(runs(20), figure, true).mark, Mark::within);
}
}  // namespace
}  // namespace altiplan::study::compare_figure_test
