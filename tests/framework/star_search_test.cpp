// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/sampling/star_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "support/support.hpp"

namespace altiplan::kit::star_search_test {
namespace {

/// A wall between start and goal, open above; the shortest way goes over its edges.
Request over_a_wall() {
  Request request =
      testing::request_in(testing::world_of({Shape{BoxShape{{{45, -1, -1}, {55, 101, 30}}}}}),
                          {10, 50, 10}, {90, 50, 10}, {{0, 0, 0}, {100, 100, 60}});
  return request;
}
const double kOverTheWall = 2 * std::hypot(35, 20) + 10;

StarSettings settings(std::uint64_t iterations, bool bounded, bool informed) {
  StarSettings settings;
  settings.range = 20;
  settings.goal_bias = 0.05;
  settings.radius_scale = 1.1;
  settings.max_iterations = iterations;
  settings.bounded = bounded;
  settings.informed = informed;
  return settings;
}

PlanResult search(const Request& request, const StarSettings& settings) {
  StarMemory memory;
  return star_search(request, settings, memory);
}

TEST(StarSearch, TheLengthGoesToTheShortest) {
  for (const auto& [bounded, informed, worst] : std::vector<std::tuple<bool, bool, double>>{
           {false, false, 1.08}, {true, false, 1.08}, {true, true, 1.04}}) {
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      Request request = over_a_wall();
      request.random = RandomStream(seed);
      double before = kInfinity;
      for (const std::uint64_t iterations : {1000, 4000, 16000}) {
        const PlanResult result = search(request, settings(iterations, bounded, informed));
        ASSERT_EQ(result.status, PlanStatus::solved);
        EXPECT_TRUE(check(result.route, request).ok());
        EXPECT_LE(length(result.route), before);
        EXPECT_GE(length(result.route), kOverTheWall - 1e-6);
        before = length(result.route);
      }
      EXPECT_LE(before, worst * kOverTheWall) << informed;
    }
  }
}

TEST(StarSearch, StopsWhereNothingIsShorter) {
  Request request = over_a_wall();
  request.world = std::make_shared<const World>();
  request.goal.position = {22, 50, 10};
  const PlanResult result = search(request, settings(1'000'000, false, false));
  EXPECT_EQ(result.route, (Route{{10, 50, 10}, {22, 50, 10}}));
}

/// The tree that the trace tells of: every leg, and every turn, holds in the end, and costs are
/// those of the ways.
TEST(StarSearch, AWholeTreeKeepsItsTurnsThroughRewiring) {
  struct Kept final : Trace {
    std::map<std::int64_t, TraceEvent> nodes;
    std::vector<double> lengths;
    int rewired = 0;
    void add(const TraceEvent& event) override {
      if (event.kind == TraceEvent::Kind::iteration) {
        lengths.push_back(event.value);
        return;
      }
      rewired += event.kind == TraceEvent::Kind::rewired;
      nodes[event.node] = event;
    }
  };
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    Kept kept;
    Request request = over_a_wall();
    request.random = RandomStream(seed);
    request.limits.max_turn_space = radians(60);
    request.limits.max_climb = radians(45);
    request.limits.min_leg = 3;
    request.start.velocity = {3, 1, 0};
    request.trace = &kept;
    const PlanResult result = search(request, settings(6000, seed % 2 == 1, false));
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    EXPECT_GT(kept.rewired, 100);
    for (const auto& [number, node] : kept.nodes) {
      if (node.parent < 0) {
        continue;
      }
      const TraceEvent& parent = kept.nodes.at(node.parent);
      const auto before = parent.parent < 0
                              ? request.before_start()
                              : std::optional<Approach>(kept.nodes.at(parent.parent).position);
      ASSERT_TRUE(leg_ok(before, parent.position, node.position, request)) << number;
    }
    EXPECT_TRUE(std::is_sorted(kept.lengths.rbegin(), kept.lengths.rend()));
    EXPECT_NEAR(kept.lengths.back(), length(result.route), 1e-9);
    request.trace = nullptr;
    EXPECT_EQ(search(request, settings(6000, seed % 2 == 1, false)).route, result.route);
  }
}

TEST(StarSearch, EndsAnywhereWithinTheToleranceAndWithinTheRouteLength) {
  Request request = over_a_wall();
  request.goal.tolerance_m = 8;
  const PlanResult near = search(request, settings(8000, true, true));
  ASSERT_EQ(near.status, PlanStatus::solved);
  EXPECT_LT(length(near.route), kOverTheWall - 3);
  EXPECT_TRUE(check(near.route, request).ok());
  request.limits.max_route_length = kOverTheWall - 10;
  const PlanResult none = search(request, settings(3000, true, true));
  EXPECT_EQ(none.status, PlanStatus::no_route);
  EXPECT_FALSE(none.proved);
}

TEST(StarSearch, SaysWhatWasInTheWay) {
  Request request = over_a_wall();
  request.volume.max.z() = 25;
  const PlanResult result = search(request, settings(2000, true, true));
  EXPECT_EQ(result.status, PlanStatus::no_route);
  EXPECT_NE(result.message.find("m of the goal; the last legs were refused by 'shapes'"),
            std::string::npos)
      << result.message;
  request.budget.max_memory_bytes = 100 * 160;
  const PlanResult small = search(request, settings(2000, true, true));
  EXPECT_EQ(small.status, PlanStatus::timed_out);
  EXPECT_TRUE(small.budget_hit);
}
}  // namespace
}  // namespace altiplan::kit::star_search_test
