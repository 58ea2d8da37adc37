// SPDX-License-Identifier: Apache-2.0
#include "host/describe/schema.hpp"

#include <gtest/gtest.h>

#include "host/describe/describe.hpp"
#include "study/model/study_file.hpp"
#include "study/reproduce/paper_file.hpp"
#include "support/files.hpp"
#include "support/folders.hpp"

namespace altiplan::host::schema_test {
using namespace study;
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Plugins as the tests want them: one of each kind, whatever has been built.
std::vector<Choice> made_up(std::string_view kind) {
  FieldSpec cell;
  cell.name = "cell_m";
  cell.type = FieldType::vec3;
  cell.unit = "m";
  cell.doc = "edge of a cell";
  cell.min = 0;
  cell.above = true;
  cell.default_json = "[50, 50, 10]";
  FieldSpec radius;
  radius.name = "radius_m";
  radius.type = FieldType::auto_number;
  radius.min = 0;
  radius.required = true;
  FieldSpec mode;
  mode.name = "mode";
  mode.type = FieldType::choice;
  mode.choices = {"near", "far"};
  mode.default_json = "\"near\"";
  FieldSpec point;
  point.type = FieldType::point;
  if (kind == "planner") {
    return {{"astar", {cell, mode}}, {"needy", {radius}}};
  }
  if (kind == "local_planner") {
    return {{"apf", {mode}}};
  }
  if (kind == "smoother") {
    return {{"prune", {}}};
  }
  if (kind == "environment") {
    return {{"ball", {point, radius}}};
  }
  return {};
}

std::string check(const Json& schema, const std::vector<std::pair<bool, std::string>>& cases) {
  std::vector<std::pair<bool, Json>> documents;
  for (const auto& [fits, text] : cases) {
    documents.emplace_back(fits, Json::parse(text));
  }
  return altiplan::testing::schema_disagreement(schema, documents);
}

class SchemaTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!altiplan::testing::has_schema_validator()) {
      GTEST_SKIP() << "no python3-jsonschema to validate with";
    }
  }
};

TEST_F(SchemaTest, Pipeline) {
  const auto with_step = [](const std::string& step) {
    return R"({"altiplan": 1, "steps": [)" + step + "]}";
  };
  EXPECT_EQ(
      check(
          pipeline_schema(made_up),
          {{true, with_step(R"({"plan": "astar", "within_s": 5})")},
           {true, with_step(R"({"plan": "astar", "with": {"cell_m": [1, 2, 3], "mode": "far"}})")},
           {true, with_step(R"({"plan": "apf", "with": {"mode": "near"}})")},
           {true, with_step(R"({"plan": "needy", "with": {"radius_m": "auto"}})")},
           {true, with_step(R"({"smooth": "prune", "from": "a"}, {"fly": "route"})")},
           {true, with_step(R"({"fly": "apf", "smooth": [{"prune": {}}], "when": "unsafe"})")},
           {true, with_step(R"({"fly": "apf", "replan": {"plan": "astar"}, "step_s": 2})")},
           {true, with_step(R"({"plan": "astar", "else": [{"plan": "apf"}]})")},
           {false, with_step("")},
           {false, with_step(R"({"plan": "astra"})")},
           {false, with_step(R"({"plan": "needy"})")},
           {false, with_step(R"({"plan": "needy", "with": {}})")},
           {false, with_step(R"({"plan": "needy", "with": {"radius_m": -1}})")},
           {false, with_step(R"({"plan": "needy", "with": {"radius_m": "car"}})")},
           {false, with_step(R"({"plan": "astar", "with": {"cell_m": [1, 0, 3]}})")},
           {false, with_step(R"({"plan": "astar", "with": {"cell_m": [1, 2]}})")},
           {false, with_step(R"({"plan": "astar", "with": {"mode": "medium"}})")},
           {false, with_step(R"({"plan": "apf", "with": {"cell_m": [1, 2, 3]}})")},
           {false, with_step(R"({"plan": "astar", "smooth": "prune"})")},
           {false, with_step(R"({"plan": "astar", "from": "a"})")},
           {false, with_step(R"({"plan": "astar", "step_s": 1})")},
           {false, with_step(R"({"smooth": "bspline"})")},
           {false, with_step(R"({"id": "a"})")},
           {false, with_step(R"({"fly": "apf", "smooth": "prune"})")},
           {false, with_step(R"({"plan": "astar", "else": [{"plan": "nothing"}]})")},
           {false, R"({"altiplan": 2, "steps": [{"plan": "astar"}]})"},
           {false, R"({"altiplan": 1})"},
           {false, R"({"altiplan": 1, "steps": [{"plan": "astar"}], "sede": 7})"}}),
      "");
}

TEST_F(SchemaTest, Scenario) {
  const auto with = [](const std::string& more) {
    return R"({"altiplan": 1, "start": {"at_m": [0, 0, 1]}, "goal": {"at_m": [9, 9, 1]}, )" + more +
           "}";
  };
  const auto layer = [&](const std::string& text) {
    return with(R"("environment": [)" + text + "]");
  };
  EXPECT_EQ(
      check(scenario_schema(made_up),
            {{true, layer(R"({"ball": {"at_m": [1, 2, 3], "radius_m": 2}, "known": false})")},
             {true, layer(R"({"ball": {"radius_m": "auto"}, "id": "b"})")},
             {true, with(R"("events": [{"at_s": 2, "add": {"ball": {"radius_m": 2}}}])")},
             {false, layer(R"({"ball": {}})")},
             {false, layer(R"({"id": "b"})")},
             {false, layer(R"({"cube": {}})")},
             {false, layer(R"({"ball": {"radius_m": 2}, "shown": true})")},
             {false, layer(R"({"ball": {"radius_m": 2, "at_m": [1, 2], "at_lonlat": [1, 2]}})")},
             {false, with(R"("events": [{"at_s": -1, "remove": "b"}])")},
             {false, R"({"altiplan": 1, "start": {}, "goal": {"at_m": [9, 9, 1]}})"},
             {false, R"({"altiplan": 1, "start": {"at_m": [9, 9, 1]}})"}}),
      "");
}

