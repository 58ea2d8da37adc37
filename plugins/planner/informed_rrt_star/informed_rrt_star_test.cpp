// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "reference/star_planners.hpp"
#include "reference/trees_in_time.hpp"

namespace altiplan::informed_rrt_star_test {
namespace {

using testing::around_a_wall;
using testing::make_planner;

TEST(InformedRrtStar, FindsTheNearerGap) { testing::expect_the_nearer_gap("informed_rrt_star"); }

TEST(InformedRrtStar, UsesTheWholeBudget) {
  testing::expect_the_whole_budget_used("informed_rrt_star");
}

TEST(InformedRrtStar, IsShorterThanRrtStarAfterTheSameSamples) {
  Request request = around_a_wall();
  double informed = 0;
  double plain = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    request.random = RandomStream(seed);
    const char* const yaml = "{max_iterations: 4000, route_bias: 0}";
    informed += length(make_planner("informed_rrt_star", yaml)->plan(request).route);
    plain += length(make_planner("rrt_star", yaml)->plan(request).route);
  }
  EXPECT_LT(informed, plain);
}

TEST(InformedRrtStar, KeepsOffMovingObstaclesInTime) {
  testing::expect_routes_in_time("informed_rrt_star", "{max_iterations: 3000}");
}
}  // namespace
}  // namespace altiplan::informed_rrt_star_test
