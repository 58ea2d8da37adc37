// SPDX-License-Identifier: Apache-2.0
// A heading lasts through legs that have none: no climb hides a turn.
#include <gtest/gtest.h>

#include "altiplan/check.hpp"
#include "altiplan/measures.hpp"
#include "support/support.hpp"

namespace altiplan::headings_test {
namespace {

Request empty_request(const Polyline& route) {
  const double big = 1e4;
  return testing::request_in(World(), route.front(), route.back(),
                             {{-big, -big, -big}, {big, big, big}});
}

std::vector<std::string> broken(const Polyline& route, const Request& request) {
  std::vector<std::string> rules;
  for (const Violation& violation : check(route, request).violations) {
    rules.push_back(violation.constraint + "@" + std::to_string(violation.at));
  }
  return rules;
}
using Rules = std::vector<std::string>;

/// East, up by `climb`, and north.
Polyline climbing_corner(double climb) {
  return {{0, 0, 100}, {500, 0, 100}, {500, 0, 100 + climb}, {500, 500, 100 + climb}};
}

TEST(Headings, NoClimbHidesATurn) {
  for (const double climb : {1e-9, 1e-3, 30.0, 3000.0}) {
    const Polyline route = climbing_corner(climb);
    Request request = empty_request(route);
    request.limits.max_turn_horizontal = radians(30);
    EXPECT_EQ(broken(route, request), Rules{"turn_angle@2"}) << climb;
    EXPECT_NEAR(measure(route, request).max_turn_deg.value(), 90, 1e-9) << climb;
    request.vehicle.turns_on_the_spot = true;
    EXPECT_EQ(broken(route, request), Rules{}) << climb;
    EXPECT_NEAR(measure(route, request).max_turn_deg.value(), 0, 1e-9) << climb;
  }
}

TEST(Headings, LastThroughAnyNumberOfLegsWithoutOne) {
  // Each creeps on by less than a leg with a heading does, and turns to the north as it does so.
  Polyline route{{0, 0, 100}, {500, 0, 100}};
  for (int i = 0; i < 40; ++i) {
    const double angle = kPi / 2 * i / 39;
    route.push_back(route.back() + Vec3(0.9e-6 * std::cos(angle), 0.9e-6 * std::sin(angle), 1));
  }
  route.push_back(route.back() + Vec3(0, 500, 0));
  Request request = empty_request(route);
  request.limits.max_turn_horizontal = radians(89.9);
  EXPECT_EQ(broken(route, request), Rules{"turn_angle@41"});
}

TEST(Headings, ThatOfTheStartLastsToo) {
  const Polyline route{{0, 0, 100}, {0, 0, 200}, {0, 500, 200}};
  Request request = empty_request(route);
  request.limits.max_turn_horizontal = radians(30);
  EXPECT_EQ(broken(route, request), Rules{});
  request.start.velocity = {20, 0, 0};
  EXPECT_EQ(broken(route, request), Rules{"turn_angle@1"});
  request.start.velocity = {0, 0, 20};  // upright: none
  EXPECT_EQ(broken(route, request), Rules{});
}

TEST(Headings, ATurnOverAClimbHasNoRadius) {
  const Polyline route = climbing_corner(2000);
  Request request = empty_request(route);
  request.limits.min_turn_radius = 200;
  EXPECT_EQ(broken(route, request), Rules{"turn_radius@2"});
  EXPECT_EQ(measure(route, request).min_radius_m.value(), 0);
  request.vehicle.turns_on_the_spot = true;
  EXPECT_EQ(broken(route, request), Rules{});
  // Half of 500 m is the tangent of each quarter turn into and out of the climb.
  EXPECT_NEAR(measure(route, request).min_radius_m.value(), 250, 1e-9);
}

TEST(Headings, ARepeatedPointIsNoLeg) {
  Polyline route = climbing_corner(1);
  route.insert(route.begin() + 2, route[1]);
  route.insert(route.begin() + 4, route[3]);
  Request request = empty_request(route);
  request.limits.max_turn_horizontal = radians(30);
  EXPECT_EQ(broken(route, request), Rules{"turn_angle@4"});
}

TEST(Fillets, TakeAtMostHalfOfEachLeg) {
  // A right angle between legs of 400 m: a circle of 200 m touches both at their middles.
  EXPECT_NEAR(fillet_radius({400, 0, 0}, {0, 400, 0}), 200, 1e-9);
  EXPECT_NEAR(fillet_radius({400, 0, 0}, {0, 100, 0}), 50, 1e-9);
  EXPECT_NEAR(fillet_radius({100, 0, 0}, {0, 0, 100}), 50, 1e-9);
  EXPECT_EQ(fillet_radius({1, 2, 3}, {2, 4, 6}), kInfinity);
  EXPECT_EQ(fillet_radius({1, 2, 3}, {0, 0, 0}), kInfinity);
  EXPECT_EQ(fillet_radius({1, 2, 3}, {-2, -4, -6}), 0);
}

TEST(Fillets, MessagesTellTheRadiusFromItsLimit) {
  const Polyline route{{0, 0, 100}, {400, 0, 100}, {400, 400, 100}};
  Request request = empty_request(route);
  request.limits.min_turn_radius = 200.0004;
  const CheckResult result = check(route, request);
  ASSERT_EQ(result.violations.size(), 1u);
  EXPECT_EQ(result.violations[0].message,
            "the turn radius is 200.0000 m, below the limit of 200.0004 m");
}
}  // namespace
}  // namespace altiplan::headings_test