TEST_F(SchemaTest, StudyPaperAndAllTogether) {
  const std::string study =
      R"json({"altiplan": 1, "scenarios": [{"file": "s.yaml", "set": {"a.b": "0..9"}}],
          "pipelines": [{"id": "p", "file": "p.yaml"}], "claims":
          [{"id": "c", "that": "share(p.solved)", "is": ">= 0.9"}]
})json";
  const std::string no_pipelines = R"({"altiplan": 1, "scenarios": [{"file": "s.yaml"}]})";
  const auto paper = [](const std::string& figure) {
    return R"json({"altiplan": 1, "runs": [{"id": "r", "study": "s.yaml", "cpu_ms": {"p": 1}}],
        "tables": [{"heading": "h", "runs": "r", "columns": [{"name": "n", "of": "mean(ROW.x)"}],
                    "rows": [{"id": "p", "what": "w", "documentation": [)json" +
           figure + "]}]}]}";
  };
  EXPECT_EQ(check(study_schema(fields_of<StudyFile>()), {{true, study}, {false, no_pipelines}}),
            "");
  EXPECT_EQ(
      check(any_file_schema(made_up, fields_of<StudyFile>(), fields_of<PaperFile>()),
            {{true, study},
             {false, no_pipelines},
             {true, paper("4.5, \"1,231\", \"54/100\"")},
             {false, paper("true")},
             {true, R"({"altiplan": 1, "steps": [{"plan": "astar"}]})"},
             {false, R"({"altiplan": 1, "steps": [{"plan": "none"}]})"},
             {true, R"({"altiplan": 1, "start": {"at_m": [0, 0]}, "goal": {"at_m": [1, 1]}})"},
             {false, R"({"altiplan": 1, "start": {"at_m": [0, 0]}})"}}),
      "");
}

TEST_F(SchemaTest, OfThePluginsOfThisBuild) {
  Registry registry({altiplan::folders::build() / "lib/altiplan/plugins",
                     altiplan::folders::build() / "tests/broken_plugins"});
  const Choices choices = choices_of(registry);
  EXPECT_EQ(
      check(any_file_schema(choices, fields_of<StudyFile>(), fields_of<PaperFile>()),
            {{true, R"({"altiplan": 1, "steps": [{"plan": "alpha", "with": {"min_m": 2}}]})"},
             {false, R"({"altiplan": 1, "steps": [{"plan": "alpha", "with": {"min_m": 0}}]})"}}),
      "")
      << "a plugin's declaration is the schema";
}

TEST(Describe, TextJsonAndTable) {
  Registry registry({altiplan::folders::build() / "tests/broken_plugins"});
  const std::vector<Description> found = describe_plugin(registry, "alpha");
  ASSERT_EQ(found.size(), 1U);
  const std::string text = describe_text(found[0]);
  EXPECT_NE(text.find("planner alpha: finds no route"), std::string::npos) << text;
  EXPECT_NE(text.find("  min_m: number [m], ≥ 1, default 5\n      a distance"), std::string::npos)
      << text;
  const Json json = describe_json(found[0]);
  EXPECT_EQ(json["parameters"][0]["default"], 5);
  EXPECT_EQ(json["parameters"][0]["min"], 1);
  EXPECT_EQ(json["parameters"][0]["max"], nullptr);
  EXPECT_EQ(json["traits"]["complete"], false);
  EXPECT_EQ(parameter_table(found[0].parameters),
            "| key | type | unit | default | range | meaning |\n|---|---|---|---|---|---|\n"
            "| `min_m` | number | m | `5` | ≥ 1 | a distance |\n");
  EXPECT_EQ(parameter_table({}), "None.\n");
  EXPECT_THROW(describe_plugin(registry, "alhpa"), Error);
}

TEST(Plugins, EachLibraryIsTriedInAProcessOfItsOwn) {
  Registry registry({altiplan::folders::build() / "tests/broken_plugins"});
  const std::vector<Library> libraries = examine_all(registry);
  const std::string text = refused_text(libraries);
  const Json json = plugins_json(registry, libraries);
  std::size_t refused = 0;
  for (const Library& library : libraries) {
    const std::string name = library.file.stem().string();
    EXPECT_EQ(library.refused.empty(), name == "two_plugins") << name << ": " << library.refused;
    refused += library.refused.empty() ? 0 : 1;
    EXPECT_EQ(text.find("refused: " + library.file.string()) != std::string::npos,
              !library.refused.empty());
    if (name == "undefined_symbol") {
      EXPECT_NE(library.refused.find("missing_function_of_a_test"), std::string::npos);
    }
    if (name == "ends_the_process") {
      EXPECT_NE(library.refused.find("loading it ends the process: Aborted"), std::string::npos);
    }
  }
  EXPECT_EQ(libraries.size(), 5U);
  EXPECT_EQ(refused, 4U);
  EXPECT_EQ(json["libraries"].size(), 5U);
  EXPECT_NE(searched_text(registry).find("searched: "), std::string::npos);
  const std::vector<ListedPlugin> listed = listed_plugins(libraries);
  EXPECT_TRUE(std::any_of(listed.begin(), listed.end(), [](const ListedPlugin& plugin) {
    return plugin.kind == "planner" && plugin.name == "alpha";
  }));
}
}  // namespace
}  // namespace altiplan::host::schema_test
