// SPDX-License-Identifier: Apache-2.0
#include "study/plan/study_plan.hpp"

#include <algorithm>
#include <set>

#include "files.hpp"
#include "host/config/yaml.hpp"
#include "study/plan/study_grid.hpp"

namespace altiplan::host::study_plan_test {
using namespace study;
namespace {

using testing::Files;

std::vector<std::string> labels(const std::string& set) {
  std::vector<std::string> all;
  for (const GridCell& cell : grid_of(parse_yaml(set, "s.yaml"), "set")) {
    all.push_back(cell.label);
  }
  return all;
}

TEST(StudyGrid, EveryCombinationTheLastKeyFastest) {
  using Labels = std::vector<std::string>;
  EXPECT_EQ(labels("{a.x: [1, 2], b: 7, c: 0..1}"),
            (Labels{"[x=1,c=0]", "[x=1,c=1]", "[x=2,c=0]", "[x=2,c=1]"}));
  EXPECT_EQ(labels("{a: 7}"), Labels{""});
  EXPECT_EQ(labels("{s.0.w: [1, 2], s.1.w: [3]}"), (Labels{"[0.w=1]", "[0.w=2]"}));
  EXPECT_EQ(labels("{cell: [[1, 2], [3, 4]]}"), (Labels{"[cell=1x2]", "[cell=3x4]"}));
  EXPECT_EQ(labels("{n: 9223372036854775806..9223372036854775807}").size(), 2U);
  EXPECT_EQ(labels("{n: -2..0}"), (Labels{"[n=-2]", "[n=-1]", "[n=0]"}));
  EXPECT_EQ(labels("{file: ../data/a.tif}"), Labels{""}) << "a path is no range";
}

TEST(StudyGrid, ValuesAreReadAgainAsTheyWere) {
  const std::string text = R"({a: [1e3, "5", 'it''s', ../x.tif, {k: [x, "y, z"]}, "a: b"], e: ""})";
  const Value value = parse_yaml(text, "");
  const std::string again = flow_text(value);
  EXPECT_EQ(flow_text(parse_yaml(again, "")), again);
  const Value read = parse_yaml(again, "");
  EXPECT_TRUE(read.find("a")->items[1].quoted);
  EXPECT_FALSE(read.find("a")->items[0].quoted);
  EXPECT_EQ(read.find("a")->items[2].text, "it's");
  EXPECT_EQ(read.find("a")->items[4].find("k")->items[1].text, "y, z");
}

TEST(StudyGrid, RefusesWhatItCannotExpand) {
  for (const char* set :
       {"[1]", "{a: []}", "{a: 5..2}", "{a: 1..x}", "{a: 0..1000000}",
        "{a: 0..999, b: 0..999, c: [1, 2]}", "{a: -9223372036854775808..9223372036854775807}"}) {
    EXPECT_THROW(grid_of(parse_yaml(set, "s.yaml"), "set"), ConfigError) << set;
  }
}

class StudyPlanTest : public Files {
 protected:
  StudyPlanTest() {
    pipeline("steps: [{plan: told}, {plan: told, id: b, else: [{plan: told, id: c}]}]");
  }
  StudyPlan plan(const std::string& more, const StudySelection& selection = {}) const {
    return load_study(write("study.yaml", "altiplan: 1\n" + more), selection,
                      overrides_.plugin_path);
  }
  std::string problems(const std::string& more) const {
    try {
      plan(more);
    } catch (const Error& error) {
      return without_folder(error.what());
    }
    return "";
  }
  static constexpr const char* kStudy =
      "scenarios: [{file: s.yaml, set: {vehicle.radius_m: 1..5}}]\n"
      "pipelines: [{id: one, file: p.yaml}, {id: two, file: p.yaml, "
      "set: {steps.0.within_iterations: [10, 20]}}]\n"
      "repetitions: 4\n";
};

TEST_F(StudyPlanTest, EveryRunOnce) {
  const StudyPlan study = plan(kStudy);
  EXPECT_EQ(study.planned, 60U);
  ASSERT_EQ(study.runs.size(), 60U);
  EXPECT_EQ(study.pipelines[2].name, "two[within_iterations=20]");
  EXPECT_EQ(study.scenarios[4].name, "s[radius_m=5]");
  std::set<std::string> keys;
  std::set<std::string> names;
  std::set<std::pair<std::pair<std::size_t, int>, std::int64_t>> seeds;
  for (const PlannedRun& run : study.runs) {
    keys.insert(run.key);
    names.insert(name_of_run(study, run));
    seeds.insert({{run.scenario, run.repetition}, run.seed});
    EXPECT_GE(run.seed, 0);
    EXPECT_LT(run.seed, std::int64_t(1) << 53);
  }
  EXPECT_EQ(keys.size(), 60U);
  EXPECT_EQ(names.size(), 60U);
  EXPECT_EQ(seeds.size(), 20U) << "one seed for every pipeline of a pair";
  EXPECT_FALSE(std::is_sorted(
      study.runs.begin(), study.runs.end(),
      [](const PlannedRun& a, const PlannedRun& b) { return a.pipeline < b.pipeline; }))
      << "interleaved";
}

TEST_F(StudyPlanTest, KeysChangeWithWhatTheResultDependsOn) {
  const auto keys = [&](const std::string& more) {
    std::set<std::string> all;
    for (const PlannedRun& run : plan(more).runs) {
      all.insert(run.key);
    }
    return all;
  };
  const std::set<std::string> before = keys(kStudy);
  EXPECT_EQ(keys(std::string("name: other\n") + kStudy + "# a comment\n"), before);
  EXPECT_NE(keys(std::string("seed: 1\n") + kStudy), before);
  EXPECT_NE(keys(std::string("budget: {memory_mb: 100}\n") + kStudy), before);
  pipeline("# a comment\nsteps: [{plan: told}, {plan: told, id: b, else: [{plan: told, id: c}]}]");
  EXPECT_EQ(keys(kStudy), before);
  scenario("vehicle: {speed_mps: 3}\n");
  EXPECT_NE(keys(kStudy), before);
}

TEST_F(StudyPlanTest, ShardsAndSamplesArePartsOfTheWhole) {
  const auto names = [&](const StudySelection& selection) {
    std::set<std::string> all;
    const StudyPlan study = plan(kStudy, selection);
    for (const PlannedRun& run : study.runs) {
      all.insert(name_of_run(study, run));
    }
    return all;
  };
  std::set<std::string> together;
  std::size_t sum = 0;
  for (int shard = 1; shard <= 7; ++shard) {
    StudySelection selection;
    selection.shard = shard;
    selection.shards = 7;
    const std::set<std::string> part = names(selection);
    EXPECT_GE(part.size(), 8U);
    sum += part.size();
    together.insert(part.begin(), part.end());
  }
  EXPECT_EQ(sum, 60U);
  EXPECT_EQ(together.size(), 60U);
  StudySelection few;
  few.sample = 0.1;
  StudySelection more;
  more.sample = 0.5;
  EXPECT_EQ(names(few).size(), 6U) << "two pairs with three pipelines";
  EXPECT_EQ(names(more).size(), 30U);
  const std::set<std::string> small = names(few);
  const std::set<std::string> large = names(more);
  EXPECT_TRUE(std::includes(large.begin(), large.end(), small.begin(), small.end()));
  StudySelection filter;
  filter.filter = "^one .*#0$";
  EXPECT_EQ(names(filter).size(), 5U);
  filter.filter = "(";
  EXPECT_THROW(names(filter), Error);
}

TEST_F(StudyPlanTest, TheBudgetIsThatOfEveryPlanStep) {
  const StudyPlan study = plan(std::string(kStudy) + "budget: {time_s: 0.25}\n");
  const Config config = load_run(study, study.runs[0], overrides_.plugin_path);
  EXPECT_EQ(config.steps[0].within_s, 0.25);
  EXPECT_EQ(config.steps[1].otherwise.at(0).within_s, 0.25);
  EXPECT_HAS(problems(std::string(kStudy) + "budget: {iterations: 7}\n"),
             "budget.iterations: replaces 'steps.0.within_iterations', which "
             "'two[within_iterations=10]' sets");
  const StudyPlan brought = plan(
      "scenarios: [{file: s.yaml}]\nbudget: {iterations: 7}\n"
      "pipelines: [{id: a, file: p.yaml, set: {steps.0.else: [[{plan: told, id: d}]]}}]\n");
  EXPECT_EQ(load_run(brought, brought.runs[0], overrides_.plugin_path)
                .steps[0]
                .otherwise.at(0)
                .within_iterations,
            7)
      << "steps that the study brings have it too";
  EXPECT_EQ(config.seed, study.runs[0].seed);
  EXPECT_EQ(config.scenario.vehicle.radius_m, double(study.runs[0].scenario + 1));
}

TEST_F(StudyPlanTest, SaysWhatIsWrongAndWhere) {
  EXPECT_HAS(problems("steps: []"), "expected a study");
  EXPECT_HAS(problems("scenarios: [{file: none.yaml}]\npipelines: [{id: a, file: p.yaml}]"),
             "study.yaml:2:14: scenarios.0.file: file not found: 'none.yaml'");
  EXPECT_HAS(problems("scenarios: [{file: s.yaml}]\npipelines: [{id: A b, file: p.yaml}]"),
             "study.yaml:3:14: pipelines.0.id: expected lower-case letters");
  EXPECT_HAS(problems("scenarios: [{file: s.yaml}, {file: s.yaml}]\n"
                      "pipelines: [{id: a, file: p.yaml}]"),
             "scenarios.1: the name 's' is taken");
  EXPECT_HAS(
      problems(std::string(kStudy) + "claims: [{id: c, that: median(twoo.length_m), is: < 1}]"),
      "study.yaml:5:");
  const std::string pipelines = "\npipelines: [{id: a, file: p.yaml}]";
  EXPECT_HAS(problems("scenarios: [{file: s.yaml, set: {vehicle.radius_m: [1, 1]}}]" + pipelines),
             "two variants called 's[radius_m=1]'");
  EXPECT_HAS(
      problems("scenarios: [{file: s.yaml, set: {vehicle.radius_m: 1, vehicle: {}}}]" + pipelines),
      "sets 'vehicle.radius_m' twice");
  EXPECT_HAS(problems("scenarios: [{file: s.yaml, id: 'x[radius_m=1]'}]" + pipelines),
             "without brackets");
  EXPECT_HAS(problems("scenarios: [{file: s.yaml}]\nbudget: {time_s: 1e300}" + pipelines),
             "study.yaml:3:1: budget.time_s: steps.0.within_s: ");
  const std::string wrong = problems(
      "scenarios: [{file: s.yaml}]\n"
      "pipelines: [{id: a, file: p.yaml, set: {steps.0.with.dose: [1, 2]}}]");
  EXPECT_HAS(wrong, "study.yaml:3:");
  EXPECT_HAS(wrong, "pipelines.0.set: steps.0.with.dose: ");
  EXPECT_HAS(problems("scenarios: [{file: s.yaml}]\npipelines: [{id: a, file: p.yaml, "
                      "set: {stpes: 1}}]"),
             "did you mean 'steps'");
  EXPECT_HAS(problems("scenarios: [{file: s.yaml}]\npipelines: [{id: a, file: s.yaml}]"),
             "this is a scenario, expected a pipeline");
}
}  // namespace
}  // namespace altiplan::host::study_plan_test
