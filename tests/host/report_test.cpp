// SPDX-License-Identifier: Apache-2.0
// Reports of made-up studies: whatever the runs are, the files are there, whole and the same again.
#include "study/report/report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "altiplan/error.hpp"
#include "host/config/yaml.hpp"
#include "study/figures/text.hpp"
#include "study/report/page.hpp"
#include "support/files.hpp"

namespace altiplan::study::report {
using namespace host;
namespace {

namespace fs = std::filesystem;
using altiplan::testing::TempFolder;
using altiplan::testing::text_of;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Pipelines p0 …, scenarios s0 …; values that differ from run to run are among them.
StudyData study(std::size_t pipelines, std::size_t scenarios, int repetitions = 1) {
  StudyData data;
  data.file.name = "made up";
  data.file.seed = 3;
  data.stores = {"/somewhere/study.db"};
  data.columns = {"expanded", "length_m", "peak_memory_mb", "plan_time_s"};
  for (std::size_t p = 0; p < pipelines; ++p) {
    data.pipelines.push_back({"p" + std::to_string(p), "p" + std::to_string(p), "p.yaml", {}});
    data.file.pipelines.push_back({"p" + std::to_string(p), {}, {}});
  }
  for (std::size_t s = 0; s < scenarios; ++s) {
    data.scenarios.push_back({"s" + std::to_string(s), "s", "s.yaml", {}});
    for (std::size_t p = 0; p < pipelines; ++p) {
      for (int r = 0; r < repetitions; ++r) {
        RunRow row;
        row.id = std::int64_t(data.rows.size());
        row.key = "key" + std::to_string(data.rows.size());
        row.scenario = s;
        row.pipeline = p;
        row.repetition = r;
        row.outcome = "solved";
        row.values = {100.0 * double(s + 1), 1000.0 + 10 * double(s) + double(p) + r, 40, 0.1};
        data.rows.push_back(std::move(row));
      }
    }
  }
  return data;
}

Source source_of(StudyData data) {
  return {std::move(data), "altiplan: 1\n", [](const RunRow&) { return std::string(); }};
}

Options options(bool times = false) {
  Options made;
  made.times = times;
  made.command = "altiplan report DB -o DIR";
  return made;
}

std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files[fs::relative(entry.path(), folder).string()] = text_of(entry.path());
    }
  }
  return files;
}

/// The report's files; NaN and infinity must not have come into any picture.
std::map<std::string, std::string> written(const StudyData& data, bool times = false) {
  const TempFolder temp;
  write_report(source_of(data), options(times), temp / "report");
  auto files = files_of(temp / "report");
  for (const char* must :
       {"index.html", "runs.csv", "figures/success.svg", "figures/success.csv", "tables/success.md",
        "tables/success.tex", "tables/verdicts.md", "tables/scenarios.csv"}) {
    EXPECT_EQ(files.count(must), 1u) << must;
  }
  for (const auto& [name, text] : files) {
    if (name.ends_with(".svg")) {
      EXPECT_EQ(text.find("nan"), std::string::npos) << name;
      EXPECT_EQ(text.find("inf"), std::string::npos) << name;
    }
  }
  return files;
}

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
  EXPECT_NE(files.at("index.html").find("claim &#39;quicker&#39; is on measured times"),
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

TEST(Report, ComparesOnThePairsThatBothSolved) {
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

TEST(Report, RatiosOrDifferencesOfAMetricAlike) {
  StudyData data = study(3, 8);
  EXPECT_TRUE(analyse(in_order(data, true), true).metrics.front().is_ratio);
  data.rows[2].values[1] = 0;  // of p2, which two of three comparisons have
  EXPECT_FALSE(analyse(in_order(data, true), true).metrics.front().is_ratio);
  const auto files = written(data);
  const std::string& csv = files.at("figures/pairs-length_m.csv");
  EXPECT_EQ(csv.find("ratio"), std::string::npos);
  EXPECT_NE(files.at("tables/pairs-length_m.md").find("median difference"), std::string::npos);
}

TEST(Report, FigureAndTableNameThePipelinesInOneOrder) {
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
  EXPECT_NE(files.at("index.html").find("Left of the dashed line A, the pipeline named first"),
            std::string::npos);
}

TEST(Report, SaysHowManyScenariosDiffer) {
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

TEST(Report, AShareHasOneInterval) {
  StudyData data = study(2, 10, 3);
  for (RunRow& row : data.rows) {
    if (row.pipeline == 1 && (row.scenario == 4 || (row.scenario == 7 && row.repetition == 0))) {
      row.outcome = "no_route";
    }
  }
  const StudyData ordered = in_order(data, true);
  const Analysis analysis = analyse(ordered, true);
  const JudgedClaim judged = judge_claim(ordered, {"c", "share(p1.solved)", ">= 0.5", 0.95});
  const ShareInterval& shown = analysis.success[1].interval;
  ASSERT_TRUE(shown.interval && judged.interval);
  EXPECT_EQ(shown.method, "bootstrap of 10 scenarios");
  EXPECT_EQ(judged.method, shown.method);
  EXPECT_EQ(judged.interval->low, shown.interval->low);
  EXPECT_EQ(judged.interval->high, shown.interval->high);
  EXPECT_EQ(analysis.success[0].interval.method, "Wilson, 10 scenarios");
  // Two scenarios speak for p0, of which one by a single repetition; four runs do.
  const SuccessComparison& made = analysis.success_comparisons.front();
  EXPECT_EQ(made.only_against, 4u);
  EXPECT_EQ(made.test.first_more, 2u);
  EXPECT_EQ(made.test.p, 0.5);
}

TEST(Report, OfTooFewScenariosThereIsNoInterval) {
  StudyData data = study(2, 5, 4);
  data.file.claims = {{"longer", "median(p1.length_m / p0.length_m)", "> 1", 0.95}};
  const auto files = written(data);
  const std::string& page = files.at("index.html");
  EXPECT_NE(page.find("its claim is undecided"), std::string::npos);
  EXPECT_NE(page.find("too few scenarios: at least 6 for 95 %"), std::string::npos);
  EXPECT_NE(page.find("too few scenarios, at least 6 are needed"), std::string::npos);
}

TEST(Report, AVerdictSaysNothingTwice) {
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

TEST(Report, AMetricIsComparedOnce) {
  StudyData data = study(2, 4);
  for (const char* name : {"length_m", "expanded", "length_m", "no_such_m", "plan_time_s"}) {
    data.file.metrics.push_back({name, {}});
  }
  const Analysis analysis = analyse(in_order(data, false), false);
  ASSERT_EQ(analysis.metrics.size(), 2u);
  EXPECT_EQ(analysis.left_out,
            (std::vector<std::string>{"length_m is named twice.",
                                      "no_such_m is not compared: no run has such a number.",
                                      "plan_time_s is not compared: it differs from run to run."}));
}

TEST(Report, AScenarioCountsOnceInTests) {
  const Analysis analysis = analyse(in_order(study(3, 6, 5), true), true);
  EXPECT_EQ(analysis.metrics.front().comparisons.front().effect.units.count, 6u);
  EXPECT_EQ(analysis.metrics.front().comparisons.front().used, 30u);
  EXPECT_EQ(analysis.metrics.front().ranking->blocks, 6u);
  const Analysis of_one = analyse(in_order(study(3, 1, 5), true), true);
  EXPECT_EQ(of_one.metrics.front().ranking->blocks, 5u);
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

TEST(ReportScenes, AreOfFailuresFirst) {
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
}  // namespace altiplan::study::report
