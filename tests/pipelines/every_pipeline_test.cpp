// SPDX-License-Identifier: Apache-2.0
// Every file of configs/pipelines loads, runs and is solved, or refused if it shows that.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::every_pipeline_test {
namespace {
namespace fs = std::filesystem;

std::vector<fs::path> pipelines() {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(testing::configs() / "pipelines")) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class EveryPipeline : public ::testing::TestWithParam<fs::path> {};

TEST_P(EveryPipeline, IsSolved) {
  ASSERT_EQ(GetParam().extension(), ".yaml");
  const testing::Ran ran = testing::run_file(GetParam());
  const host::Json& result = ran.json;
  if (GetParam().stem() == "letterbox_sphere") {  // which shows a refusal
    EXPECT_EQ(ran.exit_code, 1);
    EXPECT_EQ(result["status"], "no_route");
    return;
  }
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(result["status"], "solved") << result["message"];
  EXPECT_TRUE(result["check"]["ok"]);
  if (!result["flight"].is_null()) {
    EXPECT_TRUE(result["flight"]["reached"]);
    EXPECT_EQ(result["flight"]["collisions"], 0);
    EXPECT_TRUE(result["flight"]["check"]["ok"]);
  }
}

INSTANTIATE_TEST_SUITE_P(Configs, EveryPipeline, ::testing::ValuesIn(pipelines()),
                         [](const auto& instance) { return instance.param.stem().string(); });
}  // namespace
}  // namespace altiplan::every_pipeline_test
