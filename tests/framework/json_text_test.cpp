// SPDX-License-Identifier: Apache-2.0
// The reader of JSON against nlohmann's: the same texts are refused, and the others have the same
// values.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "altiplan/error.hpp"
#include "altiplan/formats/geojson.hpp"
#include "support/files.hpp"

namespace altiplan::json_text_test {
namespace {

using Json = nlohmann::json;
using altiplan::testing::TempFolder;

constexpr const char* kBefore =
    R"({"type": "FeatureCollection", "features": [{"type": "Feature", "geometry": {"type":
"Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]}, "properties": {"v": )";
constexpr const char* kAfter = "}}]}";

struct Read {
  std::string value;    ///< of the property
  std::string problem;  ///< empty unless it is refused
};

Read by_us(const TempFolder& folder, const std::string& text) try {
  const auto json = formats::read_geojson(folder.write("a.geojson", text).string());
  const auto& properties = json.features.at(0).properties;
  const auto v = properties.find("v");
  return {v == properties.end() ? "none" : v->second, ""};
} catch (const Error& error) {
  return {"", error.what()};
}

void expect_same(const TempFolder& folder, const std::string& value, int& accepted) {
  const std::string text = kBefore + value + kAfter;
  const Read ours = by_us(folder, text);
  const Json theirs = Json::parse(text, nullptr, false);
  if (theirs.is_discarded()) {
    EXPECT_NE(ours.problem, "") << value;
  } else if (ours.problem.find("given twice") == std::string::npos) {
    EXPECT_EQ(ours.problem, "") << value;
    const Json& v = theirs["features"][0]["properties"].value("v", Json());
    EXPECT_EQ(ours.value,
              v.is_null() ? "none" : v.dump(-1, ' ', false, Json::error_handler_t::replace));
    ++accepted;
  }
}

TEST(JsonText, IsReadAsByTheLibrary) {
  const TempFolder folder;
  int accepted = 0;
  for (const char* value : {"0",
                            "-0",
                            "-0.0",
                            "1e5",
                            "1E+5",
                            "12.5e-3",
                            "18446744073709551615",
                            "18446744073709551616",
                            "-9223372036854775808",
                            "-9223372036854775809",
                            "1e-400",
                            "-4.9e-324",
                            "1.7976931348623157e308",
                            "0.1",
                            "123456789012345678901234567890.5",
                            "true",
                            "false",
                            "null",
                            "[]",
                            "{}",
                            "[[], {}]",
                            R"("\u00e9\n\"\\\/\ud834\udd1e")",
                            "\"\xc3\xa9\xf0\x9d\x84\x9e\x7f\"",
                            "\t[\r\n1 ,2 ] "}) {
    const int before = accepted;
    expect_same(folder, value, accepted);
    EXPECT_EQ(accepted, before + 1) << value;
  }
  const int valid = accepted;
  for (const char* value : {"",
                            "01",
                            "1.",
                            ".5",
                            "+1",
                            "-",
                            "1e",
                            "1e+",
                            "--1",
                            "0x1",
                            "NaN",
                            "1e400",
                            "-1e400",
                            "tru",
                            "nulL",
                            "[1,]",
                            "[,1]",
                            "[1 2]",
                            "[",
                            "]",
                            R"({"a": 1,})",
                            R"({"a" 1})",
                            "{a: 1}",
                            "{1: 1}",
                            "\"",
                            "\"a\nb\"",
                            R"("\x")",
                            R"("\u12")",
                            R"("\ud834")",
                            R"("\udd1e")",
                            "\"\xff\"",
                            "\"\xc0\x80\"",
                            "\"\xed\xa0\x80\"",
                            "\"\xf5\x80\x80\x80\"",
                            "\"\xe2\x82\"",
                            R"("\)",
                            "1 // one",
                            "\f1",
                            "1} 2"}) {
    expect_same(folder, value, accepted);
    EXPECT_EQ(accepted, valid) << value;
  }
}

TEST(JsonText, IsReadAsByTheLibraryWhenChanged) {
  const TempFolder folder;
  std::mt19937 rng(7);
  const auto below = [&](std::size_t n) { return std::size_t(rng() % n); };
  const std::string letters = "{}[]:,\"\\ \n0123456789.eE+-truefalsnu/b\xc3\xa9";
  int accepted = 0;
  constexpr int kTexts = 1000;
  for (int n = 0; n < kTexts; ++n) {
    std::string value =
        R"({"a": [1, -2.5e3, "x\u00e9\n", {"b": null}], "c": true, "\u00e9": 0.125})";
    for (std::size_t changes = 1 + below(4) / 3; changes > 0; --changes) {
      const std::size_t at = below(value.size());
      const std::size_t kind = below(3);
      value.replace(at, kind == 0 ? 0 : 1, kind == 1 ? 0 : 1, letters[below(letters.size())]);
    }
    expect_same(folder, value, accepted);
  }
  EXPECT_GT(accepted, kTexts / 10);
  EXPECT_LT(accepted, kTexts / 2);
}

TEST(JsonText, TellsTheLineAndColumnOfAnError) {
  const TempFolder folder;
  const auto problem = [&](const std::string& value) {
    return by_us(folder, kBefore + value + kAfter).problem;
  };
  EXPECT_NE(problem("[1,\n2,\n3,,\n4]").find(":4:3: is not valid JSON"), std::string::npos);
  EXPECT_NE(problem("\"a\n\"").find(":2:"), std::string::npos);
  EXPECT_NE(problem("[1e400]").find("too large"), std::string::npos);
  EXPECT_NE(problem("{\"a\": 1, \"a\": 2}").find("\"a\" is given twice"), std::string::npos);
}
}  // namespace
}  // namespace altiplan::json_text_test
