// SPDX-License-Identifier: Apache-2.0
// The first pipeline of the README, end to end: what it gives, and what becomes of it without the
// unknown obstacle, and without a pilot.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::ridge_crossing_test {
namespace {

using host::Json;
using testing::Ran;
using testing::run_file;
using testing::text_of;

const std::filesystem::path kPipeline = testing::configs() / "pipelines/ridge_crossing.yaml";
const std::filesystem::path kScenario = testing::configs() / "scenarios/jacksboro_ridge.yaml";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) {
    text += line + "\n";
  }
  return text;
}

/// End of the list item that begins at `first`: its lines are indented deeper than its dash.
std::size_t end_of_item(const std::vector<std::string>& lines, std::size_t first) {
  const std::size_t dash = lines[first].find('-');
  std::size_t end = first + 1;
  while (end < lines.size() && lines[end].find_first_not_of(' ') != std::string::npos &&
         lines[end].find_first_not_of(' ') > dash) {
    ++end;
  }
  return end;
}

/// The scenario without the layers that are not known, its files named absolutely.
std::string all_known() {
  std::vector<std::string> lines = lines_of(
      testing::replaced(text_of(kScenario), "../data", (testing::configs() / "data").string()));
  std::size_t removed = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].starts_with("  - ")) {
      const std::size_t end = end_of_item(lines, i);
      const bool hidden =
          std::any_of(lines.begin() + std::ptrdiff_t(i), lines.begin() + std::ptrdiff_t(end),
                      [](const std::string& line) { return line.starts_with("    known: false"); });
      if (hidden) {
        lines.erase(lines.begin() + std::ptrdiff_t(i), lines.begin() + std::ptrdiff_t(end));
        ++removed;
        --i;
      }
    }
  }
  EXPECT_GE(removed, 1U) << "the scenario has something that planners do not know";
  return joined(lines);
}

/// The pipeline with the route followed alone.
std::string without_pilot() {
  std::vector<std::string> lines = lines_of(testing::replaced(
      text_of(kPipeline), "../scenarios/jacksboro_ridge.yaml", kScenario.string()));
  const auto fly = std::find_if(lines.begin(), lines.end(), [](const std::string& line) {
    return line.starts_with("  - fly: apf");
  });
  EXPECT_NE(fly, lines.end());
  const std::size_t at = std::size_t(fly - lines.begin());
  lines.erase(fly + 1, lines.begin() + std::ptrdiff_t(end_of_item(lines, at)));
  lines[at] = "  - fly: route";
  return joined(lines);
}

std::size_t handovers_to(const Json& result, const std::string& whom) {
  const Json& all = result.at("flight").at("handovers");
  return std::size_t(
      std::count_if(all.begin(), all.end(), [&](const Json& one) { return one.at("to") == whom; }));
}

/// The result without its wall times.
Json timeless(const Json& json) {
  if (json.is_object()) {
    Json kept = Json::object();
    for (const auto& [key, value] : json.items()) {
      if (!key.ends_with("time_s")) {
        kept[key] = timeless(value);
      }
    }
    return kept;
  }
  if (json.is_array()) {
    Json kept = Json::array();
    for (const Json& value : json) {
      kept.push_back(timeless(value));
    }
    return kept;
  }
  return json;
}

TEST(RidgeCrossing, AJudgedRouteAndAFlightAroundWhatWasNotKnown) {
  const Ran ran = run_file(kPipeline);
  const Json& result = ran.json;
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(result["status"], "solved") << result["message"];
  EXPECT_EQ(result["steps"][0]["plugin"], "astar");
  EXPECT_GT(result["steps"][0]["counters"]["expanded"], 0);
  for (const Json& step : result["steps"]) {
    EXPECT_TRUE(step["accepted"]) << step["id"] << step["message"];
  }
  EXPECT_TRUE(result["check"]["ok"]);
  EXPECT_GE(result["metrics"]["length_m"], 25e3);
  EXPECT_EQ(result["route"].size(), result["route_lonlat"].size());
  const Json& flight = result["flight"];
  EXPECT_TRUE(flight["reached"]);
  EXPECT_TRUE(flight["check"]["ok"]);
  EXPECT_EQ(flight["collisions"], 0);
  EXPECT_GE(handovers_to(result, "apf"), 1U);
  EXPECT_GE(handovers_to(result, "route"), 1U);
}

TEST(RidgeCrossing, NoHandoverWhereAllIsKnown) {
  const testing::TempFolder folder;
  host::Overrides overrides;
  overrides.scenario = folder.write("all_known.yaml", all_known());
  const Ran ran = run_file(kPipeline, overrides);
  EXPECT_EQ(ran.exit_code, 0) << ran.json["message"];
  EXPECT_TRUE(ran.json["flight"]["reached"]);
  EXPECT_EQ(ran.json["flight"]["handovers"], Json::array());
}

TEST(RidgeCrossing, TheRouteAloneCollides) {
  const testing::TempFolder folder;
  const Ran ran = run_file(folder.write("alone.yaml", without_pilot()));
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_EQ(ran.json["status"], "collided");
  EXPECT_TRUE(ran.json["check"]["ok"]) << "the route stands in the world that was known";
  EXPECT_EQ(ran.json["flight"]["status"], "collided");
  EXPECT_GE(ran.json["flight"]["collisions"], 1);
  EXPECT_FALSE(ran.json["flight"]["reached"]);
  EXPECT_FALSE(ran.json["flight"]["check"]["ok"]);
}

TEST(RidgeCrossing, OneSeedGivesOneResult) {
  const std::string first = timeless(run_file(kPipeline).json).dump(1);
  EXPECT_EQ(first.find("time_s\""), std::string::npos);
  for (int repetition = 0; repetition < 10; ++repetition) {
    for (const int threads : {1, 2}) {
      ASSERT_EQ(timeless(run_file(kPipeline, {}, threads).json).dump(1), first)
          << "repetition " << repetition << ", threads " << threads;
    }
  }
}
}  // namespace
}  // namespace altiplan::ridge_crossing_test
