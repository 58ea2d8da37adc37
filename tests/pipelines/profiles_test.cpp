// SPDX-License-Identifier: Apache-2.0
// What the page and the picture plot is what the judge measured: the least of a profile is the
// metric, on every file of configs/pipelines, on routes and flights.
#include <gtest/gtest.h>

#include <algorithm>

#include "host/view/scene.hpp"
#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::profiles_test {
namespace {
namespace fs = std::filesystem;
using host::Json;

constexpr double kCentimetre = 0.01;

std::vector<fs::path> pipelines() {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(testing::configs() / "pipelines")) {
    files.push_back(entry.path());
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

class Profiles : public ::testing::TestWithParam<fs::path> {};

TEST_P(Profiles, AreLeastWhereTheJudgeMeasured) {
  const Json result = testing::run_file(GetParam()).json;
  if (result.at("status") != "solved") {
    GTEST_SKIP() << "shows a refusal: there is no route";
  }
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

INSTANTIATE_TEST_SUITE_P(Configs, Profiles, ::testing::ValuesIn(pipelines()),
                         [](const auto& instance) { return instance.param.stem().string(); });
}  // namespace
}  // namespace altiplan::profiles_test
