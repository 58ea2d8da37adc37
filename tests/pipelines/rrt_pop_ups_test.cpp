// SPDX-License-Identifier: Apache-2.0
// Threats of 2 km that appear on routes over real ground (the main layout of paper 000's page): the
// tree of `rrt` lives on.
#include <gtest/gtest.h>

#include <map>

#include "host/config/config.hpp"
#include "host/mission/mission.hpp"
#include "reference/pop_ups.hpp"
#include "support/support.hpp"

namespace altiplan::rrt_pop_ups_test {
namespace {

constexpr int kCases = 100;

Request main_layout() {
  host::Overrides overrides;
  overrides.seed = 1;
  const auto pipeline = testing::configs() / "pipelines/rrt_jacksboro.yaml";
  return host::build_mission(host::load_config(pipeline, overrides), 1).request;
}

std::map<std::string, std::int64_t> counters(const PlanResult& result) {
  std::map<std::string, std::int64_t> all;
  for (const Counter& counter : result.counters) {
    all[counter.name] = counter.value;
  }
  return all;
}

/// Plans with each seed, lets a threat appear, and returns the nodes added to get past it, of all
/// cases together.
std::int64_t nodes_added(const std::string& cut_off) {
  const auto planner = testing::make_planner("rrt", "{step_m: 150, cut_off: " + cut_off + "}");
  Request request = main_layout();
  const std::shared_ptr<const World> calm = request.world;
  const State start = request.start;
  std::int64_t added = 0;
  for (int seed = 0; seed < kCases; ++seed) {
    SCOPED_TRACE(cut_off + ", seed " + std::to_string(seed));
    request.random = RandomStream(std::uint64_t(seed));
    request.world = calm;
    request.start = start;
    const auto session = planner->begin(request);
    EXPECT_EQ(session->result().status, PlanStatus::solved);
    const std::int64_t nodes = counters(session->result())["nodes"];
    const testing::PopUp pop_up = testing::draw_pop_up(session->result().route, request, 2000, 600,
                                                       request.random.sub("pop-up"));
    request.world = pop_up.world;
    request.start = pop_up.state;
    const PlanResult& result =
        session->update(pop_up.state, request.goal, pop_up.world, std::span(&pop_up.change, 1), {});
    EXPECT_EQ(result.status, PlanStatus::solved) << result.message;
    EXPECT_TRUE(check(result.route, request).ok());
    std::map<std::string, std::int64_t> counted = counters(result);
    EXPECT_EQ(counted["nodes_kept"] + counted["nodes_pruned"], nodes);
    EXPECT_EQ(counted["nodes_kept"] + counted["nodes_added"], counted["nodes"]);
    added += counted["nodes_added"];
    if (cut_off == "afresh") {
      EXPECT_EQ(result.route, planner->plan(request).route);
      EXPECT_EQ(counted["nodes_kept"], 0);
    }
  }
  return added;
}

TEST(RrtPopUps, RoutesStaySafeAndFewerNodesAreAddedThanAfresh) {
  const auto afresh = double(nodes_added("afresh"));
  EXPECT_LE(double(nodes_added("drop")), 0.85 * afresh);
  EXPECT_LE(double(nodes_added("reconnect")), 0.6 * afresh);
}
}  // namespace
}  // namespace altiplan::rrt_pop_ups_test
