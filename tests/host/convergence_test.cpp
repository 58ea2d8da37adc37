// SPDX-License-Identifier: Apache-2.0
// What the iterations of traces come to in a report.
#include "study/report/convergence.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "altiplan/limits.hpp"
#include "study/report/anytime.hpp"
#include "study/report/figures.hpp"
#include "study/report/report.hpp"
#include "study/statistics/statistics.hpp"
#include "support/files.hpp"

namespace altiplan::study::report::convergence_test {
using namespace host;
namespace {

using altiplan::testing::TempFolder;
using altiplan::testing::text_of;

/// A line as TraceFile writes it; `of` is what follows the value.
std::string iteration(const std::string& step, int number, const std::string& best,
                      const std::string& of = "") {
  return R"({"step": ")" + step + R"(", "kind": "iteration", "node": )" + std::to_string(number) +
         R"(, "parent": -1, "at": [1, 2, 3], "value": )" + best + of + "}\n";
}
std::string population(const std::string& mean, int alive) {
  return R"(, "mean": )" + mean + R"(, "alive": )" + std::to_string(alive);
}
const std::string kBegin = "{\"altiplan_trace\": 1}\n";
const std::string kNode =
    R"({"step": "iteration", "kind": "added", "node": 1, "parent": -1, "at": [1, 2, 3], "value": 7})"
    "\n";

/// Four iterations of ten ants: none, then the best 1200, 1100 and 1000 with the mean a tenth
/// above, all times `scale`.
std::string colony(double scale = 1) {
  std::string text = kBegin + iteration("plan", 1, "null", population("null", 0)) + kNode;
  for (int i = 2; i <= 4; ++i) {
    const double best = scale * (1400 - 100 * i);
    text += iteration("plan", i, std::to_string(best),
                      population(std::to_string(best * (i == 4 ? 1.02 : 1.1)), 2 * i));
  }
  return text;
}

/// A run in each scenario of each pipeline, whose number of the scenario it has as its seed.
StudyData study(std::size_t pipelines, std::size_t scenarios) {
  StudyData data;
  data.file.name = "made up";
  data.stores = {"made.db"};
  for (std::size_t p = 0; p < pipelines; ++p) {
    data.pipelines.push_back({"p" + std::to_string(p), "p" + std::to_string(p), "p.yaml", {}});
  }
  for (std::size_t s = 0; s < scenarios; ++s) {
    data.scenarios.push_back({"s" + std::to_string(s), "s", "s.yaml", {}});
    for (std::size_t p = 0; p < pipelines; ++p) {
      RunRow row;
      row.key = std::to_string(data.rows.size());
      row.scenario = s;
      row.pipeline = p;
      row.seed = std::int64_t(s);
      row.outcome = "solved";
      data.rows.push_back(std::move(row));
    }
  }
  return data;
}

TEST(Convergence, OfATraceTheFirstSearchOfEachStep) {
  EXPECT_TRUE(progress_of("").empty());
  EXPECT_TRUE(progress_of(kBegin + kNode).empty());
  const auto progress =
      progress_of(kBegin + iteration("a", 1, "null", population("null", 0)) + kNode +
                  iteration("a", 2, "20.5", population("30.5", 4)) + iteration("b", 70, "9") +
                  "{\"kind\": \"iteration\", \n" + iteration("a", 1, "5") + iteration("a", 3, "4") +
                  iteration("b", 90, "8"));
  ASSERT_EQ(progress.size(), 2U);
  EXPECT_EQ(progress[0].step, "a");
  ASSERT_EQ(progress[0].iterations.size(), 2U) << "the search that begins again with 1 is another";
  EXPECT_EQ(progress[0].iterations[0].best, kInfinity);
  EXPECT_TRUE(std::isnan(progress[0].iterations[0].mean));
  EXPECT_EQ(progress[0].iterations[0].alive, 0);
  EXPECT_EQ(progress[0].iterations[1].number, 2);
  EXPECT_EQ(progress[0].iterations[1].best, 20.5);
  EXPECT_EQ(progress[0].iterations[1].mean, 30.5);
  EXPECT_EQ(progress[0].iterations[1].alive, 4);
  EXPECT_EQ(progress[1].iterations.back().number, 90);
  EXPECT_EQ(progress[1].iterations.back().alive, -1);
}

TEST(Convergence, OfAPopulationByIteration) {
  StudyData data = study(1, 1);
  data.rows.resize(3, data.rows[0]);
  data.rows[1].seed = 1;
  data.rows[2].seed = 2;
  const auto all = convergence_of(data, [](const RunRow& row) {
    return row.seed == 2 ? kBegin + iteration("plan", 1, "900", population("950", 10))
                         : colony(1 + 0.1 * double(row.seed));
  });
  ASSERT_EQ(all.size(), 1U);
  const Convergence& made = all[0];
  EXPECT_EQ(made.runs, 3U);
  EXPECT_TRUE(made.is_population && made.is_only_step && !made.is_ratio);
  EXPECT_EQ(made.iterations, (std::vector<double>{1, 2, 3, 4}));
  // At first one run of three has a route.
  EXPECT_EQ(made.best[0].median, kInfinity);
  EXPECT_EQ(made.mean[0].median, 950);
  EXPECT_EQ(made.alive[0].median, 0);
  // What a run has found holds when it has ended; means and ants are of those that go on.
  EXPECT_DOUBLE_EQ(made.best[3].median, 1000);
  EXPECT_DOUBLE_EQ(made.best[3].low, 0.8 * 900 + 0.2 * 1000);
  EXPECT_DOUBLE_EQ(made.best[3].high, 0.2 * 1000 + 0.8 * 1100);
  EXPECT_DOUBLE_EQ(made.mean[3].median, (1020 + 1122) / 2.0);
  EXPECT_DOUBLE_EQ(made.alive[3].low, 8);
  EXPECT_EQ(made.best_from.median, 4);
  EXPECT_EQ(made.mean_from.median, 4) << "950 is more than 3 % above 900";
  EXPECT_EQ(made.mean_from.high, kInfinity);
  EXPECT_EQ(made.alive_at_end.median, 8);
}

TEST(Convergence, OfSeveralScenariosByTheLastBest) {
  const auto all = convergence_of(study(2, 3), [](const RunRow& row) {
    return row.pipeline == 0 ? "" : colony(double(1 + row.seed));
  });
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].pipeline, 1U);
  EXPECT_TRUE(all[0].is_ratio);
  EXPECT_DOUBLE_EQ(all[0].best[1].low, 1.2);
  EXPECT_DOUBLE_EQ(all[0].best[1].high, 1.2);
  EXPECT_DOUBLE_EQ(all[0].mean[3].median, 1.02);
}

