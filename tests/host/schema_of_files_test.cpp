// SPDX-License-Identifier: Apache-2.0
// The schema of this build against files: those of configs/ fit, and what the reader refuses of
// them once they are spoiled, an independent validator refuses too.
#include <gtest/gtest.h>

#include <functional>

#include "altiplan/error.hpp"
#include "host/config/config.hpp"
#include "host/describe/schema.hpp"
#include "study/model/study_file.hpp"
#include "study/reproduce/paper_file.hpp"
#include "support/files.hpp"
#include "support/folders.hpp"
#include "support/support.hpp"

namespace altiplan::host::schema_of_files_test {
using namespace study;
namespace {
namespace fs = std::filesystem;
using altiplan::testing::configs;
using altiplan::testing::yaml_as_json;

const fs::path kPlugins = altiplan::folders::build() / "lib/altiplan/plugins";

class SchemaOfFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!altiplan::testing::has_schema_validator()) {
      GTEST_SKIP() << "no python3-jsonschema to validate with";
    }
    Registry registry({kPlugins});
    schema_ = any_file_schema(choices_of(registry), fields_of<StudyFile>(), fields_of<PaperFile>());
  }
  /// Whether the reader takes the document for a pipeline, or for a scenario.
  bool reads(const Json& document) const {
    const fs::path file = folder_.write("read.yaml", document.dump(1));
    Overrides overrides;
    overrides.plugin_path = {kPlugins};
    try {
      document.contains("steps") ? load_config(file, overrides) : load_scenario(file, overrides);
    } catch (const ConfigError&) {
      return false;
    }
    return true;
  }

  Json schema_;
  altiplan::testing::TempFolder folder_;
};

/// The two files of the first run, their paths absolute.
Json pipeline() {
  Json json = yaml_as_json(configs() / "pipelines/ridge_crossing.yaml");
  json["scenario"] = (configs() / "scenarios/jacksboro_ridge.yaml").string();
  return json;
}
Json scenario() {
  Json json = yaml_as_json(configs() / "scenarios/jacksboro_ridge.yaml");
  json["environment"][0]["terrain"]["file"] = (configs() / "data/jacksboro_fault.tif").string();
  json["moving"] = {
      {{"sphere", {{"at_m", {1, 2, 3}}, {"radius_m", 40.5}, {"velocity_mps", {1, 0, 0}}}},
       {"known", false}}};
  json["events"] = {{{"at_s", 200}, {"remove", "ridge_radar"}}};
  return json;
}

/// Calls `spoil` on a copy for every node of the document, with its place.
using Pointer = Json::json_pointer;
void for_each_node(const Json& node, const Pointer& at,
                   const std::function<void(const Pointer&, const Json&)>& call) {
  call(at, node);
  if (node.is_object()) {
    for (const auto& [key, value] : node.items()) {
      for_each_node(value, at / key, call);
    }
  } else if (node.is_array()) {
    for (std::size_t i = 0; i < node.size(); ++i) {
      for_each_node(node[i], at / i, call);
    }
  }
}

TEST_F(SchemaOfFiles, EveryFileOfConfigsFits) {
  std::vector<std::pair<bool, Json>> cases;
  for (const char* folder : {"pipelines", "scenarios", "studies", "papers"}) {
    for (const auto& entry : fs::directory_iterator(configs() / folder)) {
      cases.emplace_back(true, yaml_as_json(entry.path()));
    }
  }
  EXPECT_GE(cases.size(), 2U);
  EXPECT_EQ(altiplan::testing::schema_disagreement(schema_, cases), "");
}

TEST_F(SchemaOfFiles, NeitherTakesAnUnknownKeyOrAWrongType) {
  std::vector<std::pair<bool, Json>> cases;
  for (const Json& whole : {pipeline(), scenario()}) {
    ASSERT_TRUE(reads(whole));
    cases.emplace_back(true, whole);
    for_each_node(whole, Pointer(), [&](const Pointer& at, const Json& node) {
      const auto refuse = [&](const Json& instead) {
        Json spoiled = whole;
        spoiled[at] = instead;
        EXPECT_FALSE(reads(spoiled)) << at.to_string() << " = " << instead;
        cases.emplace_back(false, std::move(spoiled));
      };
      if (node.is_object()) {
        Json more = node;
        more["unheard_of"] = 1;
        refuse(more);
        if (!at.empty()) {
          refuse(Json::array({1}));
        }
      } else if (node.is_array()) {
        refuse("some words");
      } else {
        refuse(Json::object({{"a", 1}}));
        if (node.is_number() || node.is_boolean()) {
          refuse("some words");
        }
      }
    });
  }
  EXPECT_GT(cases.size(), 100U);
  EXPECT_EQ(altiplan::testing::schema_disagreement(schema_, cases), "");
}

TEST_F(SchemaOfFiles, NeitherTakesAValueOutOfRangeOrAMissingKey) {
  std::vector<std::pair<bool, Json>> cases;
  const auto spoil = [&](Json json, const std::string& at, const Json& value) {
    json[Pointer(at)] = value;
    EXPECT_FALSE(reads(json)) << at << " = " << value;
    cases.emplace_back(false, std::move(json));
  };
  const auto remove = [&](Json json, const std::string& from, const char* key) {
    json[Pointer(from)].erase(key);
    EXPECT_FALSE(reads(json)) << from << " without " << key;
    cases.emplace_back(false, std::move(json));
  };
  spoil(pipeline(), "/altiplan", 2);
  spoil(pipeline(), "/seed", -1);
  spoil(pipeline(), "/seed", 1.5);
  spoil(pipeline(), "/constraints/1/turn_angle/max_deg", 181);
  spoil(pipeline(), "/constraints/2/climb_angle/max_deg", -1);
  spoil(pipeline(), "/steps", Json::array());
  spoil(pipeline(), "/steps/0/plan", "nobody");
  spoil(pipeline(), "/steps/0/with/weight_g", 1.01);
  spoil(pipeline(), "/steps/0/with/cell_m", Json{250, 0, 50});
  spoil(pipeline(), "/steps/0/with/cell_m", Json{250, 50});
  spoil(pipeline(), "/steps/0/with/heuristic", "octal");
  spoil(pipeline(), "/steps/0/within_s", 0);
  spoil(scenario(), "/vehicle/radius_m", -1);
  spoil(scenario(), "/vehicle/speed_mps", 0);
  spoil(scenario(), "/goal/tolerance_m", -0.1);
  spoil(scenario(), "/environment/1/radar/range_m", 0);
  spoil(scenario(), "/moving/0/sphere/radius_m", 0);
  remove(pipeline(), "", "altiplan");
  remove(pipeline(), "", "steps");
  remove(scenario(), "", "start");
  remove(scenario(), "/goal", "at_m");
  remove(scenario(), "/environment/0/terrain", "file");
  remove(scenario(), "/moving/0/sphere", "velocity_mps");
  EXPECT_EQ(altiplan::testing::schema_disagreement(schema_, cases), "");
}
}  // namespace
}  // namespace altiplan::host::schema_of_files_test
