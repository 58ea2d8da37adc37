// SPDX-License-Identifier: Apache-2.0
// Places of a file, circles among them, joined to a route with tangents.
#include "host/import_export/joined_route.hpp"

#include <gtest/gtest.h>

namespace altiplan::host::joined_route_test {
namespace {

using Until = formats::MissionCircle::Until;

/// The route past places that no other part of the program wrote.
JoinedRoute joined(const std::vector<MissionPlace>& places) {
  return joined_route(places, std::nullopt, Limits{});
}

TEST(JoinedRoute, EntersAndLeavesACircleOnTangents) {
  const formats::MissionCircle left{Until::turns, 100, 1, 1};
  const JoinedRoute route = joined({{{-1000, 0, 50}}, {{0, 100, 80}, left}, {{100, 900, 60}}});
  EXPECT_EQ(route.circles, 1U);
  ASSERT_EQ(route.route.leg_count(), 3U);
  EXPECT_LT((route.route[1] - Vec3(0, 0, 80)).norm(), 1e-9);
  EXPECT_LT((route.route[2] - Vec3(100, 100, 80)).norm(), 1e-9);
  EXPECT_NEAR(route.route.leg(1).turn, radians(450), 1e-9);
}

TEST(JoinedRoute, TwoCirclesShareATangent) {
  const formats::MissionCircle left{Until::altitude, 100, 1, 0};
  const formats::MissionCircle right{Until::altitude, 50, -1, 0};
  const JoinedRoute route =
      joined({{{-500, -100, 50}}, {{0, 0, 50}, left}, {{400, 300, 50}, right}, {{900, 300, 50}}});
  EXPECT_EQ(route.circles, 2U);
  ASSERT_EQ(route.route.leg_count(), 5U);
  for (std::size_t i = 0; i + 1 < 5; ++i) {
    EXPECT_LT(turn_angle_horizontal(route.route.leg(i).rate(1), route.route.leg(i + 1).rate(0)),
              1e-9);
  }
}

TEST(JoinedRoute, CirclesWithoutTangentsAreWaypoints) {
  const formats::MissionCircle circle{Until::altitude, 100, 1, 0};
  const JoinedRoute inside = joined({{{10, 0, 50}}, {{0, 0, 50}, circle}, {{900, 0, 50}}});
  EXPECT_EQ(inside.unjoined, 1U);
  EXPECT_EQ(inside.route, (Route{{10, 0, 50}, {0, 0, 50}, {900, 0, 50}}));
  const JoinedRoute back = joined({{{900, 0, 50}}, {{0, 0, 50}, circle}, {{10, 0, 50}}});
  EXPECT_EQ(back.unjoined, 1U);
}

TEST(JoinedRoute, EndsWhereItEntersTheLastCircleAndBeginsWhereItLeavesTheFirst) {
  const formats::MissionCircle circle{Until::forever, 100, 1, 0};
  const Route to = joined({{{-900, -100, 50}}, {{0, 0, 50}, circle}}).route;
  EXPECT_LT((to.back() - Vec3(0, -100, 50)).norm(), 1e-9);
  const formats::MissionCircle first{Until::turns, 100, 1, 0};
  const Route from = joined({{{0, 0, 50}, first}, {{900, -100, 50}}}).route;
  EXPECT_LT((from.front() - Vec3(0, -100, 50)).norm(), 1e-9);
}

TEST(JoinedRoute, TheLastCircleKeepsItsHeightAndItsSense) {
  const std::vector<MissionPlace> way = {{{-900, -100, 50}}, {{0, -100, 50}}};
  const auto ending_on = [&](double z, int sense) {
    std::vector<MissionPlace> places = way;
    places.push_back({{0, 0, z}, formats::MissionCircle{Until::forever, 100, sense, 0}});
    return joined(places);
  };
  EXPECT_EQ(ending_on(50, 1).route.size(), 2U);
  EXPECT_EQ(ending_on(99, 1).route.back(), Vec3(0, -100, 99)) << "for the judge to refuse";
  EXPECT_EQ(ending_on(50, -1).unjoined, 1U) << "the circle is flown the other way";
}
}  // namespace
}  // namespace altiplan::host::joined_route_test
