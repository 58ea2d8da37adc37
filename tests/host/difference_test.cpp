// SPDX-License-Identifier: Apache-2.0
#include "host/result/difference.hpp"

#include <gtest/gtest.h>

namespace altiplan::host::difference_test {
namespace {

std::string difference(const char* first, const char* second) {
  const auto found = first_difference(Json::parse(first), Json::parse(second));
  return found ? found->path + ": " + found->first + " / " + found->second : "";
}

TEST(Difference, is_found_where_it_begins) {
  EXPECT_EQ(difference(R"({"a": 1, "b": [1, {"c": "x"}]})", R"({"a": 1, "b": [1, {"c": "y"}]})"),
            R"(b.1.c: "x" / "y")");
  EXPECT_EQ(difference(R"({"a": [1, 2]})", R"({"a": [1, 2, 3]})"), "a.2: nothing / 3");
  EXPECT_EQ(difference(R"({"a": [1, 2]})", R"({"a": [1]})"), "a.1: 2 / nothing");
  EXPECT_EQ(difference(R"({"a": 1})", R"({"a": 1, "b": null})"), "b: nothing / null");
  EXPECT_EQ(difference(R"({"a": 1, "b": 2})", R"({"a": 1})"), "b: 2 / nothing");
  EXPECT_EQ(difference(R"({"a": {}})", R"({"a": []})"), "a: {} / []");
}

TEST(Difference, counts_the_last_bit_and_the_sign_of_zero) {
  EXPECT_EQ(difference("[0.1]", "[0.1]"), "");
  EXPECT_EQ(difference("[0.1]", "[0.10000000000000002]"), "0: 0.1 / 0.10000000000000002");
  EXPECT_EQ(difference("[0.0]", "[-0.0]"), "0: 0.0 / -0.0");
}

TEST(Difference, does_not_count_times_and_the_name_of_the_trace) {
  EXPECT_EQ(difference(R"({"time_s": 1, "steps": [{"setup_time_s": 2}], "trace": "a"})",
                       R"({"time_s": 2, "steps": [{}], "trace": null})"),
            "");
  EXPECT_EQ(difference(R"({"steps": [{"trace": 1}]})", R"({"steps": [{"trace": 2}]})"),
            "steps.0.trace: 1 / 2");
  EXPECT_EQ(difference(R"({"duration_s": 1})", R"({"duration_s": 2})"), "duration_s: 1 / 2");
}

TEST(Difference, of_texts_that_are_no_json_is_that_of_the_texts) {
  EXPECT_FALSE(first_difference(std::string("x{"), std::string("x{")));
  EXPECT_EQ(first_difference(std::string("x{"), std::string("{}"))->first, "'x{'");
  EXPECT_TRUE(first_difference(std::string(), std::string("{}")));
}

TEST(Difference, is_shown_in_a_line) {
  const std::string lengthy = R"({"a": ")" + std::string(500, 'x') + R"("})";
  const std::string text = difference(R"({"a": 1})", lengthy.c_str());
  EXPECT_LT(text.size(), 120);
}
}  // namespace
}  // namespace altiplan::host::difference_test
