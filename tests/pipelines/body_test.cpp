// SPDX-License-Identifier: Apache-2.0
// Bodies where their spheres do not fit, from the scenario to the result.
#include <gtest/gtest.h>

#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::body_test {
namespace {
namespace fs = std::filesystem;

/// Runs a planner on a scenario, a shipped one or a variant of it.
std::string status_of(const std::string& planner, const std::string& scenario) {
  const testing::TempFolder folder;
  folder.write("scenario.yaml", scenario);
  const fs::path pipeline =
      folder.write("pipeline.yaml",
                   "altiplan: 1\nname: body\nscenario: scenario.yaml\nsteps:\n"
                   "  - {plan: " +
                       planner + "}\n");
  return testing::run_file(pipeline).json["status"];
}

std::string shipped(const std::string& scenario) {
  return testing::text_of(testing::configs() / "scenarios" / scenario);
}

/// The scenario with a sphere in place of the body.
std::string with_sphere(const std::string& scenario, const std::string& radius_m) {
  const std::size_t body = scenario.find("  body:");
  const std::size_t end = scenario.find("start:");
  return scenario.substr(0, body) + "  radius_m: " + radius_m + "\n" + scenario.substr(end);
}

const char* const kAstar = "astar, with: {cell_m: [1, 1, 0.5], moves: exact}";
const char* const kRrtStar = "rrt_star, with: {max_iterations: 100000}";
const char* const kShortRrtStar = "rrt_star, with: {max_iterations: 20000}";

TEST(Letterbox, ShippedPipelines) {
  const fs::path pipelines = testing::configs() / "pipelines";
  EXPECT_EQ(testing::run_file(pipelines / "letterbox.yaml").json["status"], "solved");
  EXPECT_EQ(testing::run_file(pipelines / "letterbox_sphere.yaml").json["status"], "no_route");
  EXPECT_EQ(testing::run_file(pipelines / "slung_load.yaml").json["status"], "solved");
}

TEST(Letterbox, AStarAndRrtStarPassWithTheWingAndNotWithItsSphere) {
  const std::string wing = shipped("letterbox.yaml");
  EXPECT_EQ(status_of(kAstar, wing), "solved");
  EXPECT_EQ(status_of(kRrtStar, wing), "solved");
  EXPECT_EQ(status_of(kAstar, with_sphere(wing, "1.594")), "no_route");
  EXPECT_EQ(status_of(kShortRrtStar, with_sphere(wing, "1.594")), "no_route");
}

TEST(Letterbox, OnEdgeItIsRefused) {
  std::string on_edge = shipped("letterbox.yaml");
  for (const auto& [from, to] :
       std::vector<std::pair<const char*, const char*>>{{"50.5, -2.5, 30", "50.5, -0.5, 30"},
                                                        {"[50, 2.5, 0]", "[50, 0.5, 0]"},
                                                        {"[50.5, 2.5, 12]", "[50.5, 2.5, 10]"},
                                                        {"[50, -2.5, 13]", "[50, -2.5, 15]"}}) {
    on_edge = testing::replaced(on_edge, from, to);
  }
  EXPECT_EQ(status_of(kAstar, on_edge), "no_route");
  EXPECT_EQ(status_of(kShortRrtStar, on_edge), "no_route");
  const std::string upright = testing::replaced(on_edge, "[1, 3, 0.4]", "[1, 0.4, 3]");
  EXPECT_EQ(status_of(kAstar, upright), "solved");
}

TEST(SlungLoad, PassesBelowTheBridgeUnlessItsLineIsTooLong) {
  const std::string load = shipped("slung_load.yaml");
  EXPECT_EQ(status_of(kAstar, load), "solved");
  EXPECT_EQ(status_of(kRrtStar, load), "solved");
  EXPECT_EQ(status_of(kAstar, testing::replaced(load, "-3.2]", "-4.2]")), "no_route");
  EXPECT_EQ(status_of(kAstar, with_sphere(load, "3.47")), "no_route");
  EXPECT_EQ(status_of(kShortRrtStar, with_sphere(load, "3.47")), "no_route");
}
}  // namespace
}  // namespace altiplan::body_test
