// SPDX-License-Identifier: Apache-2.0
// The searches on random terrains of paper 002, within its angle limits.
#include <gtest/gtest.h>

#include "host/config/config.hpp"
#include "host/mission/mission.hpp"
#include "support/support.hpp"

namespace altiplan::paper_terrains_test {
namespace {

/// The problem on the terrain of that seed.
Request random_terrain(int seed, int peaks) {
  host::Overrides overrides;
  overrides.scenario = testing::configs() / "scenarios/fusion_random.yaml";
  overrides.seed = seed;
  overrides.set = {"scenario.environment.0.hills.count=" + std::to_string(peaks)};
  const auto pipeline = testing::configs() / "pipelines/fusion_paper_astar_angles.yaml";
  return host::build_mission(host::load_config(pipeline, overrides), 1).request;
}

PlanResult plan(const Request& request, const std::string& name, const std::string& parameters) {
  return testing::make_planner(name, "{cell_m: [1000, 1000, 200], " + parameters + "}")
      ->plan(request);
}

/// Half of them of 16 peaks, half of 45; how many are solved by heading, and only so.
void compare_states(int from, int to, int& solved, int& only_by_heading) {
  for (int seed = from; seed < to; ++seed) {
    const Request request = random_terrain(seed, seed % 2 == 0 ? 16 : 45);
    SCOPED_TRACE(seed);
    const PlanResult parent = plan(request, "astar", "state: parent");
    for (const char* name : {"astar", "bidirectional_astar"}) {
      const PlanResult heading = plan(request, name, "state: cell_and_heading");
      const PlanResult either = plan(request, name, "state: auto");
      ASSERT_EQ(either.status, heading.status) << either.message;
      if (heading.status != PlanStatus::solved) {
        ASSERT_NE(parent.status, PlanStatus::solved);
        EXPECT_TRUE(heading.proved);
        continue;
      }
      ++solved;
      EXPECT_TRUE(check(heading.route, request).ok());
      EXPECT_TRUE(check(either.route, request).ok());
      EXPECT_GE(length(either.route), length(heading.route) * (1 - 1e-12));
      only_by_heading += parent.status != PlanStatus::solved;
      if (parent.status == PlanStatus::solved) {
        EXPECT_GE(length(parent.route), length(heading.route) * (1 - 1e-12));
      }
    }
  }
}

TEST(PaperTerrains, ByHeadingNeverFailsWhereByParentSucceeds) {
  int solved = 0;
  int only_by_heading = 0;
  compare_states(0, 8, solved, only_by_heading);
  EXPECT_GT(solved, 8);
}

TEST(NightlyPaperTerrains, ByHeadingNeverFailsWhereByParentSucceeds) {
  int solved = 0;
  int only_by_heading = 0;
  compare_states(1000, 1300, solved, only_by_heading);
  EXPECT_GT(solved, 300);
  RecordProperty("only_by_heading", only_by_heading);
}

/// The goal lies close to the ground in the lee of a ridge. What comes over the ridge first closes
/// the cells behind it in directions that lead past the goal, and later arrivals, which could turn
/// to it, find them closed.
TEST(PaperTerrains, OneParentACellLosesAGoalInTheLeeOfARidge) {
  const Request request = random_terrain(4073, 45);
  Request of_any_length = request;
  of_any_length.limits.max_route_length = kInfinity;  // under this limit too, routes may be lost
  for (const std::string heuristic : {"heuristic: octile", "heuristic: manhattan"}) {
    SCOPED_TRACE(heuristic);
    const PlanResult heading = plan(request, "astar", heuristic + ", state: cell_and_heading");
    ASSERT_EQ(heading.status, PlanStatus::solved) << heading.message;
    EXPECT_TRUE(check(heading.route, request).ok());
    EXPECT_EQ(plan(request, "astar", heuristic + ", state: auto").route, heading.route);
    for (const Request& same : {request, of_any_length}) {
      const PlanResult parent = plan(same, "astar", heuristic + ", state: parent");
      EXPECT_EQ(parent.status, PlanStatus::no_route) << length(parent.route);
      EXPECT_FALSE(parent.proved) << "there is a route";
      EXPECT_NE(parent.message.find("turn_angle"), std::string::npos) << parent.message;
    }
  }
}

/// At 0.7 and 0.3 three dimensions of Manhattan distance are admissible. Half of the terrains have
/// 16 peaks, half 45; some of the second kind have no route.
void compare_manhattan(int from, int to) {
  int solved = 0;
  for (int seed = from; seed < to; ++seed) {
    Request request = random_terrain(seed, seed % 2 == 0 ? 16 : 45);
    request.limits.max_turn_space = kPi;
    const PlanResult weighted =
        plan(request, "astar", "heuristic: manhattan, weight_g: 0.7, weight_h: 0.3");
    const PlanResult euclidean = plan(request, "astar", "heuristic: euclidean");
    ASSERT_EQ(weighted.status, euclidean.status) << seed;
    EXPECT_NEAR(length(weighted.route) / 1000, length(euclidean.route) / 1000, 1e-9) << seed;
    solved += weighted.status == PlanStatus::solved;
  }
  EXPECT_GE(solved, (to - from) * 9 / 10);
  ::testing::Test::RecordProperty("solved", solved);
}

TEST(PaperTerrains, WeightedManhattanIsEuclidean) { compare_manhattan(0, 10); }
TEST(NightlyPaperTerrains, WeightedManhattanIsEuclidean) { compare_manhattan(100, 200); }
}  // namespace
}  // namespace altiplan::paper_terrains_test
