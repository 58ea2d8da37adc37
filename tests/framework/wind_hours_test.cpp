// SPDX-License-Identifier: Apache-2.0
// Wind that changes with the hour: how legs are timed, priced and judged in it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "altiplan/body.hpp"
#include "altiplan/check.hpp"
#include "altiplan/flown_route.hpp"
#include "altiplan/measures.hpp"
#include "support/drag_power.hpp"
#include "support/support.hpp"

namespace altiplan::wind_hours_test {
namespace {

constexpr double kSpeed = 20;
const Box kVolume{{0, 0, 0}, {2000, 1500, 200}};

Vec3 random_velocity(RandomStream& random, double strongest) {
  return strongest * random.uniform() * unit_heading(random.uniform(-kPi, kPi));
}

std::vector<Wind::Layer> random_layers(RandomStream& random, double strongest) {
  if (random.uniform() < 0.5) {
    return {{-kInfinity, random_velocity(random, strongest)},
            {100, random_velocity(random, strongest)}};
  }
  std::vector<std::array<float, 2>> velocities;
  for (int n = 0; n < 12; ++n) {
    const Vec3 velocity = random_velocity(random, strongest);
    velocities.push_back({float(velocity.x()), float(velocity.y())});
  }
  return {{-kInfinity,
           {0, 0, 0},
           std::make_shared<WindGrid>(std::array{0.0, 0.0}, std::array{500.0, 500.0},
                                      std::array{4, 3}, std::move(velocities))}};
}

/// Changes three times within about the first minute and a half.
Wind random_wind(RandomStream& random, double strongest) {
  Wind wind{random_layers(random, strongest), {}};
  double from_s = 0;
  for (int n = 0; n < 3; ++n) {
    from_s += random.uniform(1, 30);
    wind.changes.push_back({from_s, random_layers(random, strongest)});
  }
  return wind;
}

Request request_in(Wind wind, bool wing = true) {
  Request request = testing::request_in(World(), {10, 10, 50}, {1990, 1490, 50}, kVolume);
  request.vehicle.speed_mps = kSpeed;
  if (wing) {
    request.vehicle.wing = Wing{kSpeed, radians(30), radians(20), radians(20)};
  }
  request.wind = std::move(wind);
  return request;
}

/// Flies a straight leg in small steps of time: calls `step(t, place, wind, seconds)`, until it
/// arrives or `step` returns false.
template <class Step>
void fly_in_steps(const Vec3& from, const Vec3& to, double time_s, const Request& request,
                  double seconds, const Step& step) {
  const Vec3 way = to - from;
  for (double share = 0; share < 1; time_s += seconds) {
    const Vec3 here = from + share * way;
    const Vec3 wind = request.wind.in_force(time_s).at(here);
    const double speed = request.vehicle.wing ? ground_speed(way, kSpeed, wind).value_or(0)
                                              : kSpeed * way.head<2>().norm() / way.norm();
    const double steps = std::min(1.0, (1 - share) * way.head<2>().norm() / (speed * seconds));
    if (!step(time_s, here, wind, steps * seconds)) {
      return;
    }
    share = steps < 1 ? 1 : share + speed * seconds / way.head<2>().norm();
  }
}

TEST(WindHours, IsThatOfTheTime) {
  Wind wind;
  wind.changes = {{60, {{-kInfinity, {5, 0, 0}}}}, {120, {}}};
  EXPECT_FALSE(wind.is_calm());
  EXPECT_EQ(wind.max_speed(), 5);
  EXPECT_TRUE(wind.in_force(59.9).is_calm());
  EXPECT_EQ(wind.in_force(60).at({0, 0, 0}), Vec3(5, 0, 0));
  EXPECT_TRUE(wind.in_force(120).is_calm());
  EXPECT_EQ(wind.in_force_until(0), 60);
  EXPECT_EQ(wind.in_force_until(60), 120);
  EXPECT_EQ(wind.in_force_until(120), kInfinity);
}

TEST(WindHours, TimesEqualFlightInSmallSteps) {
  RandomStream random(1);
  for (int n = 0; n < 100; ++n) {
    Request request = request_in(random_wind(random, 15));
    const Vec3 from = random.in(kVolume);
    const Vec3 to(random.in(kVolume).x(), random.in(kVolume).y(), from.z());
    const double time_s = random.uniform(0, 60);
    double expected = 0;
    fly_in_steps(from, to, time_s, request, 1e-3,
                 [&](double, const Vec3&, const Vec3&, double seconds) {
                   expected += seconds;
                   return true;
                 });
    EXPECT_NEAR(leg_duration(Leg::straight(from, to), time_s, request), expected, 0.02);
  }
}

TEST(WindHours, EnergyEqualsFlightInSmallSteps) {
  RandomStream random(2);
  const testing::DragPower power;
  for (int n = 0; n < 50; ++n) {
    const Request request = request_in(random_wind(random, 12), false);
    const Vec3 from = random.in(kVolume);
    const Vec3 to(random.in(kVolume).x(), random.in(kVolume).y(), from.z());
    const double time_s = random.uniform(0, 60);
    const Vec3 ground = kSpeed * (to - from).normalized();
    double expected = 0;
    fly_in_steps(from, to, time_s, request, 1e-3,
                 [&](double, const Vec3&, const Vec3& wind, double seconds) {
                   expected += power.watts({(ground - wind).norm(), 0, 0, 0}) * seconds / 3600;
                   return true;
                 });
    EXPECT_NEAR(leg_energy(Leg::straight(from, to), time_s, request, power), expected,
                1e-3 * expected);
    Request later = request;
    later.start.time_s = time_s;
    EXPECT_NEAR(flown_energy(Route{from, to}, later, power), expected, 1e-3 * expected);
    // What it takes to accelerate falls into the wind of its time as well.
    later.vehicle.acceleration.mps2 = 1e6;
    EXPECT_NEAR(flown_energy(Route{from, to}, later, power), expected, 1e-3 * expected);
  }
}

TEST(WindHours, HoursDoNotChangeTheTimeOfACopter) {
  RandomStream random(4);
  for (int n = 0; n < 50; ++n) {
    Request request = request_in(random_wind(random, 12), false);
    request.vehicle.acceleration = {2, 1, 1, 5};
    Request calm = request;
    calm.wind = {};
    const Route route{random.in(kVolume), random.in(kVolume), random.in(kVolume)};
    EXPECT_EQ(flown_time(route, request), flown_time(route, calm));
  }
}

TEST(WindHours, ABodyIsNotJudged) {
  Request request = request_in({{}, {{600, {}}}});
  const Route route{request.start.position, request.goal.position};
  EXPECT_TRUE(check(route, request).ok());
  auto body = std::make_shared<Body>();
  request.vehicle.body = body;
  EXPECT_FALSE(check(route, request).ok());
}

TEST(WindHours, ALegIsRefusedIfItsCourseIsNotHeldAtItsTime) {
  RandomStream random(3);
  int refused = 0;
  for (int n = 0; n < 200; ++n) {
    Request request = request_in(random_wind(random, 35));
    request.start.position = random.in(kVolume);
    const Vec3 to = random.in(kVolume);
    request.goal.position = Vec3(to.x(), to.y(), request.start.position.z());
    bool holds = true;
    fly_in_steps(request.start.position, request.goal.position, 0, request, 1e-3,
                 [&](double, const Vec3&, const Vec3& wind, double) {
                   return holds = ground_speed(request.goal.position - request.start.position,
                                               kSpeed, wind)
                                      .has_value();
                 });
    const Route route{request.start.position, request.goal.position};
    EXPECT_EQ(check(route, request).ok(), holds) << n;
    refused += holds ? 0 : 1;
  }
  EXPECT_GT(refused, 20);
  EXPECT_LT(refused, 180);
}

TEST(WindHours, WithoutATimeALegMustHoldInEachWind) {
  Request request = request_in({{{-kInfinity, {3, 0, 0}}}, {{600, {{-kInfinity, {0, 25, 0}}}}}});
  const Vec3 from(100, 100, 50);
  const Vec3 to(900, 100, 50);
  EXPECT_FALSE(leg_ok(std::nullopt, from, to, request));
  EXPECT_FALSE(leg_violations(std::nullopt, Leg::straight(from, to), request, 0).empty());
  EXPECT_TRUE(leg_violations(Arrival{}, Leg::straight(from, to), request, 0).empty());
  EXPECT_FALSE(
      leg_violations(Arrival{std::nullopt, 590}, Leg::straight(from, to), request, 0).empty());
  request.wind.changes[0].layers = {{-kInfinity, {0, 15, 0}}};
  EXPECT_TRUE(leg_ok(std::nullopt, from, to, request));
}

/// Two halves of a turn, the second in another wind from the moment it begins.
TEST(WindHours, ATurnGoesOnByItsHeadingThroughTheAir) {
  constexpr double kRadius = 100;
  const double half_s = kRadius * kPi / 2 / kSpeed;
  const Vec3 before(5, 0, 0);
  const Vec3 after(-3, 6, 0);
  Request request = request_in({{{-kInfinity, before}}, {{half_s, {{-kInfinity, after}}}}});
  request.limits.min_turn_radius = kRadius;
  const Pose start{{1000, 500, 50}, 0};
  const Leg first = Leg::turning(start, kPi / 2, kRadius, 0, half_s * before);
  const auto with = [&](const Leg& second) {
    Route route{start.position};
    route.push_back(first);
    route.push_back(second);
    request.start.position = route.front();
    request.goal.position = route.back();
    return check(route, request);
  };
  const Pose there{first.to, kPi / 2};
  EXPECT_TRUE(with(Leg::turning(there, kPi / 2, kRadius, 0, half_s * after)).ok());
  EXPECT_FALSE(with(Leg::turning(there, kPi / 2, kRadius, 0, half_s * before)).ok());
  // By its track over the ground it would begin with a corner.
  const Vec3 track = kSpeed * unit_heading(kPi / 2) + before;
  const double heading = *heading_on(track, kSpeed, after);
  EXPECT_FALSE(with(Leg::turning({first.to, heading}, kPi / 2, kRadius, 0, half_s * after)).ok());
  // As one turn it would be in both winds.
  Route whole{start.position};
  whole.push_back(Leg::turning(start, kPi, kRadius, 0, 2 * half_s * before));
  request.goal.position = whole.back();
  const CheckResult result = check(whole, request);
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.violations.front().message.find("while the wind changes"), std::string::npos)
      << result.violations.front().message;
}

TEST(WindHours, NoTimeIsKnownAfterALegThatIsNotFlown) {
  Request request = request_in({{{-kInfinity, {0, 25, 0}}}, {{600, {}}}});
  request.limits.min_turn_radius = 100;
  Route route{{100, 500, 50}, {900, 500, 50}};
  route.push_back(Leg::turning({route.back(), 0}, kPi / 2, 100, 0));
  route.push_back(Leg::straight(route.back(), route.back() + Vec3(0, 300, 0)));
  request.start.position = route.front();
  request.goal.position = route.back();
  EXPECT_EQ(measure(route, request).duration_s, kInfinity);
  for (const Violation& violation : check(route, request).violations) {
    EXPECT_EQ(violation.message.find("while the wind changes"), std::string::npos)
        << violation.message;
  }
}

TEST(WindHours, TheClimbThroughTheAirIsThatOfTheTime) {
  Request request = request_in({{{-kInfinity, {10, 0, 0}}}, {{30, {{-kInfinity, {-10, 0, 0}}}}}});
  request.limits.max_climb = radians(3);
  const auto ok = [&](const Vec3& from, double climb_deg) {
    request.start.position = from;
    request.goal.position = from + Vec3(600, 0, 600 * std::tan(radians(climb_deg)));
    return check(Route{request.start.position, request.goal.position}, request).ok();
  };
  // With the wind behind, 600 m take 20 s, or 400 m through the air; against it 60 s, 1,200 m.
  EXPECT_FALSE(ok({100, 100, 50}, 2.5));
  EXPECT_TRUE(ok({100, 100, 50}, 1.9));
  request.start.time_s = 30;
  EXPECT_TRUE(ok({100, 100, 50}, 5.5));
  request.start.time_s = 20;  // half of the way in each
  EXPECT_FALSE(ok({100, 100, 50}, 2.5));
}
}  // namespace
}  // namespace altiplan::wind_hours_test
