// SPDX-License-Identifier: Apache-2.0
// The judge of turns against steps by true distance, beside each kind of layer.
#include <gtest/gtest.h>

#include "altiplan/check.hpp"
#include "altiplan/random.hpp"
#include "altiplan/shape.hpp"
#include "support/support.hpp"

namespace altiplan::turn_oracle_test {
namespace {

using testing::make_environment;
using testing::world_of;

/// True if a point of the leg is blocked for a sphere of radius r, by steps no longer than the
/// clearance allows, and of at least `fine` metres.
bool steps_into(const Environment& layer, const Leg& leg, double r, double fine) {
  const double length = leg.length();
  for (double t = 0;;) {
    const Vec3 p = leg.at(std::min(t, 1.0));
    const double clearance = layer.clearance(p);
    if (clearance < r && layer.blocked(p, p, r)) {
      return true;
    }
    if (t >= 1) {
      return false;
    }
    // No leg is faster anywhere than twice its mean speed: the wind is at most half the airspeed.
    t += std::max(clearance - r, fine) / (3 * length);
  }
}

constexpr double kFine = 5e-3;  ///< shortest step, metres

struct Case {
  const char* name;
  World world;
  Box box;          ///< of the legs' starts
  double radius_m;  ///< of the turns, about
};

std::vector<Case> cases() {
  std::vector<Shape> shapes;
  RandomStream random(3);
  for (int n = 0; n < 40; ++n) {
    const Vec3 p = random.in({{-500, -500, 0}, {500, 500, 200}});
    const double size = random.uniform(5, 60);
    switch (n % 4) {
      case 0:
        shapes.push_back(Sphere{p, size});
        break;
      case 1:
        shapes.push_back(Cylinder{p.x(), p.y(), size, 0, p.z()});
        break;
      case 2:
        shapes.push_back(BoxShape{{p, p + Vec3(size, 2 * size, size)}});
        break;
      default:
        shapes.push_back(Prism{{{p.x(), p.y()}, {p.x() + 2 * size, p.y()}, {p.x(), p.y() + size}},
                               {},
                               20,
                               p.z() + 40});
    }
  }
  const std::string dem = (testing::configs() / "data/jacksboro_fault.tif").string();
  std::vector<Case> all;
  all.push_back({"shapes", world_of(shapes), {{-600, -600, 0}, {600, 600, 250}}, 80});
  const auto add = [&](const char* name, std::string_view yaml, const Box& box, double radius) {
    all.push_back({name, world_of(make_environment(name, yaml)), box, radius});
  };
  add("hills", "{count: 5}", {{0, 0, 200}, {40000, 40000, 1500}}, 2000);
  add("city", "{generate: complex}", {{0, 0, 0}, {400, 400, 100}}, 40);
  add("radar", "{at_m: [0, 0, 50], range_m: 500}", {{-900, -900, 0}, {900, 900, 600}}, 150);
  add("random_zones", "{seed: 3}", {{0, 0, 0}, {2000, 2000, 100}}, 80);
  add("terrain", "{file: '" + dem + "'}", {{4000, 4000, 300}, {9000, 9000, 800}}, 300);
  return all;
}

Leg random_leg(const Case& one, RandomStream& random) {
  const Pose from{random.in(one.box), random.uniform(-kPi, kPi)};
  const double turn = (random.integer(0, 1) == 0 ? 1 : -1) * random.uniform(0.01, 3 * kPi);
  const double radius = one.radius_m * random.uniform(0.2, 2);
  const double drift = random.integer(0, 2) == 0 ? 0.3 * radius * std::abs(turn) : 0;
  const double course = random.uniform(-kPi, kPi);
  return Leg::turning(from, turn, radius, random.uniform(-0.1, 0.1) * radius * std::abs(turn),
                      drift * unit_heading(course));
}

/// The judge's verdict on the leg's clearance alone.
bool is_free(const Case& one, const Leg& leg, double r) {
  Request request = testing::request_in(one.world, leg.from, leg.to, Box{});
  request.vehicle.radius_m = r;
  request.wind.layers = {{-kInfinity, leg.drift / leg.air_length() * request.vehicle.speed_mps}};
  for (const Violation& violation : leg_violations(std::nullopt, leg, request, 0)) {
    if (violation.constraint == "clearance") {
      return false;
    }
    EXPECT_EQ(violation.constraint, "ground") << violation.message;
  }
  return true;
}

void hold_to_steps(int legs, std::uint64_t seed) {
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.name);
    const Environment& layer = *one.world.layers().at(0).environment;
    const double slack = layer.over_approximation();
    RandomStream random(seed);
    int free = 0;
    int blocked = 0;
    for (int n = 0; n < legs; ++n) {
      const Leg leg = random_leg(one, random);
      const double r = random.uniform(0, 0.3) * one.radius_m;
      const bool said = is_free(one, leg, r);
      if (said) {
        ++free;
        ASSERT_FALSE(steps_into(layer, leg, r - 2e-6, kFine)) << n << ": missed at " << r;
      } else {
        ++blocked;
        ASSERT_TRUE(steps_into(layer, leg, r + slack + 2 * kFine, kFine))
            << n << ": invented at " << r;
      }
    }
    EXPECT_GT(free, legs / 50);
    EXPECT_GT(blocked, legs / 50);
  }
}

TEST(TurnOracle, TheJudgeMissesAndInventsNothing) { hold_to_steps(70, 1); }
TEST(NightlyTurnOracle, TheJudgeMissesAndInventsNothing) { hold_to_steps(17'000, 2); }

/// Turns that graze a solid at one point, from outside, from inside and along it.
TEST(TurnOracle, GrazingTurnsAreDecidedWithinTenMicrometres) {
  const double radius = 80;
  const double r = 10;
  const Leg turn = Leg::turning({{0, 0, 50}, 0}, 1.5 * kPi, radius, 0);  // about (0, 80)
  const auto blocked = [&](const Shape& shape) {
    return !is_free({"", world_of({shape}), {}, 0}, turn, r);
  };
  for (const double off : {-1e-5, 1e-5}) {
    const double gap = r + off;
    // Outside, at the foremost point; inside; around the same centre.
    EXPECT_EQ(blocked(BoxShape{{{radius + gap, -10, 0}, {200, 200, 100}}}), off < 0) << off;
    EXPECT_EQ(blocked(Sphere{{radius - gap - 5, 80, 50}, 5}), off < 0) << off;
    EXPECT_EQ(blocked(Cylinder{0, 80, radius - gap, 0, 100}), off < 0) << off;
  }
  // Contact is free.
  EXPECT_FALSE(blocked(Cylinder{0, 80, radius - r, 0, 100}));
  EXPECT_FALSE(blocked(BoxShape{{{radius + r, -10, 0}, {200, 200, 100}}}));
}
}  // namespace
}  // namespace altiplan::turn_oracle_test
