// SPDX-License-Identifier: Apache-2.0
// A scenario's `mission`: what it gives, what the scenario's own keys go before, what is wrong.
#include <fstream>

#include "files.hpp"
#include "host/describe/schema.hpp"
#include "host/result/result_json.hpp"
#include "support/files.hpp"

namespace altiplan::host::mission_key_test {
namespace {

using testing::Files;

constexpr const char* kWaypoints =
    "QGC WPL 110\n"
    "0\t1\t0\t16\t0\t0\t0\t0\t60\t25\t40\t1\n"
    "1\t0\t3\t22\t0\t0\t0\t0\t0\t0\t50\t1\n"
    "2\t0\t0\t16\t0\t15\t0\t0\t60.001\t25.002\t120\t1\n"
    "3\t0\t10\t16\t0\t0\t0\t0\t60.002\t25.003\t130\t1\n"
    "4\t0\t0\t16\t0\t0\t0\t0\t60.004\t25.004\t110\t1\n"
    "5\t0\t0\t21\t0\t0\t0\t0\t60.004\t25.004\t40\t1\n";

class MissionKey : public Files {
 protected:
  MissionKey() { write("m.waypoints", kWaypoints); }
  Config load(const std::string& ends) const {
    scenario("frame: {origin_lonlat: [25, 60]}\n", ends);
    return load_scenario(folder_ / "s.yaml", overrides_);
  }
  std::string problem(const std::string& ends) const {
    try {
      load(ends);
    } catch (const Error& error) {
      return without_folder(error.what());
    }
    return "";
  }
};

TEST_F(MissionKey, GivesStartViaPointsAndGoal) {
  const Config config = load("mission: m.waypoints\n");
  const ScenarioFile& file = config.scenario;
  EXPECT_EQ(file.start.point.form, Point::Form::lonlat);
  EXPECT_EQ(file.start.point.at, (std::array<double, 3>{25, 60, 90}));  // 50 m above home, at 40 m
  ASSERT_EQ(file.via.size(), 2U);
  EXPECT_EQ(file.via[0].point.at, (std::array<double, 3>{25.002, 60.001, 120}));
  EXPECT_EQ(file.via[0].tolerance_m, 15);  // the acceptance radius
  EXPECT_EQ(file.via[1].point.above_ground_m, 130);
  EXPECT_EQ(file.goal.point.at, (std::array<double, 3>{25.004, 60.004, 110}));  // not the landing
  ASSERT_EQ(config.files.size(), 2U);
  EXPECT_EQ(config.files[1], folder_ / "m.waypoints");
}

TEST_F(MissionKey, TheScenariosOwnKeysGoFirst) {
  const Config config =
      load("mission: m.waypoints\nstart: {at_m: [1, 2, 3]}\nvia: []\ngoal: {tolerance_m: 7}\n");
  EXPECT_EQ(config.scenario.start.point.form, Point::Form::metres);
  EXPECT_TRUE(config.scenario.via.empty());
  EXPECT_EQ(config.scenario.goal.tolerance_m, 7);
  EXPECT_EQ(config.scenario.goal.point.at[0], 25.004);
  EXPECT_EQ(load("mission: m.waypoints\ngoal: {at_m: [9, 9, 9]}\n").scenario.goal.point.at[0], 9);
}

TEST_F(MissionKey, CanBeGivenOnTheCommandLine) {
  scenario("frame: {origin_lonlat: [25, 60]}\n", "start: {at_m: [0, 0, 0]}\n");
  Overrides overrides = overrides_;
  overrides.set = {"scenario.mission=m.waypoints"};
  const Config config = load_scenario(folder_ / "s.yaml", overrides);
  EXPECT_EQ(config.scenario.goal.point.at[0], 25.004);
}

TEST_F(MissionKey, ExplainSaysWhichItemAValueCameFrom) {
  scenario("frame: {origin_lonlat: [25, 60]}\n", "mission: m.waypoints\n");
  const Config config = load_config(pipeline("steps:\n  - plan: told\n"), overrides_);
  std::string start;
  std::string via;
  for (const Explained& entry : explain(config)) {
    start = entry.key == "scenario.start" ? entry.from : start;
    via = entry.key == "scenario.via.1.at" ? entry.from : via;
  }
  EXPECT_EQ(without_folder(start), "m.waypoints: line 3");
  EXPECT_EQ(without_folder(via), "m.waypoints: line 5");
}

TEST_F(MissionKey, WrongFilesAreErrorsAtTheKey) {
  write("zones.plan", "{}");
  write("one.waypoints",
        "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t60\t25\t40\t1\n"
        "1\t0\t0\t16\t0\t0\t0\t0\t60.1\t25\t40\t1\n");
  write("homeless.waypoints",
        "QGC WPL 110\n0\t1\t3\t16\t0\t0\t0\t0\t60\t25\t40\t1\n"
        "1\t0\t3\t16\t0\t0\t0\t0\t60.1\t25\t40\t1\n");
  write("flat.kml",
        "<kml><Placemark><LineString><coordinates>25,60 26,61</coordinates></LineString>"
        "</Placemark></kml>");
  EXPECT_HAS(problem("mission: none.plan\n"), "s.yaml:3:10: mission: file not found: 'none.plan'");
  EXPECT_HAS(problem("mission: zones.plan\n"), "s.yaml:3:10: mission: zones.plan: expected a plan");
  EXPECT_HAS(problem("mission: one.waypoints\n"), "expected at least two points, found 1");
  EXPECT_HAS(problem("mission: homeless.waypoints\n"),
             "line 2: its altitude is relative to home, and the file has no home position");
  EXPECT_HAS(problem("mission: flat.kml\n"), "flat.kml: a route needs heights");
  EXPECT_HAS(problem("mission: [1]\n"), "mission: expected text");
  EXPECT_HAS(problem("mission: ''\n"), "mission: expected the path of a file, found nothing");
  EXPECT_HAS(problem("mission: .\n"), "is a folder");
  EXPECT_HAS(problem("start: {at_m: [1, 2, 3]}\n"), "the key 'goal' is missing");
  EXPECT_HAS(problem("start: {at_m: [1, 2, 3]}\ngoal: {tolerance_m: 3}\n"), "goal: ");
}

TEST_F(MissionKey, TheSchemaTakesAMissionInPlaceOfTheEnds) {
  if (!altiplan::testing::has_schema_validator()) {
    GTEST_SKIP() << "no python3-jsonschema to validate with";
  }
  const Json schema = scenario_schema([](std::string_view) { return std::vector<Choice>{}; });
  const Json start{{"at_m", {0, 0, 0}}};
  const Json tolerance{{"tolerance_m", 3}};
  const std::vector<std::pair<bool, Json>> cases{
      {true, {{"altiplan", 1}, {"mission", "a.plan"}}},
      {true, {{"altiplan", 1}, {"mission", "a.plan"}, {"goal", tolerance}}},
      {true, {{"altiplan", 1}, {"start", start}, {"goal", start}}},
      {false, {{"altiplan", 1}, {"start", start}, {"goal", tolerance}}},
      {false, {{"altiplan", 1}, {"start", start}}},
      {false, {{"altiplan", 1}, {"mission", 3}}}};
  EXPECT_EQ(altiplan::testing::schema_disagreement(schema, cases), "");
}
}  // namespace
}  // namespace altiplan::host::mission_key_test
