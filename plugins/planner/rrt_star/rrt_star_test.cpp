// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "reference/star_planners.hpp"
#include "reference/trees_in_time.hpp"

namespace altiplan::rrt_star_test {
namespace {

using testing::around_a_wall;
using testing::make_planner;

TEST(RrtStar, FindsTheNearerGap) { testing::expect_the_nearer_gap("rrt_star"); }

TEST(RrtStar, UsesTheWholeBudget) { testing::expect_the_whole_budget_used("rrt_star"); }

TEST(RrtStar, BoundedItIsShorterForTheSameNodes) {
  Request request = around_a_wall();
  double bounded = 0;
  double plain = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    request.random = RandomStream(seed);
    const auto length_with = [&](const std::string& yaml) {
      return length(make_planner("rrt_star", yaml)->plan(request).route);
    };
    bounded += length_with("{max_iterations: 6000, route_bias: 0}");
    plain += length_with("{max_iterations: 6000, route_bias: 0, bound: false}");
  }
  EXPECT_LT(bounded, plain);
}

TEST(RrtStar, BesideTheRouteItIsShorterForTheSameSamples) {
  Request request = around_a_wall();
  double beside = 0;
  double anywhere = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    request.random = RandomStream(seed);
    const auto length_with = [&](const std::string& bias) {
      const std::string yaml = "{max_iterations: 3000, route_bias: " + bias + "}";
      return length(make_planner("rrt_star", yaml)->plan(request).route);
    };
    beside += length_with("0.25");
    anywhere += length_with("0");
  }
  EXPECT_LT(beside, 0.99 * anywhere);
}

TEST(RrtStar, KeepsOffMovingObstaclesInTime) {
  testing::expect_routes_in_time("rrt_star", "{max_iterations: 3000}");
}
}  // namespace
}  // namespace altiplan::rrt_star_test
