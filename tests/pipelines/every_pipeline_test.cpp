// SPDX-License-Identifier: Apache-2.0
// Every file of configs/pipelines loads, runs and is solved, or refused if it shows that; and what
// the page and the picture plot is what the judge measured: the least of a profile is the metric,
// on routes and flights. Those that take seconds run at night.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "host/view/scene.hpp"
#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::every_pipeline_test {
namespace {
namespace fs = std::filesystem;
using host::Json;

constexpr double kCentimetre = 0.01;
// Others by day have their planners; tests of exposure see what unseen minimises.
const std::set<std::string> kLong = {"ant_colony_reference", "nmopso", "spso", "unseen",
                                     "wing_ridge_star"};

std::vector<fs::path> pipelines(bool are_long) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(testing::configs() / "pipelines")) {
    if ((kLong.count(entry.path().stem()) > 0) == are_long) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

double least(const Json& values) {
  double least = kInfinity;
  for (const Json& value : values) {
    least = value.is_null() ? least : std::min(least, value.get<double>());
  }
  return least;
}

double lowest(const Json& profile) {
  double least = kInfinity;
  for (std::size_t i = 0; i < profile.at("ground").size(); ++i) {
    if (const Json& ground = profile.at("ground")[i]; !ground.is_null()) {
      least = std::min(least, profile.at("altitude")[i].get<double>() - ground.get<double>());
    }
  }
  return least;
}

double number(const Json& metric) { return metric.is_null() ? kInfinity : metric.get<double>(); }

void expect_same(double plotted, double measured) {
  if (measured == kInfinity) {
    EXPECT_EQ(plotted, kInfinity);
  } else {
    EXPECT_NEAR(plotted, measured, kCentimetre);
  }
}

void expect_profiles_are_least_where_the_judge_measured(const Json& result) {
  const Json scene = host::build_scene({host::stored_result("run", result, {})}).json;
  const Json& shown = scene.at("results").at(0);
  const Json& profile = shown.at("profile");
  const Json& route = result.at("metrics");
  {
    SCOPED_TRACE("the route");
    expect_same(least(profile.at("clearance")), number(route.at("min_clearance_m")));
    expect_same(lowest(profile), number(route.at("min_ground_clearance_m")));
    double of_all = kInfinity;
    for (const Json& clearances : profile.at("to")) {
      of_all = std::min(of_all, least(clearances));
    }
    EXPECT_EQ(of_all, least(profile.at("clearance")));
  }
  if (const Json& flight = result.at("flight"); !flight.is_null()) {
    SCOPED_TRACE("the flight");
    const Json& flown = shown.at("flight").at("profile");
    expect_same(least(flown.at("clearance")), number(flight.at("min_separation_m")));
    expect_same(lowest(flown), number(flight.at("metrics").at("min_ground_clearance_m")));
  }
}

void expect_solved(const fs::path& pipeline) {
  ASSERT_EQ(pipeline.extension(), ".yaml");
  const testing::Ran ran = testing::run_file(pipeline);
  const Json& result = ran.json;
  if (pipeline.stem() == "letterbox_sphere") {  // which shows a refusal
    EXPECT_EQ(ran.exit_code, 1);
    EXPECT_EQ(result["status"], "no_route");
    return;
  }
  EXPECT_EQ(ran.exit_code, 0);
  ASSERT_EQ(result["status"], "solved") << result["message"];
  EXPECT_TRUE(result["check"]["ok"]);
  if (!result["flight"].is_null()) {
    EXPECT_TRUE(result["flight"]["reached"]);
    EXPECT_EQ(result["flight"]["collisions"], 0);
    EXPECT_TRUE(result["flight"]["check"]["ok"]);
  }
  expect_profiles_are_least_where_the_judge_measured(result);
}

std::string name_of(const ::testing::TestParamInfo<fs::path>& instance) {
  return instance.param.stem().string();
}

class EveryPipeline : public ::testing::TestWithParam<fs::path> {};
class NightlyLongPipeline : public EveryPipeline {};

TEST_P(EveryPipeline, IsSolvedAndShownAsMeasured) { expect_solved(GetParam()); }
TEST_P(NightlyLongPipeline, IsSolvedAndShownAsMeasured) { expect_solved(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Configs, EveryPipeline, ::testing::ValuesIn(pipelines(false)), name_of);
INSTANTIATE_TEST_SUITE_P(Configs, NightlyLongPipeline, ::testing::ValuesIn(pipelines(true)),
                         name_of);
}  // namespace
}  // namespace altiplan::every_pipeline_test
