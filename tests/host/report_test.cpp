// SPDX-License-Identifier: Apache-2.0
// Reports of made-up studies: whatever the runs are, the files are there, whole and the same again.
#include "study/report/report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "altiplan/error.hpp"
#include "host/config/yaml.hpp"
#include "report_study.hpp"
#include "study/figures/text.hpp"

namespace altiplan::study::report::report_test {
namespace {

TEST(Report, OfNothing) {
  EXPECT_NE(written({}).at("index.html").find("No runs yet."), std::string::npos);
  StudyData data = study(3, 4);
  data.rows.clear();
  EXPECT_NE(written(data).at("index.html").find("No runs yet."), std::string::npos);
}

TEST(Report, OfLittle) {
  EXPECT_NE(written(study(1, 1)).at("index.html").find("1 of 1 run solved"), std::string::npos);
  EXPECT_EQ(written(study(1, 5)).count("tables/success-pairs.md"), 0u);
  EXPECT_EQ(written(study(2, 5)).count("tables/success-pairs.md"), 1u);
  EXPECT_EQ(written(study(2, 1, 4)).count("figures/ranks-length_m.svg"), 0u);
  EXPECT_EQ(written(study(3, 1, 4)).count("figures/ranks-length_m.svg"), 1u);
  EXPECT_EQ(written(study(12, 3)).count("figures/ranks-length_m.svg"), 1u);
}

TEST(Report, TellsThatRunsAreMissing) {
  const auto told = [](std::size_t stored, std::size_t planned) {
    StudyData data;
    data.rows.resize(stored);
    data.planned = planned;
    return incomplete(data);
  };
  EXPECT_EQ(told(34, 540), "34 of 540 planned runs are stored (6 %): verdicts are preliminary.");
  EXPECT_EQ(told(539, 540), "539 of 540 planned runs are stored (99 %): verdicts are preliminary.");
  EXPECT_EQ(told(1, 5400),
            "1 of 5,400 planned runs is stored (less than 1 %): verdicts are preliminary.");
  EXPECT_EQ(told(540, 540), "");
  EXPECT_EQ(told(34, 0), "");  // not known

  StudyData data = study(2, 4);
  EXPECT_EQ(written(data).at("index.html").find("preliminary"), std::string::npos);
  data.planned = 16;
  const auto files = written(data);
  for (const char* name : {"index.html", "tables/verdicts.md", "tables/success.tex"}) {
    EXPECT_NE(files.at(name).find("verdicts are preliminary"), std::string::npos) << name;
  }
  const TempFolder temp;
  EXPECT_TRUE(write_report(source_of(data), options(), temp / "report")
                  .summary.starts_with("8 of 16 planned runs are stored (50 %)"));
}

TEST(Report, TablesOverRunsThatAllSolved) {
  StudyData data = study(2, 4);
  data.file.budget.time_s = 5;
  data.rows.back().outcome = "timed_out";  // of p1 in s3
  const auto files = written(data, true);
  const std::string common = files.at("tables/common.md");
  EXPECT_NE(common.find("Values over the pairs"), std::string::npos) << common;
  EXPECT_NE(common.find("| Length, m | p0 | 3 | 1,010 | 1,010 | 1,000 | 1,020 |"),
            std::string::npos)
      << common;
  const std::string par = files.at("tables/par.md");
  EXPECT_NE(par.find("also of an invalid problem, counts twice"), std::string::npos) << par;
  EXPECT_NE(par.find("| p0 | 4 | 0.1000 | 0.1000 |"), std::string::npos) << par;
  EXPECT_NE(par.find("| p1 | 4 | 2.575 | 12.57 |"), std::string::npos) << par;
  EXPECT_NE(files.at("tables/par.tex").find("\\label{tab:par}"), std::string::npos);
  EXPECT_EQ(written(data).count("tables/par.md"), 0U) << "times are omitted";
  data.file.budget.time_s.reset();
  EXPECT_EQ(written(data, true).count("tables/par.md"), 0U);
}

TEST(Report, OfFailuresAlone) {
  StudyData data = study(2, 3);
  for (RunRow& row : data.rows) {
    row.outcome = "crashed";
    row.message = "astar: segmentation fault";
    std::fill(row.values.begin(), row.values.end(), kNaN);
  }
  const std::string page = written(data, true).at("index.html");
  EXPECT_NE(page.find("6 unexplained failures"), std::string::npos);
  EXPECT_NE(page.find("altiplan replay /somewhere/study.db &#39;p0 s0 #0&#39;"), std::string::npos);
}

TEST(Report, OfOddNumbers) {
  for (const double odd :
       {kNaN, 0.0, -1.0, 1e300, -1e300, 1e-300, std::numeric_limits<double>::infinity()}) {
    StudyData data = study(3, 6);
    for (RunRow& row : data.rows) {
      std::fill(row.values.begin(), row.values.end(), odd);
    }
    written(data, true);
    data.rows.front().values.assign(4, 5.0);
    written(data, true);
  }
}

TEST(Report, ExplainsWhatIsToBeExplained) {
  for (const char* outcome :
       {"failed", "crashed", "out_of_memory", "bad_output", "refused", "odd"}) {
    EXPECT_TRUE(unexplained(outcome)) << outcome;
  }
  for (const char* outcome : {"solved", "no_route", "timed_out", "cancelled", "invalid_problem",
                              "rejected", "collided", "not_reached"}) {
    EXPECT_FALSE(unexplained(outcome)) << outcome;
  }
}

TEST(Report, GroupsFailuresMostFirst) {
  StudyData data = study(2, 4);
  for (RunRow& row : data.rows) {
    row.outcome = row.pipeline == 1 ? "failed" : row.scenario == 0 ? "crashed" : "no_route";
    row.message = row.outcome;
  }
  const std::string page = written(data).at("index.html");
  const std::size_t table = page.find("table-failures");
  EXPECT_LT(page.find("failed</td>", table), page.find("crashed</td>", table));
  EXPECT_EQ(page.find("no route</td>", table), std::string::npos);
}

/// What has happened to the stores: another order, other ids, other times.
StudyData with_another_history(StudyData data) {
  std::mt19937 random(5);
  std::reverse(data.scenarios.begin(), data.scenarios.end());
  std::reverse(data.pipelines.begin(), data.pipelines.end());
  for (RunRow& row : data.rows) {
    row.scenario = data.scenarios.size() - 1 - row.scenario;
    row.pipeline = data.pipelines.size() - 1 - row.pipeline;
    row.id += 1000;
    row.place = 4;
    row.values[2] = double(random());
    row.values[3] = double(random());
  }
  std::shuffle(data.rows.begin(), data.rows.end(), random);
  data.stores = {"/elsewhere/again.db", "/elsewhere/more.db"};
  data.sessions.resize(3);
  return data;
}

TEST(Report, WithoutTimesIsTheSameWhateverTheHistory) {
  StudyData data = study(4, 12, 2);
  data.rows[5].outcome = "timed_out";
  data.rows[9].outcome = "crashed";
  data.file.claims = {{"shorter", "median(p1.length_m / p0.length_m)", "<= 1.1", 0.95},
                      {"quicker", "median(p1.plan_time_s / p0.plan_time_s)", "<= 1.1", 0.95}};
  const auto files = written(data);
  const auto again = written(with_another_history(data));
  ASSERT_EQ(files.size(), again.size());
  for (const auto& [name, text] : files) {
    EXPECT_TRUE(again.at(name) == text) << name;
    EXPECT_EQ(text.find("somewhere"), std::string::npos) << name;
  }
  EXPECT_EQ(files.at("runs.csv").find("plan_time_s"), std::string::npos);
  EXPECT_NE(files.at("index.html").find("claim &#39;quicker&#39; is about measured times"),
            std::string::npos);
  EXPECT_FALSE(written(data, true) == written(with_another_history(data), true));
}

TEST(Report, ScenariosAreOrderedByTheirNumbers) {
  const std::string csv = written(study(1, 12)).at("runs.csv");
  EXPECT_LT(csv.find("\ns2,"), csv.find("\ns10,"));
}

TEST(Report, PipelinesAreInTheOrderOfTheStudy) {
  StudyData data = study(4, 2);
  data.file = {};
  const Value tree = parse_yaml(
      "{altiplan: 1, name: order, scenarios: [{file: s.yaml}], pipelines: [{id: w, file: w.yaml, "
      "set: {g: [0.9, 0.1, 0.5]}}, {id: a, file: a.yaml}]}",
      "study.yaml");
  ASSERT_TRUE(bind(data.file, &tree).problems.empty());
  for (const auto& [at, name, of] : {std::tuple(0, "a", "a"),
                                     {1, "w[g=0.1]", "w"},
                                     {2, "w[g=0.5]", "w"},
                                     {3, "w[g=0.9]", "w"}}) {
    data.pipelines[std::size_t(at)].name = name;
    data.pipelines[std::size_t(at)].of = of;
  }
  for (const bool times : {true, false}) {
    std::vector<std::string> names;
    for (const StoredVariant& pipeline : in_order(data, times).pipelines) {
      names.push_back(pipeline.name);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"w[g=0.9]", "w[g=0.1]", "w[g=0.5]", "a"}));
  }
}