TEST(Convergence, ManyIterationsAreThinned) {
  std::string trace = kBegin;
  for (int i = 0; i < 1000; ++i) {
    trace += iteration("plan", 7 * i, std::to_string(2000 - i));
  }
  const auto all = convergence_of(study(1, 1), [&](const RunRow&) { return trace; });
  ASSERT_EQ(all.at(0).iterations.size(), 150U);
  EXPECT_EQ(all[0].iterations.front(), 0);
  EXPECT_EQ(all[0].iterations.back(), 6993);
  EXPECT_EQ(all[0].best.back().median, 1001);
  EXPECT_FALSE(all[0].is_population);
}

std::string at(double time_s, int expanded) {
  return R"(, "time_s": )" + std::to_string(time_s) + R"(, "expanded": )" +
         std::to_string(expanded);
}

/// Two scenarios: p0 comes to 100 in its first run and to 120 in the second, where p1 has none; p2
/// reports no iterations, and has a route of 103 after 4 s in the first.
StudyData races() {
  StudyData data = study(3, 2);
  data.columns = {"cost", "expanded", "plan_time_s"};
  for (RunRow& row : data.rows) {
    const bool solved = row.pipeline == 2 && row.scenario == 0;
    row.values = {solved ? 103 : kNone, solved ? 50 : kNone, solved ? 4 : kNone};
    row.outcome = row.pipeline == 0 || solved ? "solved" : "timed_out";
  }
  return data;
}
std::string race(const RunRow& row) {
  if (row.pipeline == 2) {
    return "";
  }
  if (row.pipeline == 1) {
    return kBegin + iteration("plan", 1, "null", at(0.5, 10));
  }
  return row.scenario == 0
             ? kBegin + iteration("plan", 1, "null", at(0.5, 10)) +
                   iteration("plan", 2, "104", at(1, 20)) + iteration("plan", 3, "104", at(2, 30)) +
                   iteration("plan", 4, "100", at(8, 40))
             : kBegin + iteration("plan", 1, "120", at(2, 10));
}

TEST(Anytime, CostsOverTheLeastOfTheScenario) {
  const auto all = anytime_of(races(), race);
  ASSERT_EQ(all.size(), 3U);
  const AnytimeCurve& curve = all[0].by_time;
  EXPECT_EQ(curve.at.size(), 100U);
  EXPECT_DOUBLE_EQ(curve.at.front(), 1);
  EXPECT_EQ(curve.at.back(), 8);
  EXPECT_EQ(curve.shares.front(), 0.5) << "an iteration without a route is none";
  EXPECT_EQ(curve.costs.front().high, kInfinity);
  EXPECT_EQ(curve.shares.back(), 1);
  EXPECT_DOUBLE_EQ(curve.costs.back().median, 1);
  EXPECT_EQ(all[0].by_evaluations.at.front(), 10);
  EXPECT_EQ(all[0].by_evaluations.at.back(), 50);
  EXPECT_DOUBLE_EQ(all[0].first_route_s.median, 1.5);
  ASSERT_EQ(all[0].times_to.size(), 2U);
  EXPECT_DOUBLE_EQ(all[0].times_to[0].time_s.median, 1.5);
  EXPECT_DOUBLE_EQ(all[0].times_to[1].time_s.median, 5);
  EXPECT_DOUBLE_EQ(all[0].times_to[1].evaluations.median, 25);
  EXPECT_EQ(all[1].first_route_s.low, kInfinity);
  EXPECT_EQ(all[1].by_time.shares.back(), 0);
  EXPECT_EQ(all[1].times_to[0].share, 0);
  EXPECT_EQ(all[2].times_to[0].share, 0.5) << "103 is within 5 %";
  EXPECT_EQ(all[2].times_to[1].share, 0);
}

