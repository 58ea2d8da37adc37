// SPDX-License-Identifier: Apache-2.0
// A route with turns, from the scenario to the result and back.
#include <gtest/gtest.h>

#include "host/result/stored_result.hpp"
#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::wing_test {
namespace {

class Wing : public ::testing::Test {
 protected:
  testing::Ran ran_ = testing::run_file(testing::configs() / "pipelines/wing_ridge.yaml");
};

TEST_F(Wing, LegsJoinAndTurnOnTheLeastRadius) {
  const host::Json& result = ran_.json;
  ASSERT_EQ(result["status"], "solved") << result["message"];
  const Route route = host::route_of(result, "result.json");
  ASSERT_FALSE(route.is_straight());
  int trochoids = 0;
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Leg leg = route.leg(i);
    trochoids += leg.kind() == Leg::Kind::trochoid;
    EXPECT_TRUE(!leg.turns() || leg.radius >= 25 * 25 / (9.80665 * std::tan(radians(30))) - 1e-6);
    if (i > 0) {
      EXPECT_LT(turn_angle_horizontal(route.leg(i - 1).rate(1), leg.rate(0)), 1e-6) << i;
    }
  }
  EXPECT_GT(trochoids, 0);
  // Against the wind and with it.
  const Vec3 wind(8, 0, 0);
  EXPECT_LT(turn_angle_horizontal(route.leg(0).rate(0), Vec3(0, -25, 0) + wind), 1e-6);
  EXPECT_LT(turn_angle_horizontal(route.leg(route.leg_count() - 1).rate(1), Vec3(-25, 0, 0) + wind),
            1e-6);
  EXPECT_NEAR(result["metrics"]["length_m"], length(route), 1e-6);
}

TEST_F(Wing, AResultWhoseRouteAndLegsDisagreeIsRefused) {
  host::Json forged = ran_.json;
  forged["route"][5][2] = 5000;
  EXPECT_THROW(host::route_of(forged, "forged.json"), Error);
  forged = ran_.json;
  forged["legs"][1]["turn_deg"] = 90;
  EXPECT_THROW(host::route_of(forged, "forged.json"), Error);
  forged = ran_.json;
  forged["legs"][1]["kind"] = "spiral";
  EXPECT_THROW(host::route_of(forged, "forged.json"), Error);
}

TEST(WingStar, LeavesOneLoiterCircleAndJoinsTheOther) {
  const testing::Ran ran = testing::run_file(testing::configs() / "pipelines/wing_ridge_star.yaml");
  ASSERT_EQ(ran.json["status"], "solved") << ran.json["message"];
  const Route route = host::route_of(ran.json, "result.json");
  const auto on_circle = [](const Vec3& p, double x, double y) {
    return std::hypot(p.x() - x, p.y() - y);
  };
  EXPECT_NEAR(on_circle(route.front(), 4000, 5000), 250, 1e-6);
  EXPECT_NEAR(on_circle(route.back(), 23000, 23500), 250, 1e-6);
  // The quickest route that has been found takes 890 s.
  EXPECT_LT(ran.json["metrics"]["duration_s"], 1000);
}
}  // namespace
}  // namespace altiplan::wing_test
