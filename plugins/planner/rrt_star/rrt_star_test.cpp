// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "reference/star_planners.hpp"

namespace altiplan {
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
    bounded += length_with("{max_iterations: 6000}");
    plain += length_with("{max_iterations: 6000, bound: false}");
  }
  EXPECT_LT(bounded, plain);
}
}  // namespace
}  // namespace altiplan
