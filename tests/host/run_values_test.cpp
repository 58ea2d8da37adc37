// SPDX-License-Identifier: Apache-2.0
#include "study/model/run_values.hpp"

#include <gtest/gtest.h>

#include <map>

namespace altiplan::host::run_values_test {
using namespace study;
namespace {

std::map<std::string, double> values_of_flight(const std::string& replans) {
  Json result = Json::parse(R"({"metrics": {"length_m": 5}, "setup_time_s": 0.5, "steps": []})");
  result["flight"] = Json::parse(R"({"collisions": 0, "min_separation_m": null, "reached": true,
    "cross_track_p999_m": 1.5, "height_error_max_m": null, "handovers": [], "counters": {"steps": 7}, "metrics": {"length_m": 6}})");
  result["flight"]["replans"] = Json::parse(replans);
  const auto values = values_of(result);
  return {values.begin(), values.end()};
}

TEST(RunValues, ReplansAreSummedUp) {
  const auto values = values_of_flight(R"([
    {"at_s": 1, "time_s": 0.25, "counters": {"expanded": 3, "nodes_kept": 10}},
    {"at_s": 9, "time_s": 0.5, "counters": {"expanded": 4}}])");
  EXPECT_EQ(values.at("flight.replans"), 2);
  EXPECT_EQ(values.at("flight.replan_time_s"), 0.75);
  EXPECT_EQ(values.at("flight.replan_counters.expanded"), 7);
  EXPECT_EQ(values.at("flight.replan_counters.nodes_kept"), 10);
}

TEST(RunValues, WithoutReplansTheirSumsHaveNoValue) {
  const std::map<std::string, double> expected = {
      {"length_m", 5},        {"setup_time_s", 0.5},        {"flight.collisions", 0},
      {"flight.reached", 1},  {"flight.handovers", 0},      {"flight.replans", 0},
      {"flight.length_m", 6}, {"flight.counters.steps", 7}, {"flight.cross_track_p999_m", 1.5},
  };
  EXPECT_EQ(values_of_flight("[]"), expected);
}

TEST(RunValues, TheGapIsAShareOfTheBound) {
  Json result =
      Json::parse(R"({"metrics": {}, "setup_time_s": 0, "flight": null, "cost": 105, "bound": 100,
    "steps": [{"id": "plan", "time_s": 0, "setup_time_s": 0, "accepted": true, "budget_hit": false,
               "counters": {}, "metrics": {}, "cost": 110, "bound": 100},
              {"id": "none", "time_s": 0, "setup_time_s": 0, "accepted": false, "budget_hit": false,
               "counters": {}, "metrics": {}, "cost": null, "bound": 0}]})");
  const auto values = values_of(result);
  const std::map<std::string, double> of{values.begin(), values.end()};
  EXPECT_DOUBLE_EQ(of.at("gap"), 0.05);
  EXPECT_DOUBLE_EQ(of.at("steps.plan.gap"), 0.1);
  EXPECT_EQ(of.at("steps.plan.cost"), 110);
  EXPECT_FALSE(of.contains("steps.none.cost"));
  EXPECT_FALSE(of.contains("steps.none.gap"));
  EXPECT_EQ(why_no_value("gap"), "");
  EXPECT_EQ(why_no_value("steps.plan.gap"), "");
}

TEST(RunValues, ATaskHasABoundAndFlights) {
  const auto values = values_of(Json::parse(
      R"({"metrics": {}, "setup_time_s": 0, "flight": null, "steps": [],
          "task": {"plugin": "cover", "passes": 9, "flights": [60, 70], "time_s": 130, "bound_s": 99}})"));
  const std::map<std::string, double> of{values.begin(), values.end()};
  EXPECT_EQ(of.at("task.bound_s"), 99);
  EXPECT_EQ(of.at("task.flights"), 2);
  EXPECT_EQ(why_no_value("task.bound_s"), "");
  EXPECT_EQ(why_no_value("task.flights"), "");
  EXPECT_NE(why_no_value("task.passes"), "");
}

TEST(RunValues, NamesOfReplansAreKnown) {
  EXPECT_EQ(why_no_value("flight.replan_time_s"), "");
  EXPECT_EQ(why_no_value("flight.replan_counters.nodes_added"), "");
  EXPECT_EQ(why_no_value("flight.cross_track_max_m"), "");
  EXPECT_EQ(why_no_value("flight.replan_times"),
            "no run has a value 'flight.replan_times'; did you mean 'flight.replan_time_s'?");
  EXPECT_EQ(
      why_no_value("replan_counters.expanded"),
      "no run has a value 'replan_counters.expanded': expected a value of the run, or flight.…, "
      "flight.counters.…, flight.replan_counters.…, steps.ID.…, steps.ID.counters.…");
}

TEST(RunValues, PartsThatNoPipelineHas) {
  const PipelineParts astar{"astar", {"route", "hermite"}, false, true};
  const PipelineParts theta{"theta", {"theta_star", "pilot.2"}, true, true};
  const PipelineParts unknown{"lost", {}, false, false};
  for (const char* name : {"length_m", "steps.route.length_m", "steps.pilot.2.counters.x",
                           "flight.length_m", "task.flights"}) {
    EXPECT_EQ(why_no_part(name, {astar, theta}), "") << name;
    EXPECT_EQ(why_no_part(name, {astar, unknown}), "") << name;
  }
  EXPECT_EQ(why_no_part("steps.rute.length_m", {astar, theta}),
            "no run has a value 'steps.rute.length_m': no pipeline has a step 'rute'; did you mean "
            "'steps.route.length_m'?");
  EXPECT_EQ(why_no_part("steps.route.counters.n", {theta}),
            "no run of 'theta' has a value 'steps.route.counters.n': it has no step 'route', only "
            "pilot.2, theta_star");
  EXPECT_EQ(why_no_part("flight.length_m", {astar}),
            "no run of 'astar' has a value 'flight.length_m': it has no fly step");
}
}  // namespace
}  // namespace altiplan::host::run_values_test
