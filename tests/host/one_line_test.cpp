// SPDX-License-Identifier: Apache-2.0
// One line more in a plugin changes schema, reference, validation and --set.
#include <gtest/gtest.h>

#include "altiplan/error.hpp"
#include "host/describe/describe.hpp"
#include "host/describe/schema.hpp"
#include "study/model/study_file.hpp"
#include "study/reproduce/paper_file.hpp"
#include "support/files.hpp"
#include "support/folders.hpp"

namespace altiplan::host::one_line_test {
using namespace study;
namespace {
namespace fs = std::filesystem;

const fs::path kLibraries = altiplan::folders::build() / "tests/one_line";

struct OneLine : ::testing::TestWithParam<bool> {
  fs::path library() const { return kLibraries / (GetParam() ? "with" : "without"); }

  fs::path pipeline(const std::string& parameters) const {
    folder.write("scenario.yaml",
                 "altiplan: 1\nvolume: {min_m: [0, 0, 0], max_m: [9, 9, 9]}\n"
                 "start: {at_m: [1, 1, 1]}\ngoal: {at_m: [8, 8, 8]}\n");
    return folder.write(
        "pipeline.yaml",
        "altiplan: 1\nscenario: scenario.yaml\nsteps:\n  - plan: one_line\n" + parameters);
  }
  Overrides overrides(std::vector<std::string> set = {}) const {
    Overrides all;
    all.plugin_path = {library()};
    all.set = std::move(set);
    return all;
  }
  /// What is wrong with the pipeline; "" where nothing is.
  std::string problems(const std::string& parameters) const {
    try {
      load_config(pipeline(parameters), overrides());
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }

  altiplan::testing::TempFolder folder;
};

TEST_P(OneLine, SchemaAndReference) {
  Registry registry({library()});
  const Json schema =
      any_file_schema(choices_of(registry), fields_of<StudyFile>(), fields_of<PaperFile>());
  const Json& properties = schema["definitions"]["planner_one_line"]["properties"];
  ASSERT_TRUE(properties.contains("first_m")) << schema["definitions"];
  ASSERT_EQ(properties.contains("extra_m"), GetParam());
  const Description description = describe_plugin(registry, "one_line").at(0);
  const std::string row = "| `extra_m` | number | m | `3` | 1 … 9 | another distance |\n";
  EXPECT_EQ(parameter_table(description.parameters).find(row) != std::string::npos, GetParam());
  EXPECT_EQ(
      describe_text(description).find("extra_m: number [m], 1 … 9, default 3") != std::string::npos,
      GetParam());
  if (GetParam()) {
    EXPECT_EQ(properties["extra_m"]["minimum"], 1);
    EXPECT_EQ(properties["extra_m"]["maximum"], 9);
    EXPECT_EQ(properties["extra_m"]["default"], 3);
  }
}

TEST_P(OneLine, Validation) {
  EXPECT_EQ(problems("    with: {first_m: 2}\n"), "");
  EXPECT_EQ(problems("    with: {extra_m: 4}\n") == "", GetParam());
  const std::string refused = problems("    with: {extra_m: 10}\n");
  EXPECT_NE(refused.find("steps.0.with.extra_m: "), std::string::npos) << refused;
  EXPECT_EQ(refused.find("unknown") == std::string::npos, GetParam()) << refused;
}

TEST_P(OneLine, Set) {
  const fs::path file = pipeline("");
  const std::string assignment = "steps.0.with.extra_m=7";
  if (!GetParam()) {
    EXPECT_THROW(load_config(file, overrides({assignment})), ConfigError);
    return;
  }
  EXPECT_THROW(load_config(file, overrides({"steps.0.with.extra_m=0"})), ConfigError);
  const auto ran = altiplan::testing::run_file(file, overrides({assignment}));
  EXPECT_EQ(ran.json["steps"][0]["counters"]["extra"], 7);
  EXPECT_EQ(altiplan::testing::run_file(file, overrides()).json["steps"][0]["counters"]["extra"],
            3);
  bool explained = false;
  for (const Explained& entry : explain(load_config(file, overrides({assignment})))) {
    explained = explained || (entry.key == "steps.0.with.extra_m" && entry.value_json == "7" &&
                              entry.from == "--set " + assignment && entry.unit == "m");
  }
  EXPECT_TRUE(explained);
}

INSTANTIATE_TEST_SUITE_P(Built, OneLine, ::testing::Bool(), [](const auto& instance) {
  return instance.param ? "with_the_line" : "without_it";
});
}  // namespace
}  // namespace altiplan::host::one_line_test
