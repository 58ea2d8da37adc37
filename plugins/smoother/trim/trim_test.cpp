// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/support.hpp"
#include "support/walks.hpp"

namespace altiplan::trim_test {
namespace {

using testing::counter;
using testing::make_smoother;

/// Waypoints on a line, 10 m apart.
Polyline waypoints_on_a_line(int count) {
  Polyline route;
  for (int i = 0; i < count; ++i) {
    route.emplace_back(10 * i, 0, 0);
  }
  return route;
}

TEST(Trim, TakesStridesAndThenShorterOnes) {
  const Polyline line = waypoints_on_a_line(101);
  const Request request = testing::open_request(line);
  // 10 strides of 10 in the first round; of the 11 remaining waypoints, one stride to the 9th and
  // one to the last; then one.
  const PlanResult result = make_smoother("trim")->smooth(line, request);
  EXPECT_EQ(result.route, (Polyline{line.front(), line.back()}));
  EXPECT_EQ(counter(result, "expanded"), 10 + 2 + 1);
  EXPECT_EQ(counter(result, "rounds"), 5);
  EXPECT_EQ(counter(result, "removed"), 99);
  EXPECT_EQ(result.message, "2 of 101 waypoints kept, after strides of 10, 8, 6, 5, 4");
  const PlanResult one_round =
      make_smoother("trim", "{longest_stride: 10, shortest_stride: 9}")->smooth(line, request);
  EXPECT_EQ(one_round.route.size(), 11u);
  EXPECT_EQ(one_round.route[3], line[30]);
}

TEST(Trim, GoesOnByOneWaypointWhereAStrideIsNotFree) {
  // A ball between the first waypoint and the last two.
  const Polyline route = {{0, 0, 0}, {10, 13, 0}, {20, 15, 0}, {30, 13, 0}, {40, 0, 0}, {50, 0, 0}};
  const Request request =
      testing::request_in(testing::world_of({Shape{Sphere{{20, 0, 0}, 12.5}}}), route.front(),
                          route.back(), {{-99, -99, -99}, {99, 99, 99}});
  ASSERT_TRUE(check(route, request).ok());
  const auto trimmed = [&](const char* yaml) {
    return make_smoother("trim", yaml)->smooth(route, request).route;
  };
  EXPECT_EQ(trimmed("{longest_stride: 2, shortest_stride: 2}"),
            (Polyline{route[0], route[1], route[3], route[5]}));
  // No stride of 4 is free except the last one, which ends with the route.
  EXPECT_EQ(trimmed("{longest_stride: 4}"), (Polyline{route[0], route[1], route[2], route[5]}));
}

/// A direct implementation of the rounds: one waypoint after another is erased from a list.
Polyline trimmed_plainly(Polyline route, const Request& request,
                         const std::vector<std::size_t>& rounds) {
  route = without_repeats(route);
  for (const std::size_t stride : rounds) {
    std::optional<Approach> before = request.before_start();
    for (std::size_t i = 0; i + 1 < route.size(); ++i) {
      const std::size_t ahead = std::min(i + stride, route.size() - 1);
      if (ahead > i + 1 && leg_ok(before, route[i], route[ahead], request) &&
          (ahead + 1 == route.size() ||
           leg_ok(onward(before, route[i]), route[ahead], route[ahead + 1], request))) {
        route.erase(route.begin() + std::ptrdiff_t(i) + 1, route.begin() + std::ptrdiff_t(ahead));
      }
      before = onward(before, route[i]);
    }
  }
  return route;
}

void some_limits(Limits& limits, std::uint64_t seed) {
  limits.min_clearance = seed % 3 == 0 ? 2 : 0;
  limits.min_turn_radius = seed % 2 == 0 ? double(seed % 20) : 0;
  limits.max_turn_space = seed % 5 == 0 ? radians(120) : kPi;
  limits.max_climb = seed % 7 == 0 ? radians(50) : kPi / 2;
  limits.max_leg = seed % 11 == 0 ? 150 : kInfinity;
}

TEST(Trim, DoesWhatThePaperSaysAndNoRuleOfRandomRoutesGetsWorse) {
  const auto smoother =
      make_smoother("trim", "{longest_stride: 5, shortest_stride: 2, decay: 0.8}");
  int shorter = 0;
  int shorter_unsound = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    const bool sound = seed % 4 != 0;
    const auto [request, route] = testing::random_walk(
        RandomStream(seed), 14, sound, [&](Limits& limits) { some_limits(limits, seed); });
    if (route.size() < 3) {
      continue;
    }
    const PlanResult result = smoother->smooth(route, request);
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    EXPECT_EQ(result.route, trimmed_plainly(route.waypoints(), request, {5, 4, 3, 2})) << seed;
    ASSERT_EQ(testing::grown_excess(route, result.route, request), "") << seed;
    ASSERT_TRUE(!sound || check(result.route, request).ok()) << seed;
    EXPECT_LE(length(result.route), length(route) + 1e-9);
    (sound ? shorter : shorter_unsound) += result.route != route;
  }
  EXPECT_GT(shorter, 200);
  EXPECT_GT(shorter_unsound, 30);
}

TEST(Trim, JudgesTheTurnsAtBothEndsOfAStride) {
  // Removing the second waypoint would turn the route by 90 degrees at the third.
  const Polyline route = {{0, 0, 0}, {10, 10, 0}, {20, 0, 0}, {20, -20, 0}, {30, -30, 0}};
  Request request = testing::open_request(route);
  const auto trimmed = [&] {
    return make_smoother("trim", "{longest_stride: 2, shortest_stride: 2}")
        ->smooth(route, request)
        .route;
  };
  EXPECT_EQ(trimmed(), (Polyline{route[0], route[2], route[4]}));
  request.limits.max_turn_space = radians(91);
  request.start.velocity = {1, 1, 0};
  EXPECT_TRUE(check(route, request).ok());
  EXPECT_EQ(trimmed(), (Polyline{route[0], route[2], route[4]}));
  request.limits.max_turn_space = radians(85);
  ASSERT_EQ(check(route, request).violations.size(), 1u);  // the second waypoint's 90 degrees
  EXPECT_EQ(trimmed(), (Polyline{route[0], route[1], route[2], route[4]}));
  // The first leg is checked against the start's heading.
  request.limits.max_turn_space = radians(91);
  request.start.velocity = {-1, 5, 0};
  EXPECT_EQ(trimmed(), (Polyline{route[0], route[1], route[2], route[4]}));
}

TEST(Trim, ARuleOfTheWholeRouteHasTheLastWord) {
  struct ManyWaypoints final : Constraint {
    std::vector<Violation> do_violations(const Polyline& route, const Request&) const override {
      return route.size() >= 5 ? std::vector<Violation>{}
                               : std::vector<Violation>{{"", 0, double(route.size()), 5, "few"}};
    }
  };
  const Polyline line = waypoints_on_a_line(20);
  Request request = testing::open_request(line);
  request.constraints.push_back({"many", std::make_shared<ManyWaypoints>()});
  const PlanResult result = make_smoother("trim")->smooth(line, request);
  EXPECT_EQ(result.route, line);
  EXPECT_NE(result.message.find("whole routes"), std::string::npos);
}

TEST(Trim, OddRoutesAndBudgets) {
  const auto trim = make_smoother("trim");
  const Vec3 p(3, 4, 5);
  EXPECT_EQ(trim->smooth({p, p, p}, testing::open_request({p})).route, Polyline{p});
  const Polyline two = {p, {9, 9, 9}};
  EXPECT_EQ(trim->smooth(two, testing::open_request(two)).route, two);
  const Polyline repeated = {p, p, {9, 9, 9}, {9, 9, 9}, {12, 0, 0}};
  EXPECT_EQ(trim->smooth(repeated, testing::open_request(repeated)).route,
            (Polyline{p, {12, 0, 0}}));
  const Polyline line = waypoints_on_a_line(101);
  Request request = testing::open_request(line);
  request.budget.max_iterations = 3;
  const PlanResult cut = trim->smooth(line, request);
  EXPECT_TRUE(cut.budget_hit);
  EXPECT_EQ(cut.route.size(), 101u - 3 * 9);
  EXPECT_TRUE(check(cut.route, request).ok());
  EXPECT_NE(testing::parameter_problems("smoother", "trim", "{longest_stride: 3}"), "");
  EXPECT_NE(testing::parameter_problems("smoother", "trim", "{decay: 1}"), "");
}
}  // namespace
}  // namespace altiplan::trim_test