TEST(Report, HostileNamesAreText) {
  StudyData data = study(3, 4);
  const std::string hostile = "</script><script>alert(1)</script>\"'&$_%\n\xFF\\|";
  data.file.name = hostile;
  data.pipelines[1].name = hostile;
  data.scenarios[2].name = hostile;
  data.columns[0] = "a" + hostile;
  data.rows[3].outcome = "crashed";
  data.rows[3].message = hostile;
  data.rows[4].outcome = hostile;
  for (const auto& [name, text] : written(data, true)) {
    EXPECT_EQ(text, printable(text, true).size() == text.size() ? text : "") << name;
    if (name.ends_with(".html") || name.ends_with(".svg") || name.ends_with(".md")) {
      EXPECT_EQ(text.find("<script>alert"), std::string::npos) << name;
    }
    EXPECT_EQ(text.find('\xFF'), std::string::npos) << name;
  }
}

TEST(Report, FolderOfOthersIsLeftAlone) {
  const TempFolder temp;
  temp.write("mine.txt", "precious");
  EXPECT_THROW(write_report(source_of(study(1, 1)), options(), temp / "."), Error);
  EXPECT_THROW(write_report(source_of(study(1, 1)), options(), temp / "mine.txt"), Error);
  EXPECT_EQ(text_of(temp / "mine.txt"), "precious");
}

TEST(Report, TakesThePlaceOfAnEarlierOne) {
  const auto expected = written(study(1, 3));
  const TempFolder temp;
  write_report(source_of(study(3, 3)), options(), temp / "report");
  write_report(source_of(study(1, 3)), options(), temp / "report");
  EXPECT_EQ(files_of(temp / "report"), expected);
}

TEST(Report, ScenesAreOfFailuresFirst) {
  StudyData data = study(2, 40);
  data.rows[71].outcome = "crashed";
  data.rows[31].outcome = "no_route";
  const StudyData ordered = in_order(data, true);
  const auto chosen = choose_scenes(ordered, analyse(ordered, true), 10);
  ASSERT_EQ(chosen.size(), 10u);
  EXPECT_EQ(ordered.rows[chosen[0].front()].outcome, "crashed");
  EXPECT_EQ(ordered.rows[chosen[1].front()].outcome, "no_route");
  EXPECT_EQ(chosen[0].size(), 2u);  // with the other pipeline's run of the pair
}
}  // namespace
}  // namespace altiplan::study::report::report_test
