// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "altiplan/error.hpp"
#include "dstar_worlds_test.hpp"

namespace altiplan {
namespace {

using testing::city_request;
using testing::draw;
using testing::Drawn;
using testing::expanded;
using testing::make_planner;

TEST(DStarLite, FirstPlanHasTheLengthOfAStarInCities) {
  const auto dstar = make_planner("dstar_lite");
  const auto astar = make_planner("astar");
  for (int n = 0; n < 200; ++n) {
    const Request request = city_request(n % 2 == 0 ? "complex" : "simple", n / 2);
    const PlanResult result = dstar->plan(request);
    const PlanResult expected = astar->plan(request);
    ASSERT_EQ(result.status, Status::solved) << n << ": " << result.message;
    ASSERT_EQ(expected.status, Status::solved) << n;
    EXPECT_NEAR(length(result.route), length(expected.route), 1e-9 * length(expected.route)) << n;
    EXPECT_TRUE(check(result.route, request).ok()) << n;
  }
}
}  // namespace
}  // namespace altiplan
