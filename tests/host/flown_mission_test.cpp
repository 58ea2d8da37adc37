// SPDX-License-Identifier: Apache-2.0
// How autopilots fly missions: figures of ArduPilot 4.7 and PX4 1.16 at their default parameters.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "host/autopilot/flown_mission.hpp"
#include "support/support.hpp"

namespace altiplan::host::flown_mission_test {
namespace {

using formats::Airframe;
using formats::Autopilot;
using formats::Firmware;
using formats::MissionCommand;

constexpr double kLon = 8;
constexpr double kLat = 47;
constexpr double kHome = 400;  // metres above sea level
constexpr Autopilot kCopter{Firmware::ardupilot, Airframe::copter};
constexpr Autopilot kPlane{Firmware::ardupilot, Airframe::plane};
constexpr Autopilot kQuadplane{Firmware::ardupilot, Airframe::vtol};
constexpr Autopilot kPx4Copter{Firmware::px4, Airframe::copter};

const World& flat() {
  static const World kWorld = World().with_frame(Frame::geographic(kLon, kLat, kLat));
  return kWorld;
}

/// A command at metres east and north of home.
MissionCommand command(int number, double x, double y, double height, int frame = 3) {
  MissionCommand made;
  made.number = number;
  made.frame = frame;
  const auto [lon, lat] = flat().frame().to_lonlat(x, y);
  made.lon = lon;
  made.lat = lat;
  made.altitude_m = height;
  return made;
}

/// A command without a place.
MissionCommand order(int number, std::array<double, 4> params) {
  MissionCommand made;
  made.number = number;
  made.frame = 2;
  made.params = params;
  return made;
}

FlownMission fly(std::vector<MissionCommand> commands, Autopilot autopilot,
                 const FlightOptions& options = {}, const World& world = flat()) {
  formats::MissionFile plan;
  plan.home = {kLon, kLat, kHome, formats::AltitudeFrame::sea};
  for (std::size_t n = 0; n < commands.size(); ++n) {
    commands[n].item = int(n) + 1;
    commands[n].place = "item " + std::to_string(n + 1);
  }
  plan.commands = std::move(commands);
  return fly_mission(plan, autopilot, world, options);
}

const FlownPart& part(const FlownMission& flown, const std::string& what) {
  for (const FlownPart& one : flown.parts) {
    if (one.what == what) {
      return one;
    }
  }
  throw std::runtime_error("no part '" + what + "'");
}

bool has_rule(const FlownMission& flown, const std::string& rule) {
  return std::any_of(flown.remarks.begin(), flown.remarks.end(),
                     [&](const Remark& remark) { return remark.rule == rule; });
}

/// The least distance in plan between a place and the ways between items.
double distance_to(const FlownMission& flown, double x, double y) {
  double nearest = kInfinity;
  const Eigen::Vector2d p(x, y);
  for (const FlownPart& one : flown.parts) {
    for (const Strip& strip : one.what.empty() ? one.strips : std::vector<Strip>{}) {
      const Eigen::Vector2d a = strip.from.head<2>();
      const Eigen::Vector2d along = strip.to.head<2>() - a;
      const double share =
          along.norm() > 0 ? std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
      nearest = std::min(nearest, (a + share * along - p).norm());
    }
  }
  return nearest;
}

/// How far a place at a height above home lies outside of the band.
double outside(const FlownMission& flown, double x, double y, double height) {
  double nearest = kInfinity;
  const Eigen::Vector2d p(x, y);
  for (const FlownPart& one : flown.parts) {
    for (const Strip& strip : one.strips) {
      const Eigen::Vector2d a = strip.from.head<2>();
      const Eigen::Vector2d along = strip.to.head<2>() - a;
      const double share =
          along.norm() > 0 ? std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
      const double low = strip.from.z() + share * (strip.to.z() - strip.from.z());
      const double high = strip.from_high_m + share * (strip.to_high_m - strip.from_high_m);
      const double above = std::max({low - kHome - height, kHome + height - high, 0.0});
      nearest =
          std::min(nearest, std::hypot((a + share * along - p).norm(), above) - strip.reach_m);
    }
  }
  return std::max(nearest, 0.0);
}

double highest(const FlownPart& one) {
  double high = -kInfinity;
  for (const Strip& strip : one.strips) {
    high = std::max({high, strip.from_high_m, strip.to_high_m});
  }
  return high;
}

TEST(FlownMission, ACopterOfArduPilotTakesOffWhereItStands) {
  const std::vector<MissionCommand> commands{command(22, 300, 0, 40), command(16, 300, 300, 40)};
  EXPECT_LT(distance_to(fly(commands, kCopter), 150, 150), 1);      // straight to the second item
  EXPECT_GT(distance_to(fly(commands, kPx4Copter), 150, 150), 90);  // PX4 flies to the first
}

TEST(FlownMission, AQuadplaneAddsTheNumberOfItsTakeOffToItsHeight) {
  const FlownMission flown =
      fly({command(84, 0, 0, 480, 0), command(16, 900, 0, 480, 0)}, kQuadplane);
  EXPECT_NEAR(highest(flown.parts.front()), kHome + 480, 0.1);
  EXPECT_TRUE(has_rule(flown, "take_off_frame"));
}

TEST(FlownMission, AQuadplaneSpeedsUpWhereItPoints) {
  const std::vector<MissionCommand> commands{command(84, 0, 0, 60), command(16, 900, 0, 60),
                                             command(16, 1800, 0, 60)};
  const auto is_judged = [&](std::optional<double> heading, Autopilot autopilot) {
    FlightOptions options;
    options.runway_deg = heading;
    return !has_rule(fly(commands, autopilot, options), "not_judged");
  };
  EXPECT_FALSE(is_judged(std::nullopt, kQuadplane));
  EXPECT_TRUE(is_judged(80, kQuadplane));
  EXPECT_FALSE(is_judged(70, kQuadplane));
}

// In ArduPilot's simulation it swings up to 30 m away while it lands in 4.3 m/s.
TEST(FlownMission, AQuadplaneInWindIsNotJudged) {
  const auto is_judged = [](double wind_mps) {
    FlightOptions options;
    options.runway_deg = 90;
    options.wind_mps = wind_mps;
    return !has_rule(fly({command(84, 0, 0, 60), command(16, 900, 0, 60), command(85, 1800, 0, 0)},
                         kQuadplane, options),
                     "not_judged");
  };
  EXPECT_TRUE(is_judged(0));
  EXPECT_FALSE(is_judged(2));
}

TEST(FlownMission, Px4TakesAPlanesMissionWithoutALandingIfItIsTold) {
  const std::vector<MissionCommand> commands{command(16, 0, 0, 100), command(16, 900, 0, 100)};
  constexpr Autopilot kPx4Plane{Firmware::px4, Airframe::plane};
  FlightOptions options;
  EXPECT_TRUE(has_rule(fly(commands, kPx4Plane, options), "refused"));
  options.parameters["MIS_TKO_LAND_REQ"] = 0;
  const FlownMission flown = fly(commands, kPx4Plane, options);
  EXPECT_FALSE(has_rule(flown, "refused") || has_rule(flown, "MIS_TKO_LAND_REQ"));
  options.parameters["MIS_TKO_LAND_REQ"] = 1;
  EXPECT_TRUE(has_rule(fly(commands, kPx4Plane, options), "MIS_TKO_LAND_REQ"));
}

TEST(FlownMission, AReturnClimbsToTheAutopilotsHeight) {
  const std::vector<MissionCommand> commands{command(22, 0, 0, 10), command(16, 800, 0, 10),
                                             order(20, {0, 0, 0, 0})};
  EXPECT_NEAR(highest(part(fly(commands, kCopter), "the way home")), kHome + 15, 0.1);
  EXPECT_NEAR(highest(part(fly(commands, kPx4Copter), "the way home")), kHome + 30, 0.1);
  FlightOptions options;
  options.parameters["RTL_ALT"] = 5000;  // ArduPilot 4.6 and before, centimetres
  EXPECT_NEAR(highest(part(fly(commands, kCopter, options), "the way home")), kHome + 50, 0.1);
}

TEST(FlownMission, APlaneCutsACornerByItsDistanceOfGuidance) {
  const std::vector<MissionCommand> commands{command(16, -2000, 0, 100), command(16, 0, 0, 100),
                                             command(16, 0, 2000, 100)};
  FlightOptions fast;
  fast.parameters["AIRSPEED_CRUISE"] = 20;
  // At 20 m/s it begins to turn 81 m before the item: its chord passes 57 m from the corner.
  EXPECT_LT(distance_to(fly(commands, kPlane, fast), -57 / std::sqrt(2), 57 / std::sqrt(2)), 8);
  // At 12 m/s it passes 35 m from it, and keeps off the other place.
  EXPECT_GT(distance_to(fly(commands, kPlane), -57 / std::sqrt(2), 57 / std::sqrt(2)), 12);
  FlightOptions narrow;
  narrow.parameters["WP_RADIUS"] = 10;
  EXPECT_GT(distance_to(fly(commands, kPlane, narrow), -20, 20), 8);
}

TEST(FlownMission, APlaneChangesItsHeightAtOnceBelow15Metres) {
  const auto low_after = [](double drop, double end = 100) {
    const FlownMission flown = fly(
        {command(16, 0, 0, end + drop), command(16, 100, 0, end + drop), command(16, 2100, 0, end)},
        kPlane);
    double low = kInfinity;  // 400 m along the last way
    for (const FlownPart& one : flown.parts) {
      for (const Strip& strip : one.strips) {
        const double run = strip.to.x() - strip.from.x();
        if (one.command == 2 && one.what.empty() && strip.from.x() <= 400 && strip.to.x() > 400) {
          low = std::min(
              low, strip.from.z() + (400 - strip.from.x()) / run * (strip.to.z() - strip.from.z()));
        }
      }
    }
    return low - kHome;
  };
  EXPECT_NEAR(low_after(14), 100, 0.5);
  EXPECT_GT(low_after(20), 114);
  EXPECT_GT(low_after(20, -200), -186);  // below its home only climbs are steep
}

TEST(FlownMission, ATooSteepLegOfAPlaneIsNoted) {
  const FlownMission flown = fly({command(16, 0, 0, 50), command(16, 200, 0, 450)}, kPlane);
  EXPECT_TRUE(has_rule(flown, "climb_rate"));
}

TEST(FlownMission, HeightsAfterANewHomeCountFromIt) {
  const FlownMission flown =
      fly({command(22, 0, 0, 50), command(16, 100, 0, 50), command(179, 0, 0, 300, 0),
           command(16, 200, 0, 50), command(16, 300, 0, 50)},
          kCopter);
  EXPECT_NEAR(flown.parts.back().strips.back().to.z(), 350, 0.1);
  EXPECT_TRUE(has_rule(flown, "set_home"));
}

TEST(FlownMission, JumpsAreFlownAsOftenAsTheySay) {
  const FlownMission once =
      fly({command(22, 0, 0, 20), command(16, 500, 0, 20), command(16, 0, 0, 20)}, kCopter);
  const FlownMission thrice = fly({command(22, 0, 0, 20), command(16, 500, 0, 20),
                                   command(16, 0, 0, 20), order(177, {2, 2, 0, 0})},
                                  kCopter);
  const double both_ways = 2 * 500 / 10.0;
  EXPECT_GT(thrice.time.min_s - once.time.min_s, 2 * both_ways * 0.9);
  EXPECT_LT(thrice.time.min_s - once.time.min_s, 2 * both_ways * 1.1);
  EXPECT_TRUE(std::isinf(
      fly({command(22, 0, 0, 20), command(16, 500, 0, 20), order(177, {2, -1, 0, 0})}, kCopter)
          .time.max_s));
}

TEST(FlownMission, WhatTakesForEverIsNotFlown) {
  const std::vector<MissionCommand> loop{command(16, 0, 0, 100), command(16, 900, 0, 100),
                                         order(177, {1, 20000, 0, 0}), command(16, 900, 900, 100)};
  EXPECT_GT(fly(loop, kPlane).time.min_s, 20000 * 100);  // flown a few times, and counted
  EXPECT_TRUE(
      has_rule(fly({command(16, 0, 0, 100), command(16, 900'000, 0, 100)}, kPlane), "not_judged"));
  MissionCommand arc = command(36, 100, 0, 20);
  arc.params = {360, 0, 0, 0};
  EXPECT_TRUE(
      has_rule(fly({command(22, 0, 0, 20), arc, command(16, 200, 0, 20)}, kCopter), "not_judged"));
}

TEST(FlownMission, ADelayHoldsACopterAndAConditionDoesNot) {
  const auto time = [](int number) {
    return fly({command(22, 0, 0, 20), order(number, {300, 0, 0, 0}), command(16, 600, 0, 20)},
               kCopter)
        .time;
  };
  EXPECT_GT(time(93).min_s, 300);
  EXPECT_LT(time(112).max_s, 120);
}

TEST(FlownMission, NumbersAreCutAsTheAutopilotStoresThem) {
  MissionCommand circle = command(18, 500, 0, 50.559);
  circle.params = {2.9, 0, 268, 0};
  const FlownMission flown = fly({command(22, 0, 0, 50), circle}, kCopter);
  const FlownPart& round = part(flown, "its circle");
  EXPECT_NEAR(round.strips.front().from.z(), kHome + 50, 0.56);
  EXPECT_NEAR(highest(round), kHome + 50.55, 1e-6);
  double radius = 0;
  for (const Strip& strip : round.strips) {
    radius = std::max(radius, (strip.from.head<2>() - Eigen::Vector2d(500, 0)).norm());
  }
  EXPECT_NEAR(radius, 260, 1.5);  // whole tens of metres
}

TEST(FlownMission, WhatAnAutopilotRefusesIsNotFlown) {
  const auto rule_of = [](const MissionCommand& extra, Autopilot autopilot) {
    const FlownMission flown =
        fly({command(22, 0, 0, 20), command(16, 100, 0, 20), extra, command(16, 200, 0, 20)},
            autopilot);
    for (const Remark& remark : flown.remarks) {
      if (remark.command == 2) {
        return remark.rule;
      }
    }
    return std::string("none");
  };
  EXPECT_EQ(rule_of(order(201, {0, 0, 0, 0}), kCopter), "none");
  EXPECT_EQ(rule_of(command(82, 150, 0, 20), kPx4Copter), "refused");
  EXPECT_EQ(rule_of(command(36, 150, 0, 20), kPlane), "dropped");
  EXPECT_EQ(rule_of(order(42702, {0, 0, 0, 0}), kCopter), "unforeseeable");
  EXPECT_EQ(rule_of(command(16, 150, 0, 20, 10), kPx4Copter), "refused");
  EXPECT_EQ(rule_of(order(99, {0, 0, 0, 0}), kCopter), "refused");
  MissionCommand stops = command(16, 150, 0, 20);
  stops.auto_continue = false;
  EXPECT_EQ(rule_of(stops, kPx4Copter), "never_ends");
  EXPECT_EQ(rule_of(stops, kCopter), "none");
  for (const int number : {16, 17, 19, 21, 22, 82}) {  // QGroundControl leaves the yaw open
    MissionCommand open = command(number, 150, 0, 20);
    open.params[3] = NAN;
    EXPECT_EQ(rule_of(open, kCopter) == "refused", number == 19 || number == 82) << number;
  }
}
// Flown in ArduPilot's simulation.
TEST(FlownMission, ACopterLeavesItsCircleBesideTheBeginning) {
  MissionCommand circle = command(18, 0, 500, 50);
  circle.params = {1, 0, 60, 0};
  const FlownMission flown =
      fly({command(22, 0, 0, 50), circle, command(16, 900, 500, 50)}, kCopter);
  // The turn begins at (0, 440): of 8.7 m/s it is left about 19 m before, and stops 17 m on.
  const double angle = 19 / 60.0;
  const Eigen::Vector2d left(60 * std::sin(angle), 500 - 60 * std::cos(angle));
  EXPECT_LT(
      outside(flown, left.x() + 100, left.y() + 100 * (500 - left.y()) / (900 - left.x()), 50),
      0.5);
  // And goes on as long as a delay lasts.
  const FlownMission later =
      fly({command(22, 0, 0, 50), circle, order(93, {20, 0, 0, 0}), command(16, 900, 500, 50)},
          kCopter);
  EXPECT_LT(outside(later, 450, 530, 50), 0.5);  // from the northern edge
  EXPECT_GT(outside(flown, 450, 530, 50), 20);
}

TEST(FlownMission, AnArcThatFollowsNoWaypointMayBeFlownStraight) {
  MissionCommand arc = command(36, 300, 0, 50);
  arc.params = {180, 0, 0, 0};
  const FlownMission first = fly({command(22, 0, 0, 50), arc}, kCopter);
  EXPECT_LT(outside(first, 150, 0, 50), 0.1);
  EXPECT_LT(outside(first, 150, 150, 50), 1);
  const FlownMission second = fly({command(22, 0, 0, 50), command(16, 0, 1, 50), arc}, kCopter);
  EXPECT_GT(outside(second, 150, 0, 50), 100);
}

TEST(FlownMission, AReturnAfterANewHomeCountsItsHeightFromEither) {
  const FlownMission flown = fly({command(22, 0, 0, 60), command(16, 500, 0, 60),
                                  command(179, 100, 0, kHome - 30, 0), order(20, {0, 0, 0, 0})},
                                 kCopter);
  EXPECT_LT(outside(flown, 300, 0, 30), 0.1);  // as high above the new home
  EXPECT_LT(outside(flown, 300, 0, 60), 0.1);
}

TEST(FlownMission, ATurnWithoutARadiusIsFlownAtThePresentHeight) {
  MissionCommand turn = command(18, 100, 0, 90);
  turn.params = {2, 0, 0, 0};
  const FlownMission near = fly({command(22, 0, 0, 50), turn, command(16, 200, 0, 50)}, kCopter);
  EXPECT_GT(outside(near, 100, 0, 90), 30);
  EXPECT_FALSE(has_rule(near, "not_judged"));
  turn = command(18, 900, 0, 90);  // it ends on the way, when the yaw has turned
  turn.params = {2, 0, 0, 0};
  EXPECT_TRUE(has_rule(fly({command(22, 0, 0, 50), turn}, kCopter), "not_judged"));
}

/// Flown in ArduPilot's simulation with these.
FlightOptions flown_options(double airspeed) {
  FlightOptions options;
  options.parameters = {{"AIRSPEED_CRUISE", airspeed},
                        {"WP_RADIUS", 50},
                        {"NAVL1_PERIOD", 15},
                        {"ROLL_LIMIT_DEG", 65}};
  return options;
}

TEST(FlownMission, AnOrderThatAJumpLeadsToHidesTheRound) {
  // It leaves its circle toward the item behind the jump, and flies to the one of the round.
  constexpr double kHigh = 1160;
  MissionCommand circle = command(18, 0, 0, kHigh);
  circle.params = {1, 0, -60, 0};
  const auto flown = [&](double target) {
    return fly(
        {command(16, 708, 112, kHigh), order(178, {0, 18, -1, 0}), command(16, 1500, 72, kHigh),
         circle, order(177, {target, 1, 0, 0}), command(16, -500, -27, kHigh)},
        kPlane, flown_options(18));
  };
  EXPECT_LT(outside(flown(2), -59, 150, kHigh), 0.1);
  EXPECT_LT(outside(flown(2), -24, 171, kHigh), 0.1);
  EXPECT_GT(outside(flown(3), -24, 171, kHigh), 20);
}

TEST(FlownMission, APlanePassesByOnTheLineBeyondItsItem) {
  MissionCommand circle = command(31, -1081, 0, 116);
  circle.params = {0, -150, 0, 0};
  MissionCommand passed = command(16, 0, 0, 116);
  passed.params = {0, 20, 40, 0};
  MissionCommand last = command(31, -140, 750, 132);
  last.params = circle.params;
  const FlownMission flown =
      fly({command(16, -1500, -840, 100), circle, passed, order(178, {0, 18, -1, 0}), last}, kPlane,
          flown_options(22));
  for (const double beyond : {4.0, 8.0, 12.0, 16.0, 20.0}) {
    EXPECT_LT(outside(flown, beyond, 0, 116), 0.1) << beyond;
  }
}

TEST(FlownMission, APlaneAboveItsClimbBeginsItAnew) {
  MissionCommand last = command(16, 560, -207, 76);
  last.params = {0, 20, 0, 0};
  const FlownMission flown =
      fly({command(16, -679, 0, 108), command(16, 0, 0, 60), last}, kPlane, flown_options(22));
  EXPECT_LT(outside(flown, 141, -52, 74), 0.1);  // 10 m of climb were left: at once
  const FlownMission from_level =
      fly({command(16, -679, 0, 60), command(16, 0, 0, 60), last}, kPlane, flown_options(22));
  EXPECT_GT(outside(from_level, 141, -52, 74), 1);
}

TEST(FlownMission, ACopterFasterThanItsOwnSpeedLeavesACircle) {
  const auto circled = [](double radius) {
    MissionCommand circle = command(18, 400, 0, 50);
    circle.params = {1, 0, radius, 0};
    return fly({command(22, 0, 0, 50), order(178, {1, 15, -1, 0}), circle}, kCopter);
  };
  EXPECT_TRUE(has_rule(circled(120), "not_judged"));  // 12.2 m/s: flown with 158 m of radius
  EXPECT_FALSE(has_rule(circled(60), "not_judged"));
}

/// Rises to the east.
class Slope final : public Environment, public Ground {
 public:
  explicit Slope(double slope) : slope_(slope) {}

 private:
  double height_at(double x) const { return kHome + slope_ * x; }
  Box do_bounds() const override { return {{-1e4, -1e4, 0}, {1e4, 1e4, 1000}}; }
  double do_clearance(const Vec3& p) const override { return p.z() - height_at(p.x()); }
  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double x, double) const override { return height_at(x); }
  double do_gap(const Vec3& a, const Vec3& b, double) const override {
    return std::min(a.z() - height_at(a.x()), b.z() - height_at(b.x()));
  }
  double slope_;
};

World rising(double slope) {
  return altiplan::testing::world_of(std::make_shared<Slope>(slope), "slope")
      .with_frame(flat().frame());
}

TEST(FlownMission, AReturnFromACircleAboveTheGroundIsLevel) {
  MissionCommand circle = command(18, 300, 0, 20, 10);
  circle.params = {1, 0, 20, 0};
  FlightOptions options;
  options.parameters["RTL_ALT_M"] = 80;
  const FlownMission flown =
      fly({command(22, 0, 0, 20), circle, order(20, {0, 0, 0, 0})}, kCopter, options, rising(0.1));
  EXPECT_LT(outside(flown, 200, 0, 80), 0.1);
  EXPECT_LT(outside(flown, 100, 0, 80), 0.1);
  EXPECT_GT(outside(flown, 100, 0, 60), 5);
}

TEST(FlownMission, ACopterDoesNotSlowDownOnACircleAboveTheGround) {
  MissionCommand circle = command(18, 300, 0, 85, 10);
  circle.params = {1, 0, 60, 0};
  const FlownMission flown = fly({command(22, 0, 0, 200), circle}, kCopter, {}, rising(0.8));
  const double sought = 0.8 * 240 + 85;
  EXPECT_LT(outside(flown, 240, 0, sought + 25), 0.1);  // it sinks slower than the ground
  EXPECT_GT(outside(flown, 240, 0, sought + 100), 10);
}

TEST(FlownMission, ACopterSwingsOutOfACircleAboveTheGround) {
  MissionCommand circle = command(18, 300, 0, 30, 10);
  circle.params = {1, 0, 20, 0};
  const FlownMission flown = fly({command(22, 0, 0, 30), circle}, kCopter, {}, rising(0));
  EXPECT_LT(outside(flown, 326.3, 0, 30), 0.1);
  EXPECT_GT(outside(flown, 329, 0, 30), 1);
  const auto is_circle = [](const FlownPart& one) { return one.what == "its circle"; };
  const auto part = std::find_if(flown.parts.begin(), flown.parts.end(), is_circle);
  ASSERT_NE(part, flown.parts.end());
  EXPECT_LT(part->strips.front().from.z(), kHome + 30 - 2);
}

TEST(FlownMission, APlaneLeavesItsTurnsBelowTheirHeight) {
  MissionCommand circle = command(18, 400, 0, 600);
  circle.params = {1, 0, 60, 0};
  const FlownMission flown =
      fly({command(16, 0, 0, 100), circle, command(16, 3000, 0, 600)}, kPlane);
  EXPECT_LT(outside(flown, 700, 0, 450), 0.1);
  circle.number = 31;  // to its height
  circle.params = {0, 60, 0, 0};
  const FlownMission high =
      fly({command(16, 0, 0, 100), circle, command(16, 3000, 0, 600)}, kPlane);
  EXPECT_GT(outside(high, 700, 0, 450), 100);
}

TEST(FlownMission, ARampFromAboveTheGroundIsCut) {
  // The number 200, as if it were metres above the sea, is below the item.
  const FlownMission flown =
      fly({command(16, -1000, 0, 200, 10), command(16, 0, 0, 200, 10), command(16, 1500, 0, 120)},
          kPlane, {}, rising(0.05));
  EXPECT_LT(outside(flown, 700, 0, 122), 0.1);
  EXPECT_LT(outside(flown, 700, 0, 160), 0.1);
}

TEST(FlownMission, AReturnSinksFromThePresentHeight) {
  // It arrives some 190 m high at the second item.
  const FlownMission flown =
      fly({command(16, 3000, 0, 300), command(16, 3300, 0, 100), order(20, {0, 0, 0, 0})}, kPlane);
  EXPECT_LT(outside(flown, 1650, 0, 140), 0.1);
  EXPECT_GT(outside(flown, 1650, 0, 240), 50);
}

TEST(FlownMission, AMinimumGroundSpeedStays) {
  const auto fastest = [](const MissionCommand& first, const MissionCommand& second) {
    const FlownMission flown = fly({command(16, -2000, 0, 100), first, second,
                                    command(16, 0, 0, 100), command(16, 2000, 0, 100)},
                                   kPlane);
    const std::size_t last = flown.parts.size() - 1;
    for (std::size_t n = 1; n <= last; ++n) {
      if (flown.parts[n].command == 4) {
        return flown.parts[n].time.min_s - flown.parts[n - 1].time.min_s;
      }
    }
    return 0.0;
  };
  const MissionCommand ground = order(178, {1, 20, -1, 0});
  const MissionCommand slow = order(178, {0, 10, -1, 0});
  EXPECT_LT(fastest(ground, slow), 2000 / 19.0);
  EXPECT_LT(fastest(order(178, {0, 20, -1, 0}), order(178, {1, 15, -1, 0})), 2000 / 19.0);
  EXPECT_GT(fastest(slow, slow), 2000 / 13.0);
}

/// Level but for one peak, 40 m high.
class Peak final : public Environment, public Ground {
 public:
  static constexpr double kAt = 440;  // metres east of home; between nodes of ArduPilot's grid

 private:
  static double height_at(double x, double y) {
    return kHome + 40 * std::max(0.0, 1 - std::hypot(x - kAt, y) / 30);
  }
  Box do_bounds() const override { return {{-1e4, -1e4, 0}, {1e4, 1e4, 1000}}; }
  double do_clearance(const Vec3& p) const override { return p.z() - height_at(p.x(), p.y()); }
  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double x, double y) const override { return height_at(x, y); }
  double do_gap(const Vec3& a, const Vec3& b, double) const override {
    return std::min(a.z(), b.z()) - kHome - 40;
  }
};

TEST(FlownMission, ArduPilotsGroundIsInterpolatedInAGrid) {
  World world = altiplan::testing::world_of(std::make_shared<Peak>(), "peak");
  world = world.with_frame(flat().frame());
  const FlownMission flown =
      fly({command(22, 0, 0, 60), command(16, 100, 0, 60, 10), command(16, 900, 0, 60, 10)},
          kCopter, {}, world);
  EXPECT_LT(outside(flown, Peak::kAt, 0, 61), 0.1);  // does not see the peak
  EXPECT_LT(outside(flown, Peak::kAt, 0, 95), 5);    // or follows it
  EXPECT_GT(outside(flown, Peak::kAt, 0, 50), 5);
}

// Flown over the Alps: 3 m outside of the band.
TEST(FlownMission, ArduPilotReadsItsGridBesideThePlace) {
  // 65 km east of a whole degree, home in the north of a block and the item in the next.
  const Frame frame = Frame::geographic(8.85, 46.646, 46.646);
  const World world = rising(0.5).with_frame(frame);
  formats::MissionFile plan;
  plan.home = {8.85, 46.646, kHome, formats::AltitudeFrame::sea};
  for (const double north : {0.0, 300.0}) {
    MissionCommand item = command(north == 0 ? 22 : 16, 0, 0, 60, 10);
    const auto [lon, lat] = frame.to_lonlat(0, north);
    item.lon = lon;
    item.lat = lat;
    plan.commands.push_back(item);
  }
  const FlownMission flown = fly_mission(plan, kCopter, world, {});
  EXPECT_LT(outside(flown, 0, 300, 64), 0.1);
  EXPECT_GT(outside(flown, 0, 300, 72), 2);
}

TEST(FlownMission, APlanesCircleGrowsWithItsHeight) {
  const auto radius_at = [](double height) {
    MissionCommand circle = command(18, 1500, 0, height);
    circle.params = {1, 0, 150, 0};
    const FlownMission flown = fly({command(16, 0, 0, height), circle}, kPlane);
    double radius = 0;
    for (const Strip& strip : part(flown, "its circle").strips) {
      radius = std::max(radius, (strip.from.head<2>() - Eigen::Vector2d(1500, 0)).norm());
    }
    return radius;
  };
  EXPECT_GT(radius_at(100), 150 * 1.2);  // true airspeed, squared, and the swing onto it
  EXPECT_GT(radius_at(2600), radius_at(100) * 1.25);
}

TEST(FlownMission, APlaneTurnsWiderThanItSeeks) {
  // Back by 150 degrees, beyond the item: flown with 60 m of radius at 23.7 m/s, and 10 m lower.
  FlightOptions options;
  options.parameters = {
      {"AIRSPEED_CRUISE", 22}, {"WP_RADIUS", 50}, {"NAVL1_PERIOD", 15}, {"ROLL_LIMIT_DEG", 65}};
  MissionCommand beyond = command(16, -1672, -250, 95);
  beyond.params = {0, 0, 60, 0};
  const FlownMission flown =
      fly({command(16, -1470, -756, 95), beyond, command(16, -1065, -710, 95)}, kPlane, options);
  for (const auto& [x, y] : {std::pair(-1647, -104), {-1587, -145}, {-1564, -215}, {-1551, -289}}) {
    EXPECT_LT(outside(flown, x, y, 95), 0.1) << x;
  }
}

TEST(FlownMission, APlaneThatPointsAtItsCircleMayBeBetweenTwoWays) {
  // Back by 150 degrees onto a circle: the slow join the line, the fast point at the circle.
  FlightOptions options;
  options.parameters = {
      {"AIRSPEED_CRUISE", 22}, {"WP_RADIUS", 60}, {"NAVL1_PERIOD", 15}, {"ROLL_LIMIT_DEG", 65}};
  MissionCommand turn = command(16, 0, 0, 650);
  turn.params = {0, 60, 0, 0};
  MissionCommand circle = command(18, 268, 1028, 650);
  circle.params = {2, 0, -300, 0};
  const FlownMission flown = fly({command(16, -379, 846, 650), turn, circle}, kPlane, options);
  for (const auto& [x, y] : {std::pair(137, 206), {152, 300}, {175, 450}}) {
    EXPECT_LT(outside(flown, x, y, 650), 0.1) << y;
  }
}

TEST(FlownMission, APlaneLevelsOffAboveItsTakeOff) {
  FlightOptions options;
  options.runway_deg = 90;
  const FlownMission flown =
      fly({command(22, 0, 0, 50), command(16, 1600, 0, 70)}, kPlane, options);
  EXPECT_LT(outside(flown, 230, 0, 62), 0.1);
  EXPECT_LT(outside(flown, 500, 0, 69), 0.1);  // at once, above the ramp
}

TEST(FlownMission, APlaneTakesOffAnywhereWithinTenDegrees) {
  FlightOptions options;
  options.runway_deg = 90;
  const FlownMission flown =
      fly({command(22, 0, 0, 50), command(16, 1600, 0, 50)}, kPlane, options);
  for (int degrees = -10; degrees <= 10; ++degrees) {
    const double course = radians(degrees);
    EXPECT_LT(outside(flown, 650 * std::cos(course), 650 * std::sin(course), 48), 0.1) << degrees;
  }
}

// Flown at a slope of 20 %: from 60 m above the ground down to 0.4 m.
TEST(FlownMission, ASlowCopterLosesTheGroundOnItsCircle) {
  MissionCommand circle = command(18, 230, 0, 60, 10);
  circle.params = {1, 0, 200, 0};
  const auto lowest = [&](double rate) {  // above the ground
    const FlownMission flown = fly(
        {command(22, 0, 0, 60), order(178, {2, rate, -1, 0}), order(178, {3, rate, -1, 0}), circle},
        kCopter, {}, rising(0.2));
    double height = kInfinity;
    for (const Strip& strip : part(flown, "its circle").strips) {
      height = std::min(height, strip.from.z() - kHome - 0.2 * strip.from.x());
    }
    return height;
  };
  EXPECT_LT(lowest(0.3), 0.5);
  EXPECT_GT(lowest(2.5), 45);
}

TEST(FlownMission, WhatFollowsAnEndlessItemIsFlown) {
  const std::vector<MissionCommand> landing = {command(16, 900, 0, 60), command(16, 500, 0, 40),
                                               command(21, 0, 0, 0)};
  for (const int endless : {17, 177}) {
    std::vector<MissionCommand> mission = {command(16, -900, 0, 100), command(16, 900, 900, 100)};
    mission.push_back(endless == 17 ? command(17, 0, 900, 100) : order(177, {1, -1, 0, 0}));
    mission.insert(mission.end(), landing.begin(), landing.end());
    for (const Autopilot& autopilot : {kPlane, kCopter}) {
      const FlownMission flown = fly(mission, autopilot);
      EXPECT_TRUE(has_rule(flown, "never_ends")) << endless;
      EXPECT_FALSE(has_rule(flown, "not_flown")) << endless;
      EXPECT_EQ(flown.parts[flown.parts.size() - 2].command, 5U) << endless;
      EXPECT_LT(outside(flown, 500, 0, 40), 10) << endless;
    }
  }
}

TEST(FlownMission, AnAeroplanesLandingIsAsFlatAsItSinks) {
  const auto land = [](double before, double height) {
    return fly(
        {command(16, -900, 0, height), command(16, -before, 0, height), command(21, 0, 0, 0)},
        kPlane);
  };
  EXPECT_FALSE(has_rule(land(600, 60), "sink_rate"));
  EXPECT_TRUE(has_rule(land(100, 100), "sink_rate"));
  EXPECT_TRUE(has_rule(land(20, 300), "sink_rate"));
}

TEST(FlownMission, AnIgnoredSpeedIsSaid) {
  const auto order_of = [](double type, double speed) {
    return fly(
        {command(16, -900, 0, 100), order(178, {type, speed, -1, 0}), command(16, 0, 0, 100)},
        kPlane);
  };
  EXPECT_TRUE(has_rule(order_of(0, 60), "speed"));
  EXPECT_TRUE(has_rule(order_of(2, 5), "speed"));
  EXPECT_FALSE(has_rule(order_of(0, 15), "speed"));
  EXPECT_FALSE(has_rule(order_of(0, -2), "speed"));
}

TEST(FlownMission, AClimbBeyondAHundredKilometresIsNotJudged) {
  FlightOptions options;
  options.runway_deg = 90;
  const auto climb = [&](double height) {
    return fly({command(22, 0, 0, height), command(16, 1600, 0, height)}, kPlane, options);
  };
  EXPECT_FALSE(has_rule(climb(5000), "not_judged"));
  EXPECT_TRUE(has_rule(climb(30'000), "not_judged"));
  EXPECT_LT(part(climb(30'000), "the climb after take-off").strips.size(), 10U);
}

// ArduPilot's aeroplane flew 141 m from the centre of such a circle.
TEST(FlownMission, WindTakesAPlaneOutWhenItJoinsACircle) {
  FlightOptions options;
  options.parameters = {{"AIRSPEED_CRUISE", 22},
                        {"AIRSPEED_MIN", 10},
                        {"WP_LOITER_RAD", 80},
                        {"NAVL1_PERIOD", 15},
                        {"ROLL_LIMIT_DEG", 65}};
  options.wind_mps = 4.1;
  const FlownMission flown =
      fly({command(16, -1000, 0, 150), command(17, 0, 0, 150)}, kPlane, options);
  EXPECT_LT(outside(flown, 0, 143, 150), 0.1);
}

TEST(FlownMission, OrderedRatesOfClimbAndDescentCount) {
  const auto time_of_leg = [](double type, double rate, double height) {
    const FlownMission flown =
        fly({command(22, 0, 0, 200), order(178, {type, rate, -1, 0}), command(16, 10, 0, height)},
            kCopter);
    const TimeSpan end = part(flown, "").time;
    const TimeSpan begin = part(flown, "the climb after take-off").time;
    return TimeSpan{end.min_s - begin.min_s, end.max_s - begin.max_s};
  };
  EXPECT_GT(time_of_leg(2, 1, 300).min_s, 90);  // 100 m at 1 m/s, in place of 2.5
  EXPECT_LT(time_of_leg(2, 5, 300).max_s, 30);
  EXPECT_GT(time_of_leg(3, 0.5, 100).min_s, 180);
  EXPECT_LT(time_of_leg(2, 1, 100).max_s, 80);  // its descent is not changed
  const auto is_judged = [](double rate) {
    return !has_rule(
        fly({command(22, 0, 0, 200), order(178, {2, rate, -1, 0}), command(16, 10, 0, 300)},
            kCopter),
        "not_judged");
  };
  EXPECT_TRUE(is_judged(4));
  EXPECT_FALSE(is_judged(30));  // no copter of ArduPilot's climbs so fast
}

TEST(FlownMission, APlanesSpeedChangesOnTheNextWay) {
  const FlownMission flown = fly({command(16, -2000, 0, 100), command(16, 0, 0, 100),
                                  order(178, {0, 20, -1, 0}), command(16, 0, 2000, 100)},
                                 kPlane);
  TimeSpan before;
  TimeSpan last;
  for (const FlownPart& one : flown.parts) {
    if (one.command == 3) {
      last = one.time;
      break;
    }
    before = one.time;
  }
  EXPECT_LT(last.min_s - before.min_s, 2000 / 19.0);  // from 12 m/s to 20
  EXPECT_GT(last.max_s - before.max_s, 2000 / 13.0);
}

TEST(FlownMission, ACircleAfterACircleIsNotJudged) {
  MissionCommand turns = command(18, 900, 0, 100);
  turns.params = {1, 0, 80, 0};
  const FlownMission flown =
      fly({command(16, 0, 0, 100), turns, command(31, 1400, 0, 100)}, kPlane);
  EXPECT_TRUE(has_rule(flown, "not_judged"));
  EXPECT_FALSE(has_rule(fly({command(16, 0, 0, 100), turns}, kPlane), "not_judged"));
}

TEST(FlownMission, AHomeThatIsSetOnACircleIsNotJudged) {
  MissionCommand circle = command(18, 0, 500, 50);
  circle.params = {1, 0, 60, 0};
  const MissionCommand here = order(179, {1, 0, 0, 0});
  EXPECT_TRUE(has_rule(fly({command(22, 0, 0, 50), circle, here}, kCopter), "not_judged"));
  EXPECT_FALSE(
      has_rule(fly({command(22, 0, 0, 50), command(16, 0, 500, 50), here}, kCopter), "not_judged"));
}

TEST(FlownMission, AHoldThatArduPilotCannotStoreIsNotJudged) {
  for (const int number : {16, 19}) {
    for (const double hold : {-1.0, 0.0, 65534.0, 65535.0, 65537.0}) {
      const bool is_stored = hold >= 0 && hold < 65535;
      MissionCommand holds = command(number, 500, 0, 20);
      holds.params = {hold, 0, 0, 0};
      EXPECT_NE(has_rule(fly({command(22, 0, 0, 20), holds}, kCopter), "not_judged"), is_stored)
          << number << " " << hold;
    }
  }
}

/// Rounds, of which only the first few are flown one by one; a hovering vehicle's to the take-off.
TEST(FlownMission, RoundsOfAJumpTakeAsLongEach) {
  for (const auto& [autopilot, target] :
       {std::pair(kCopter, 1.0), std::pair(kCopter, 2.0), std::pair(kPx4Copter, 1.0),
        std::pair(kPx4Copter, 2.0), std::pair(kPlane, 2.0)}) {
    const auto flown = [&, target = target, autopilot = autopilot](double rounds) {
      return fly({command(22, 0, 0, 60), command(16, 900, 0, 60), command(16, 900, 900, 60),
                  order(177, {target, rounds, 0, 0}), command(16, 1800, 900, 80),
                  command(21, 1800, 1800, 0)},
                 autopilot);
    };
    const auto strips = [](const FlownMission& mission) {
      std::size_t count = 0;
      for (const FlownPart& one : mission.parts) {
        count += one.strips.size();
      }
      return count;
    };
    const auto slow = flown(3).time;
    const FlownMission some = flown(20);
    const auto few = some.time;
    const auto more = flown(21).time;
    const FlownMission all = flown(65535);
    EXPECT_GT(few.min_s, slow.min_s);
    const double each = more.min_s - few.min_s;
    const double each_slow = more.max_s - few.max_s;
    EXPECT_GT(each, 0);
    EXPECT_NEAR(all.time.min_s, few.min_s + each * (65535 - 20), 1e-6 * all.time.min_s);
    EXPECT_NEAR(all.time.max_s, few.max_s + each_slow * (65535 - 20), 1e-6 * all.time.max_s);
    EXPECT_EQ(strips(all), strips(some));
  }
}

// It sinks 2.5 m/s at some 14 m/s over the ground: its slope leads to a point some 5 m above the
// ground, from which a flare of 0.25 m/s takes 20 s.
TEST(FlownMission, AnAeroplanesLandingLeadsToItsFlare) {
  const std::vector<MissionCommand> commands = {command(16, -1500, 0, 120),
                                                command(16, -700, 0, 120), command(21, 0, 0, 0)};
  const FlownMission flown = fly(commands, kPlane);
  for (const double before : {700.0, 600.0, 400.0, 250.0}) {
    EXPECT_LE(outside(flown, -before, 0, 5 + 115 * (before - 250) / 450), 0) << before;
    EXPECT_LE(outside(flown, -before, 0, 120 * before / 700), 0) << before;  // a quick flare
  }
  EXPECT_LE(outside(flown, -120, 0, 2.5), 0);
  EXPECT_GT(outside(flown, -600, 0, 60), 10);
  EXPECT_EQ(part(flown, "the landing").foot_m, kHome);
  EXPECT_LE(outside(flown, 190, 0, 1), 0);
  EXPECT_EQ(part(flown, "the roll-out").foot_m, kInfinity);
  FlightOptions quick;
  quick.parameters = {{"LAND_FLARE_SEC", {0}}, {"LAND_FLARE_ALT", {1}}, {"TECS_LAND_SINK", {1}}};
  EXPECT_GT(outside(fly(commands, kPlane, quick), -250, 0, 5), 10);
}
}  // namespace
}  // namespace altiplan::host::flown_mission_test
