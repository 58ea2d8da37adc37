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
}  // namespace
}  // namespace altiplan::along_via_test
