// SPDX-License-Identifier: Apache-2.0
#include "host/run/along_via.hpp"

#include <gtest/gtest.h>

#include "support/support.hpp"

namespace altiplan::along_via_test {
namespace {

/// The iterations that each of three sections may use, of planners that use all of them.
std::vector<std::uint64_t> shares(bool anytime) {
  Request request =
      testing::request_in(World(), {0, 0, 50}, {100, 0, 50}, {{-10, -10, 0}, {110, 10, 100}});
  request.budget.max_iterations = 900;
  std::vector<std::uint64_t> given;
  const PlanResult whole =
      host::plan_along(request, {{{30, 0, 50}}, {{60, 0, 50}}}, anytime, [&](const Request& part) {
        given.push_back(part.budget.max_iterations);
        PlanResult result;
        result.status = PlanStatus::solved;
        result.route = Route{part.start.position, part.goal.position};
        result.counters = {{"expanded", std::int64_t(part.budget.max_iterations)}};
        return result;
      });
  EXPECT_EQ(whole.route.size(), 4u);
  return given;
}

TEST(AlongVia, SectionsShareABudgetThatIsUsedUp) {
  EXPECT_EQ(shares(true), (std::vector<std::uint64_t>{300, 300, 300}));
  EXPECT_EQ(shares(false), (std::vector<std::uint64_t>{900, 0, 0}));
}

/// Where the second section comes from, of a first one that ends with a leg of 5 m.
Vec3 second_from(double radius) {
  Request request =
      testing::request_in(World(), {0, 0, 50}, {100, 0, 50}, {{-10, -10, 0}, {110, 10, 100}});
  request.vehicle.speed_mps = 20;
  request.limits.min_turn_radius = radius;
  Vec3 from = Vec3::Zero();
  (void)host::plan_along(request, {{{30, 0, 50}}}, false, [&](const Request& part) {
    PlanResult result;
    result.status = PlanStatus::solved;
    result.route = Route{part.start.position, {30, 5, 50}, part.goal.position};
    if (part.before_start()) {
      from = part.before_start()->from;
    }
    return result;
  });
  return from;
}

// A corner is cut of both its legs: planned as behind one of 20 m, it would be too tight.
TEST(AlongVia, ASectionComesFromTheLastLegBeforeIt) {
  EXPECT_NEAR((second_from(30) - Vec3(30, 5, 50)).norm(), 0, 1e-9);
  EXPECT_NEAR((second_from(0) - Vec3(30, 20, 50)).norm(), 0, 1e-9);  // its direction alone counts
}
}  // namespace
}  // namespace altiplan::along_via_test
