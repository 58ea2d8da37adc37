// SPDX-License-Identifier: Apache-2.0
#include "host/result/result_json.hpp"

#include <gtest/gtest.h>

namespace altiplan::host::result_json_test {
namespace {

TEST(ResultJson, BytesOfAPluginThatAreNoTextDoNotLoseTheResult) {
  const std::string text =
      file_text({{"status", "failed"}, {"message", "torn \xF1 map, 5 \xC2\xB0"}});
  EXPECT_EQ(text.back(), '\n');
  const Json read = Json::parse(text);
  EXPECT_EQ(read["status"], "failed");
  EXPECT_EQ(read["message"], "torn \xEF\xBF\xBD map, 5 \xC2\xB0");
}
}  // namespace
}  // namespace altiplan::host::result_json_test
