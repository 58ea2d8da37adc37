// SPDX-License-Identifier: Apache-2.0
// Flights of velocity_field over ground.
#include <gtest/gtest.h>

#include "reference/velocity_flights.hpp"
#include "terrain_sections.hpp"

namespace velocity_field::terrain_test {
namespace {
using altiplan::testing::make_environment;

World hills(const std::string& yaml, const Vec3& start, const Vec3& goal) {
  Site site;
  site.start = start;
  site.goal = goal;
  return World().with({"hills", "hills", make_environment("hills", yaml, site)});
}

/// 100 m above ground, climbs of 15 degrees, turns of 500 m.
Request over_hills(const std::string& yaml, const Vec3& start, const Vec3& goal) {
  Request request = altiplan::testing::request_in(hills(yaml, start, goal), start, goal,
                                                  {{0, 0, 0}, {100e3, 100e3, 5000}});
  request.vehicle.speed_mps = 30;
  request.vehicle.radius_m = 0;
  request.goal.tolerance_m = 50;
  request.limits.min_ground_clearance = 100;
  request.limits.max_climb = radians(15);
  request.limits.min_turn_radius = 500;
  return request;
}

double highest(const Route& route) {
  double z = -kInfinity;
  for (const Vec3& p : route) {
    z = std::max(z, p.z());
  }
  return z;
}

constexpr std::string_view kTerrain = "{terrain: sections, section_cell_m: 400}";
const std::string kPeak =
    "{base_m: 500, peaks: [{at_m: [50000, 49000], height_m: 3000, sigma_m: [4000, 4000]}]}";
const std::string kRidge =
    "{base_m: 500, peaks: [{at_m: [50000, 50000], height_m: 2000, sigma_m: [3000, 300000]}]}";
const Vec3 kWest(20e3, 50e3, 1500);
const Vec3 kEast(80e3, 50e3, 1500);

TEST(TerrainSections, SafeHeightKeepsAboveGroundAndIsNowhereTooSteep) {
  const World world = hills("{seed: 4, count: 20}", kWest, kEast);
  const GroundRules rules{{{0, 0, 0}, {100e3, 100e3, 0}}, 400, 100, 0, 69, 1000, 0.25, 9000};
  const TerrainSections sections(world, rules);
  SplitMix64 random(1);
  for (int n = 0; n < 5000; ++n) {
    const Vec2 p = 1e5 * Vec2(random.uniform(), random.uniform());
    const Vec2 q = (p + 3000 * Vec2(random.uniform() - 0.5, random.uniform() - 0.5))
                       .cwiseMax(0.0)
                       .cwiseMin(1e5);
    const double here = sections.safe_height(p);
    ASSERT_GE(here, *world.ground(p.x(), p.y()) + 100) << p.transpose();
    // Between the centres it may be steeper, by no more than the amount by which it was raised.
    ASSERT_LE(sections.safe_height(q), here + 0.25 * (q - p).norm() + 1.5 * 0.25 * 400);
  }
  EXPECT_EQ(sections.safe_height({-1, 500}), sections.safe_height({0, 500}));
}

TEST(TerrainSections, DiscsPushAwayFromWhateverIsTooHigh) {
  const World world = hills(kPeak, kWest, kEast);
  const GroundRules rules{{{0, 0, 0}, {100e3, 100e3, 0}}, 200, 100, 0, 69, 1000, 0.25, 9000};
  const TerrainSections sections(world, rules);
  const std::vector<float> gaps = sections.gaps(1500);
  const Vec2 peak(50e3, 49e3);
  int inside = 0;
  for (int degree = 0; degree < 360; degree += 5) {
    const Vec2 out(std::cos(radians(degree)), std::sin(radians(degree)));
    for (double d = 1000; d < 20000; d += 100) {
      const Vec2 p = peak + d * out;
      const auto disc = sections.disc(gaps, p, 2000, 2000);
      const bool high = sections.safe_height(p) > 1500;
      inside += high;
      if (disc && disc->radius + 300 < (p - disc->centre).norm()) {
        EXPECT_FALSE(high) << p.transpose();
      }
      if (high) {
        ASSERT_TRUE(disc) << p.transpose();
        EXPECT_LT((p - disc->centre).norm(), disc->radius + 300) << p.transpose();
        EXPECT_GT((p - disc->centre).normalized().dot(out), 0.8) << p.transpose();
      }
    }
    EXPECT_FALSE(sections.disc(gaps, peak + 18000 * out, 2000, 2000));
  }
  EXPECT_GT(inside, 1000);
}

TEST(TerrainSections, RefusesCellsThatAreTooMany) {
  const Request request = over_hills(kPeak, kWest, kEast);
  try {
    flight(request, "{terrain: sections, section_cell_m: 1}", 1);
    FAIL() << "10,000 million cells are made";
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("section_cell_m"), std::string::npos);
  }
}

TEST(Terrain, GoesRoundAPeakAtItsLevel) {
  const Request request = over_hills(kPeak, kWest, kEast);
  const Flown flown = flight(request, kTerrain);
  ASSERT_EQ(flown.outcome, PilotStep::Outcome::arrived) << flown.why.back();
  EXPECT_TRUE(check(flown.route, request).ok());
  EXPECT_LT(highest(flown.route), 1501);
  EXPECT_EQ(flown.counter("climbs_over"), 0);
  EXPECT_LT(length(flown.route), 1.3 * 60e3);
  EXPECT_FALSE(check(flight(request).route, request).ok()) << "ignored, the ground is in the way";
}

/// The ridge reaches both ends of the volume: there is no path around it.
Flown over_ridge(Request& request, double radius) {
  request.limits.min_turn_radius = radius;
  return flight(request,
                "{terrain: sections, section_cell_m: 400, max_steps: 8000, "
                "min_turn_radius_m: " +
                    std::to_string(radius) + "}");
}

TEST(Terrain, ClimbsOverARidgeAndDescends) {
  for (const double radius : {200.0, 500.0}) {
    Request request = over_hills(kRidge, kWest, kEast);
    const Flown flown = over_ridge(request, radius);
    ASSERT_EQ(flown.outcome, PilotStep::Outcome::arrived) << flown.why.back();
    EXPECT_TRUE(check(flown.route, request).ok());
    EXPECT_GT(highest(flown.route), 2590);
    EXPECT_NEAR(flown.route.back().z(), 1500, 50);
    EXPECT_EQ(flown.counter("low_steps"), 0);
    EXPECT_LE(uneven(flown.route, 30), 1e-6);
    EXPECT_GE(min_radius(flown.route), radius - 1e-6);
  }
}

TEST(Terrain, LevelFlightStaysLevel) {
  Request request = over_hills(kRidge, kWest, kEast);
  request.level_m = 1500;
  const Flown flown = over_ridge(request, 200);
  ASSERT_GT(flown.route.size(), 500U);
  for (const Vec3& p : flown.route) {
    ASSERT_EQ(p.z(), 1500);
  }
  EXPECT_FALSE(check(flown.route, request).ok()) << "there is no way round";
}

TEST(Terrain, FliesToAGoalAtAnotherHeight) {
  for (const double height : {700.0, 2500.0}) {
    const Request request = over_hills(kPeak, {20e3, 80e3, 1500}, {60e3, 80e3, height});
    const Flown flown = flight(request, kTerrain);
    EXPECT_EQ(flown.outcome, PilotStep::Outcome::arrived) << height;
    EXPECT_TRUE(check(flown.route, request).ok()) << height;
  }
}

TEST(Terrain, GivesUpAboveAGoalThatItCannotClimbOutFrom) {
  std::string bowl = "{base_m: 500, peaks: [";
  for (int degree = 0; degree < 360; degree += 30) {
    bowl += "{at_m: [" + std::to_string(80e3 + 4000 * std::cos(radians(degree))) + ", " +
            std::to_string(50e3 + 4000 * std::sin(radians(degree))) +
            "], height_m: 2000, sigma_m: [1000, 1000]},";
  }
  const Request request = over_hills(bowl + "]}", kWest, {80e3, 50e3, 1000});
  const Flown flown = flight(request, kTerrain);
  EXPECT_EQ(flown.outcome, PilotStep::Outcome::stuck);
  EXPECT_NE(flown.why.back().find("the goal lies lower"), std::string::npos) << flown.why.back();
}

TEST(Terrain, ThePublishedFlightIsThatOfAWorldWithoutGround) {
  const Flown flown = flight(table1(), kTerrain);
  ASSERT_EQ(flown.outcome, PilotStep::Outcome::arrived);
  EXPECT_NEAR(double(flown.route.size()), 4041, 3);
  EXPECT_EQ(flown.counter("trap_entries"), 5);
}

TEST(Terrain, RandomHillsAreNotFlownInto) {
  int arrived = 0;
  int safe = 0;
  std::int64_t climbs = 0;
  const Vec3 start(5e3, 5e3, 1500);
  const Vec3 goal(95e3, 95e3, 1500);
  for (int seed = 1; seed <= 20; ++seed) {
    Request request = over_hills("{count: 12, seed: " + std::to_string(seed) + "}", start, goal);
    request.volume.min -= Vec3(20e3, 20e3, 0);
    request.volume.max += Vec3(20e3, 20e3, 0);
    const Flown flown = flight(request, "{terrain: sections, section_cell_m: 500}", 12000);
    arrived += flown.outcome == PilotStep::Outcome::arrived;
    climbs += flown.counter("climbs_over");
    if (flown.counter("low_steps") == 0) {
      ++safe;
      for (std::size_t i = 1; i < flown.route.size(); ++i) {
        ASSERT_GE(request.world->ground_gap(flown.route[i - 1], flown.route[i]), 100 - 1e-6)
            << seed << " " << i;
      }
      EXPECT_TRUE(flown.outcome != PilotStep::Outcome::arrived || check(flown.route, request).ok())
          << seed;
    }
  }
  EXPECT_GE(arrived, 19);
  EXPECT_GE(safe, 15);
  EXPECT_GE(climbs, 5);
}
}  // namespace
}  // namespace velocity_field::terrain_test
