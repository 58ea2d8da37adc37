// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/kit/dubins/airplane.hpp"
#include "flight_scene.hpp"
#include "host/flight/follow_error.hpp"
#include "host/flight/track_judge.hpp"
#include "host/flight/wing_guidance.hpp"

namespace altiplan::host::wing_flight_test {
namespace {

constexpr double kAirspeed = 25;

/// An aeroplane in free space, from (0, 0, 500); its turn radius is 110 m.
FlightSetup setup(const Route& route, const Vec3& wind = Vec3::Zero()) {
  FlightSetup all;
  Request& request = all.request;
  request = testing::request_in(World(), route.front(), route.back(),
                                {{-20e3, -20e3, 0}, {20e3, 20e3, 2000}});
  request.vehicle.speed_mps = kAirspeed;
  request.vehicle.wing = Wing{kAirspeed, radians(30), radians(8), radians(8)};
  if (wind != Vec3::Zero()) {
    request.wind.layers.push_back({-kInfinity, wind});
  }
  apply_constraints(request, {}, AppliesTo::track);
  all.route_request = request;
  all.route = route;
  all.truth = *request.world;
  return all;
}

double turn_radius() { return Wing{kAirspeed, radians(30)}.turn_radius(); }

/// East, a turn to the left by `turn`, and on; in wind the turn drifts.
Route bend(double radius, double turn, double climb = 0, const Vec3& wind = Vec3::Zero()) {
  Route route;
  const double into_wind = std::asin(-wind.y() / kAirspeed);  // heading of a course to the east
  const Vec3 corner(1500, 0, 500);
  route.push_back(Leg::straight({0, 0, 500}, corner));
  const Vec3 drift = std::abs(turn) * radius / kAirspeed * wind;
  route.push_back(Leg::turning({corner, into_wind}, turn, radius, climb, drift));
  const Vec3 onward = kAirspeed * unit_heading(into_wind + turn) + wind;
  route.push_back(Leg::straight(route.back(), route.back() + 60 * onward));
  return route;
}

/// Solved without a violation, and so by the judge of tracks that has not flown it.
FlightResult flown_well(const FlightSetup& all) {
  FlightResult result = fly(all);
  EXPECT_EQ(result.status, RunStatus::solved) << result.message;
  EXPECT_TRUE(result.reached);
  const TrackVerdict verdict = judge_track(result.track, all);
  EXPECT_TRUE(verdict.check.ok()) << verdict.check.violations.front().message;
  EXPECT_TRUE(verdict.reached);
  return result;
}

TEST(WingFlight, ConvergesToAStraightLegInWind) {
  for (const Vec3& wind : {Vec3(0, 8, 0), Vec3(-8, 0, 0), Vec3(8, 0, 0), Vec3(14, -14, 0)}) {
    FlightSetup all = setup({{0, 0, 500}, {10000, 0, 500}}, wind);
    all.request.start.velocity = {0, 20, 0};  // across the leg, on the wrong heading
    const FlightResult result = flown_well(all);
    EXPECT_GT(*result.cross_track_max_m, 10);
    EXPECT_NEAR(result.track.back().second.y(), 0, 1e-6) << wind.transpose();
    EXPECT_NEAR(result.track.back().second.x(), 10000, 2);
    EXPECT_NEAR(*result.height_error_max_m, 0, 1e-9);
  }
}

TEST(WingFlight, StaysOnTurnsOfAFewMoreMetresThanItsRadius) {
  for (const double turn : {0.5, 1.5, 3.0, -6.0, 12.0}) {
    const FlightResult calm = flown_well(setup(bend(1.2 * turn_radius(), turn)));
    EXPECT_LT(*calm.cross_track_max_m, 1.2) << turn;
    EXPECT_LE(*calm.cross_track_p999_m, *calm.cross_track_max_m);
    const Vec3 wind(4, -6, 0);
    const Route drifted = bend(1.2 * turn_radius(), turn, 0, wind);
    const FlightResult windy = flown_well(setup(drifted, wind));
    EXPECT_LT(*windy.cross_track_max_m, 3) << turn;
  }
}

TEST(WingFlight, ClimbsAlongTheRoute) {
  const double turn = 9;
  const double climb = turn * 1.2 * turn_radius() * std::tan(radians(7));
  const FlightResult result = flown_well(setup(bend(1.2 * turn_radius(), turn, climb)));
  EXPECT_LT(*result.height_error_max_m, 2);
  EXPECT_NEAR(result.track.back().second.z(), 500 + climb, 0.01);
}

TEST(WingFlight, CutsTheCornersOfAPolyline) {
  const FlightSetup all = setup({{0, 0, 500}, {2000, 0, 500}, {2000, 2000, 500}});
  const FlightResult result = flown_well(all);
  EXPECT_GT(*result.cross_track_max_m, 20);
}

TEST(WingFlight, ArrivesAtTheEndOfEveryRoute) {
  RandomStream random(4);
  const kit::AirplaneLimits limits{1.25 * turn_radius(), radians(7), radians(7)};
  for (int n = 0; n < 600; ++n) {
    const auto pose = [&] {
      return Pose{random.in({{-2000, -2000, 400}, {2000, 2000, 500}}), random.uniform(-kPi, kPi)};
    };
    const Pose from = pose();
    const Pose to = pose();
    Route route{from.position};
    for (const Leg& leg : kit::airplane_path(from, to, limits)->legs(from, to.position)) {
      route.push_back(leg);
    }
    FlightSetup all = setup(route);
    // The circle that the last turn would go on with.
    const Vec3 across(-std::sin(to.heading), std::cos(to.heading), 0);
    all.request.goal = {to.position + 150 * across, 0, std::nullopt, Loiter{150, 1}};
    const FlightResult result = fly(all);
    EXPECT_TRUE(result.reached) << n << ": " << result.message;
  }
}

TEST(WingFlight, RepeatsExactly) {
  const FlightSetup all = setup(bend(1.2 * turn_radius(), 2, 30, {4, -6, 0}), {4, -6, 0});
  EXPECT_EQ(fly(all).track, fly(all).track);
}

TEST(WingFlight, SamplingDoesNotChangeTheFlight) {
  FlightSetup all = setup(bend(1.2 * turn_radius(), 2));
  const FlightResult by_second = flown_well(all);
  all.step_s = 4;
  const FlightResult by_four = flown_well(all);
  EXPECT_NEAR(*by_second.cross_track_max_m, *by_four.cross_track_max_m, 1e-6);
  // No leg of the track is farther than a centimetre from the curve flown.
  EXPECT_LT(std::abs(by_second.measures.length_m - by_four.measures.length_m), 0.01);
}

TEST(WingFlight, WindMustBeBelowTheAirspeed) {
  FlightSetup all = setup({{0, 0, 500}, {3000, 0, 500}});
  all.request.wind.layers.push_back({400, {30, 0, 0}});
  const FlightResult result = fly(all);
  EXPECT_EQ(result.status, RunStatus::not_reached);
  EXPECT_EQ(result.message,
            "the wind of 30 m/s at a height of 500 m is not below the airspeed of 25 m/s: the "
            "aeroplane cannot hold its course there");
}

TEST(WingFlight, CrossesLayersOfWind) {
  FlightSetup all = setup({{0, 0, 500}, {6000, 0, 1100}});
  all.request.wind.layers = {{600, {0, 8, 0}}, {800, {-5, -8, 0}}};
  const FlightResult result = flown_well(all);
  EXPECT_LT(*result.cross_track_max_m, 30);
  EXPECT_NEAR(result.track.back().second.y(), 0, 0.01) << "it returns to the route";
}

TEST(WingFlight, PassesTheGoalWithinATenthOfItsTurnRadius) {
  const FlightResult at = flown_well(setup({{0, 0, 500}, {3000, 0, 500}}));
  EXPECT_NEAR(at.track.back().second.x(), 3000, 1.3);
  // It cannot make the turn before the goal.
  FlightSetup all = setup({{0, 0, 500}, {3000, 0, 500}, {3000, 60, 500}});
  const FlightResult beside = fly(all);
  EXPECT_EQ(beside.status, RunStatus::not_reached);
  EXPECT_EQ(beside.reason, Reason::route_ended);
  EXPECT_FALSE(beside.reached);
  EXPECT_NE(beside.message.find("passed the goal at a distance of "), std::string::npos)
      << beside.message;
  all.request.goal.tolerance_m = 200;
  EXPECT_EQ(fly(all).status, RunStatus::solved);
}

TEST(WingFlight, FliesFromLoiterToLoiter) {
  const double radius = 1.5 * turn_radius();
  for (const int sense : {1, -1}) {
    for (const Vec3& wind : {Vec3(0, 0, 0), Vec3(5, 6, 0)}) {
      // Tangents of two circles of one sense.
      const Vec3 side(0, -sense * radius, 0);
      FlightSetup all = setup({Vec3(0, 0, 500) + side, Vec3(3000, 0, 500) + side}, wind);
      all.request.start = {0, {0, 0, 500}, {0, 0, 0}, Loiter{radius, sense}};
      all.request.goal = {{3000, 0, 500}, 0, std::nullopt, Loiter{radius, sense}};
      const FlightResult result = flown_well(all);
      EXPECT_LT(*result.cross_track_max_m, 12);
      EXPECT_EQ(result.track.front().second, all.route.front());
      EXPECT_NEAR(distance_from(all.request.goal, result.track.back().second), 0, 1);
    }
  }
}

TEST(WingFlight, FliesTowardAPilotsSteps) {
  FlightScene scene;
  scene.setup.request.vehicle.wing = Wing{30, radians(35), radians(12), radians(12)};
  apply_constraints(scene.setup.request, {}, AppliesTo::track);
  scene.hide(layer("unknown", post(17000, 15050, 800)));
  const FlightResult result = fly(scene.setup);
  expect_flown(result, 2);
  EXPECT_TRUE(judge_track(result.track, scene.setup).check.ok());
  EXPECT_TRUE(result.cross_track_max_m);
}

TEST(WingGuidance, KeepsBankAndRollRateWithinTheirLimits) {
  const FlightSetup all = setup({{0, 0, 500}, {3000, 0, 500}}, {5, 12, 0});
  WingGuidance guidance(all.request);
  guidance.take_over(all.request.start, {1, 0, 0});
  State state{0, {0, 0, 500}, guidance.velocity({0, 0, 500}, 0)};
  RandomStream random;
  Vec3 reference(0, 0, 0);
  double bank = 0;
  double widest = 0;
  for (int i = 0; i < 20000; ++i) {
    if (i % 40 == 0) {
      for (double& coordinate : reference) {
        coordinate = 400 * random.uniform() - 200;
      }
    }
    const State next = guidance.fly(state, state.position + reference, 50, 0.05);
    EXPECT_LE(std::abs(guidance.bank()), radians(30) + 1e-12);
    EXPECT_LE(std::abs(guidance.bank() - bank), 0.05 * radians(60) + 1e-12);
    EXPECT_LE(std::abs(next.velocity.z()), kAirspeed * std::tan(radians(8)) + 1e-12);
    const Vec3 air = next.velocity - Vec3(5, 12, next.velocity.z());
    EXPECT_NEAR(air.norm(), kAirspeed, 1e-9);
    bank = guidance.bank();
    widest = std::max(widest, std::abs(bank));
    state = next;
  }
  EXPECT_NEAR(widest, radians(30), 1e-12) << "the limits were met";
}

TEST(WingTrack, FindsWhatAnAeroplaneCannotFly) {
  const FlightSetup all = setup({{0, 0, 500}, {3000, 0, 500}}, {0, 5, 0});
  const auto rules = [&](const Track& track) {
    std::vector<std::string> names;
    for (const Violation& violation : wing_violations(track, all.request, all.request.limits)) {
      names.push_back(violation.constraint + " " + std::to_string(violation.at));
    }
    return names;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(rules({{0, {0, 0, 500}}, {1, {25, 5, 500}}, {2, {50, 10, 503}}}), Names{});
  EXPECT_EQ(rules({{0, {0, 0, 500}}, {1, {25, 0, 500}}}), Names{"speed 0"});
  EXPECT_EQ(rules({{0, {0, 0, 500}}, {1, {25, 5, 500}}, {2, {25, 10, 500}}}), Names{"speed 1"});
  EXPECT_EQ(rules({{0, {0, 0, 500}}, {1, {25, 5, 500}}, {2, {50, 10, 504}}}),
            Names{"climb_angle 1"});
  EXPECT_EQ(rules({{0, {0, 0, 500}}, {1, {25, 5, 500}}, {2, {25, 35, 500}}}),
            Names{"turn_radius 1"});
}

TEST(WingTrack, CirclesOfTheTurnRadiusAreWithinTheLimits) {
  const FlightSetup all = setup({{0, 0, 500}, {3000, 0, 500}}, {0, 5, 0});
  for (const double dt : {0.05, 0.5, 1.0, 3.0}) {
    const auto circle = [&](double radius) {
      Track track;
      for (double t = 0; t < 60; t += dt) {
        const double turned = kAirspeed / radius * t;
        track.emplace_back(
            t, Vec3(radius * std::sin(turned), -radius * std::cos(turned) + 5 * t, 500));
      }
      return wing_violations(track, all.request, all.request.limits);
    };
    EXPECT_TRUE(circle(turn_radius()).empty());
    EXPECT_EQ(circle(0.98 * turn_radius()).back().constraint, "turn_radius");
  }
}

TEST(FollowError, QuantileIsExceededForTheRestOfTheTime) {
  FollowError error;
  EXPECT_FALSE(error.across_quantile(0.5));
  EXPECT_FALSE(error.height_max());
  error.add(3, -2, 2);
  error.add(1, 1, 7);
  error.add(9, 0, 1);
  EXPECT_EQ(error.across_quantile(1), 9);
  EXPECT_EQ(error.across_quantile(0.85), 3);
  EXPECT_EQ(error.across_quantile(0.65), 1);
  EXPECT_EQ(error.height_max(), 2);
}
}  // namespace
}  // namespace altiplan::host::wing_flight_test
