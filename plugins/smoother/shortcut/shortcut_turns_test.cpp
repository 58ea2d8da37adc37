// SPDX-License-Identifier: Apache-2.0
#include "reference/wing_problems.hpp"

namespace altiplan::shortcut_turns_test {
namespace {

using testing::counter;
using testing::make_planner;
using testing::make_smoother;

/// Time by the airspeed of a route in wind, else its length.
double cost(const Route& route, const Request& request) {
  double sum = 0;
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Leg leg = route.leg(i);
    sum += request.wind.is_calm() ? leg.length()
           : leg.turns()          ? leg.air_length()
                                  : flight_time(leg.from, leg.to, 20, request.wind) * 20;
  }
  return sum;
}

TEST(ShortcutOfTurns, ShortensWhatATreeFoundInCalmAndWind) {
  RandomStream random(6);
  int routes = 0;
  int shorter = 0;
  for (int n = 0; n < 40; ++n) {
    const Request request = testing::among_towers(random, n);
    const PlanResult found =
        make_planner("rrt_connect", "{max_iterations: 5000, range_m: 300}")->plan(request);
    if (found.status != PlanStatus::solved) {
      continue;
    }
    ++routes;
    const PlanResult result = make_smoother("shortcut")->smooth(found.route, request);
    const CheckResult judged = check(result.route, request);
    ASSERT_TRUE(judged.ok()) << n << ": " << judged.violations.front().message;
    EXPECT_LE(cost(result.route, request), cost(found.route, request) * (1 + 1e-9)) << n;
    const Leg begin = found.route.leg(0);
    EXPECT_LT(turn_angle_horizontal(begin.rate(0), result.route.leg(0).rate(0)), 1e-6) << n;
    const Leg end = found.route.leg(found.route.leg_count() - 1);
    const Leg now = result.route.leg(result.route.leg_count() - 1);
    EXPECT_LT(turn_angle_horizontal(end.rate(1), now.rate(1)), 1e-6) << n;
    shorter += cost(result.route, request) < 0.9 * cost(found.route, request);
  }
  EXPECT_GT(routes, 15);
  EXPECT_GT(shorter, routes / 4);
}

TEST(ShortcutOfTurns, InTheOpenTheDubinsPathIsLeft) {
  const Pose from{{-1000, 0, 200}, 1};
  const Pose to{{1000, 300, 200}, 2};
  const Pose aside{{0, 1200, 200}, -1};
  const Request request = testing::between(from, to);
  Route route{from.position};
  for (const auto& [a, b] : {std::pair(from, aside), std::pair(aside, to)}) {
    for (const Leg& leg : kit::dubins_path(a, b, testing::kTurnRadius).legs(a, b.position)) {
      route.push_back(leg);
    }
  }
  ASSERT_TRUE(check(route, request).ok());
  const PlanResult result = make_smoother("shortcut")->smooth(route, request);
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_NEAR(length(result.route), kit::dubins_length(from, to, testing::kTurnRadius), 0.1);
}

TEST(ShortcutOfTurns, ARouteThroughAnObstacleDoesNotGetWorse) {
  const Pose from{{-1000, 0, 200}, 0};
  const Pose to{{1000, 300, 200}, 2};
  const Request request =
      testing::between(from, to, testing::world_of({Shape{Cylinder{0, 100, 300, 0, 300}}}));
  Route route{from.position};
  for (const Leg& leg : kit::dubins_path(from, to, testing::kTurnRadius).legs(from, to.position)) {
    route.push_back(leg);
  }
  const std::size_t before = check(route, request).violations.size();
  ASSERT_GT(before, 0);
  const PlanResult result = make_smoother("shortcut")->smooth(route, request);
  EXPECT_EQ(result.status, PlanStatus::solved);
  EXPECT_LE(check(result.route, request).violations.size(), before);
}

TEST(ShortcutOfTurns, TheSeedDecides) {
  RandomStream random(6);
  Request request = testing::among_towers(random, 0);
  request.world = std::make_shared<const World>();
  const PlanResult found = make_planner("rrt_connect")->plan(request);
  ASSERT_EQ(found.status, PlanStatus::solved);
  const auto shortcut = make_smoother("shortcut");
  EXPECT_EQ(shortcut->smooth(found.route, request).route,
            shortcut->smooth(found.route, request).route);
}
}  // namespace
}  // namespace altiplan::shortcut_turns_test
