// SPDX-License-Identifier: Apache-2.0
// The profile of a route with turns.
#include <gtest/gtest.h>

#include "host/view/scene_parts.hpp"
#include "support/support.hpp"

namespace altiplan::host::scene_turns_test {
namespace {

/// A straight leg, a helix of two circles and a trochoid, and a long straight leg.
Route turning() {
  Route route{Vec3(0, 0, 500)};
  route.push_back(Vec3(100, 0, 500));
  route.push_back(Leg::turning({route.back(), 0}, 4.25 * kPi, 80, 60));
  route.push_back(Leg::turning({route.back(), 4.25 * kPi}, -kPi / 2, 80, 0, Vec3(20, -10, 0)));
  route.push_back(Vec3(route.back() + route.leg(2).rate(1).normalized() * 3000));
  return route;
}

TEST(SceneTurns, TheProfileRunsAlongTheCurves) {
  const Route route = turning();
  const Request request = altiplan::testing::request_in(World(), route.front(), route.back(),
                                                        {{-9e3, -9e3, 0}, {9e3, 9e3, 3e3}});
  const Json profile = route_profile(route, request, {300});
  const Json& s = profile.at("s");
  EXPECT_LE(s.size(), 300U);
  EXPECT_GT(s.size(), 250U);
  EXPECT_NEAR(s.back().get<double>(), length(route), 2e-3);
  const double step = length(route) / 250;
  const Polyline line = route.chords(1e-4);
  for (std::size_t i = 0; i < s.size(); ++i) {
    const Json& at = profile.at("at")[i];
    const Vec3 p(at[0].get<double>(), at[1].get<double>(), at[2].get<double>());
    double off = kInfinity;
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      off = std::min(off, point_leg_distance(p, line[k], line[k + 1]));
    }
    EXPECT_LT(off, 2e-3) << i;
    if (i > 0) {
      EXPECT_LE(s[i].get<double>() - s[i - 1].get<double>(), step);
    }
  }
  std::vector<double> turns;
  for (const Json& turn : profile.at("turn")) {
    if (!turn.is_null()) {
      turns.push_back(turn.get<double>());
    }
  }
  ASSERT_EQ(turns.size(), 3U);  // at the joints alone
  EXPECT_NEAR(turns.front(), 0, 1e-3);
  EXPECT_NEAR(turns.back(), 0, 1e-3);
}

}  // namespace
}  // namespace altiplan::host::scene_turns_test