TEST(Anytime, ThePublishedCostIsKnownToo) {
  StudyData data = races();
  data.columns.push_back("reference");
  for (RunRow& row : data.rows) {
    row.values.push_back(row.scenario == 0 ? 90 : kNone);
  }
  const auto all = anytime_of(data, race);
  EXPECT_DOUBLE_EQ(all[0].by_time.costs.back().high, 1 + 0.9 / 9);
  EXPECT_EQ(all[0].times_to[0].share, 0.5);
}

TEST(Anytime, WithoutTimesThereIsNone) {
  EXPECT_TRUE(anytime_of(study(1, 1), [](const RunRow&) { return colony(); }).empty());
  EXPECT_TRUE(anytime_of(races(), [](const RunRow&) { return std::string(); }).empty());
}

TEST(Anytime, TheReportDrawsIt) {
  for (const bool times : {true, false}) {
    const TempFolder temp;
    const std::filesystem::path folder = temp / "report";
    Source source{races(), "altiplan: 1\n", [](const RunRow&) { return std::string(); }};
    source.traces = race;
    Options options;
    options.times = times;
    write_report(source, options, folder);
    const std::string page = text_of(folder / "index.html");
    EXPECT_EQ(page.find("<section id=\"anytime\">") != page.npos, times);
    EXPECT_EQ(std::filesystem::exists(folder / "figures/anytime-time.svg"), times);
    if (times) {
      const std::string svg = text_of(folder / "figures/anytime-evaluations.svg");
      EXPECT_EQ(svg.find("nan"), svg.npos);
      EXPECT_EQ(svg.find("inf\""), svg.npos);
      const std::string table = text_of(folder / "tables/anytime.md");
      EXPECT_NE(table.find("| p1 | 2 | – | – | – | 0 %"), table.npos) << table;
    }
  }
}

TEST(Convergence, TheReportDrawsIt) {
  const auto report = [](const TraceSource& traces) {
    const TempFolder temp;
    const std::string folder = temp / "report";
    Source source{study(2, 2), "altiplan: 1\n", [](const RunRow&) { return std::string(); }};
    source.traces = traces;
    write_report(source, {}, folder);
    std::vector<std::string> texts;
    for (const char* name : {"index.html", "tables/convergence.md", "figures/convergence-p0.csv",
                             "figures/convergence-p1-plan.svg", "figures/convergence-p1-b.svg"}) {
      const auto file = std::filesystem::path(folder) / name;
      texts.push_back(std::filesystem::exists(file) ? text_of(file) : "");
    }
    return texts;
  };
  const auto without = report([](const RunRow&) { return std::string(); });
  EXPECT_EQ(without[0].find("onvergence"), std::string::npos);
  EXPECT_EQ(without[1] + without[2] + without[3] + without[4], "");

  const auto with = report([](const RunRow& row) {
    return row.pipeline == 0 ? colony() : colony() + iteration("b", 30, "900");
  });
  EXPECT_NE(with[0].find("<section id=\"convergence\">"), std::string::npos);
  EXPECT_NE(with[0].find("Convergence of p1, step plan"), std::string::npos);
  EXPECT_NE(with[1].find(R"(| p0 | plan | 2 | 4 \[4, 4\] | 4 \[4, 4\] | 8 \[8, 8\] |)"),
            std::string::npos)
      << with[1];
  EXPECT_NE(with[1].find(R"(| p1 | b | 2 | 30 \[30, 30\] | – | – |)"), std::string::npos)
      << with[1];
  EXPECT_EQ(with[2],
            "iteration,best_p10,best_median,best_p90,mean_p10,mean_median,mean_p90,alive_p10,"
            "alive_median,alive_p90\r\n1,,,,,,,0,0,0\r\n2,1.2,1.2,1.2,1.32,1.32,1.32,4,4,4\r\n"
            "3,1.1,1.1,1.1,1.21,1.21,1.21,6,6,6\r\n4,1,1,1,1.02,1.02,1.02,8,8,8\r\n");
  for (const std::string& svg : {with[3], with[4]}) {
    EXPECT_NE(svg.find("<svg"), std::string::npos);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf\""), std::string::npos);
  }
  EXPECT_NE(with[3].find("Found a route in the iteration"), std::string::npos);
  EXPECT_EQ(with[4].find("Found a route in the iteration"), std::string::npos);
}
}  // namespace
}  // namespace altiplan::study::report::convergence_test
