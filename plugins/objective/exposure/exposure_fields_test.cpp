// SPDX-License-Identifier: Apache-2.0
// Fields of the world and of layers: clearance, height above ground, wind, a radar's detection.
#include <gtest/gtest.h>

#include "altiplan/error.hpp"
#include "altiplan/kit/layers/mean_cost.hpp"
#include "exposure_worlds_test.hpp"
#include "support/posts.hpp"

namespace altiplan::exposure_fields_test {
namespace {

const Box kVolume{{0, 0, 0}, {120, 90, 40}};
const Vec3 kCell{15, 18, 10};

World balls(SplitMix64& random) {
  std::vector<Shape> shapes;
  for (int n = random.integer(1, 8); n > 0; --n) {
    shapes.emplace_back(
        Sphere{{120 * random.uniform(), 90 * random.uniform(), 40 * random.uniform()},
               5 + 15 * random.uniform()});
  }
  return testing::world_of(std::move(shapes));
}

Site site_in(const World& world) {
  Site site;
  site.before = &world;
  site.volume = kVolume;
  return site;
}

double price(double clearance) {  // [[-5, 8], [10, 2], [30, 0]]
  if (clearance <= -5) {
    return 8;
  }
  return clearance < 10   ? 8 - (clearance + 5) / 15 * 6
         : clearance < 30 ? 2 - (clearance - 10) / 20 * 2
                          : 0;
}
const std::string kByClearance =
    "{of: clearance, cell_m: [15, 18, 10], price: [[-5, 8], [10, 2], [30, 0]]}";

/// Linear along each axis between the corners of cells, by the definition.
double field(const World& world, const Vec3& p) {
  const Vec3 at = p.cwiseQuotient(kCell);
  const Vec3 low(std::min(std::floor(at.x()), 7.0), std::min(std::floor(at.y()), 4.0),
                 std::min(std::floor(at.z()), 3.0));
  double sum = 0;
  for (int n = 0; n < 8; ++n) {
    const Vec3 corner = low + Vec3(n & 1, n >> 1 & 1, n >> 2);
    const Vec3 off = (at - corner).cwiseAbs();
    sum += (1 - off.x()) * (1 - off.y()) * (1 - off.z()) *
           price(world.clearance(corner.cwiseProduct(kCell)));
  }
  return sum;
}

TEST(ExposureFields, ClearanceEqualsFineSampling) {
  SplitMix64 draws(1);
  RandomStream random(2);
  for (int n = 0; n < 12; ++n) {
    const World world = balls(draws);
    const auto exposure = testing::make_objective("exposure", kByClearance, site_in(world));
    const Request request = testing::request_in(world, {0, 0, 0}, {100, 0, 0}, kVolume);
    for (int k = 0; k < 20; ++k) {
      const Leg leg = Leg::straight(random.in(kVolume), random.in(kVolume));
      constexpr int kPieces = 3000;
      double expected = 0;
      for (int piece = 0; piece < kPieces; ++piece) {
        expected += leg.length() / kPieces * field(world, leg.at((piece + 0.5) / kPieces));
      }
      EXPECT_NEAR(exposure->cost(leg, 0, request), expected, 1e-5 * (1 + expected));
    }
  }
}

TEST(ExposureFields, BoundsAreAdmissibleAndKnowAFloor) {
  SplitMix64 draws(3);
  RandomStream random(4);
  for (int n = 0; n < 30; ++n) {
    const World world = balls(draws);
    const auto exposure = testing::make_objective("exposure", kByClearance, site_in(world));
    const Request request = testing::request_in(world, {0, 0, 0}, {100, 0, 0}, kVolume);
    for (int k = 0; k < 100; ++k) {
      const Vec3 a = random.in(kVolume);
      const Vec3 b = random.in(kVolume);
      const Vec3 c = random.in(kVolume);
      const double around = exposure->cost(Leg::straight(a, b), 0, request) +
                            exposure->cost(Leg::straight(b, c), 0, request);
      EXPECT_LE(exposure->bound(a, c, request), around * (1 + 1e-9));
    }
  }
  // By height alone: each level costs at least its price, whatever the way.
  const World flat = testing::world_of(std::make_shared<testing::Posts>(
      HeightField({0, 0}, {60, 45}, 3, 3, std::vector<float>(9, 0))));
  const auto by_height = testing::make_objective(
      "exposure", "{of: height_above_ground, cell_m: [40, 30, 10], price: [[0, 0], [40, 40]]}",
      site_in(flat));
  const Request request = testing::request_in(flat, {0, 0, 0}, {100, 0, 0}, kVolume);
  EXPECT_NEAR(by_height->bound({5, 5, 0}, {5, 5, 40}, request), 800, 1e-6);
  EXPECT_NEAR(by_height->cost(Leg::straight({5, 5, 0}, {5, 5, 40}), 0, request), 800, 1e-6);
  EXPECT_FALSE(dynamic_cast<const kit::MeanCost&>(*by_height).is_mean());
}

TEST(ExposureFields, ARadarThatBlocksNothingIsPriced) {
  const World radars = testing::world_of(
      testing::make_environment("radar", "{at_m: [60, 45, 0], range_m: 30, blocks: false}"), "eye");
  EXPECT_FALSE(radars.blocked({0, 45, 0}, {120, 45, 0}, 10));
  EXPECT_TRUE(radars.threats().empty());
  const auto exposure =
      testing::make_objective("exposure", "{layer: eye, cell_m: [3, 3, 4]}", site_in(radars));
  const Request request = testing::request_in(radars, {0, 0, 0}, {100, 0, 0}, kVolume);
  const auto mean = [&](const Vec3& a, const Vec3& b) {
    return exposure->cost(Leg::straight(a, b), 0, request) / (b - a).norm();
  };
  EXPECT_NEAR(mean({59.9, 45, 0}, {60.1, 45, 0}), 1, 0.01);
  EXPECT_NEAR(mean({90, 44.9, 0}, {90, 45.1, 0}), 0.5, 0.01);
  EXPECT_NEAR(mean({120, 44.9, 0}, {120, 45.1, 0}), 1 / 17.0, 0.001);
}

TEST(ExposureFields, WindIsThatOfTheScenario) {
  Site site = site_in(World());
  const World nothing;
  site.before = &nothing;
  site.wind.layers = {{-kInfinity, {3, 4, 0}}, {20, {0, 0, 0}}};
  const auto exposure =
      testing::make_objective("exposure", "{of: wind_speed, cell_m: [40, 30, 40]}", site);
  const Request request = testing::request_in(nothing, {0, 0, 0}, {100, 0, 0}, kVolume);
  EXPECT_NEAR(exposure->cost(Leg::straight({0, 10, 0}, {100, 10, 0}), 0, request), 500, 1e-6);
  EXPECT_NEAR(exposure->cost(Leg::straight({0, 10, 20}, {100, 10, 20}), 0, request), 250, 1e-6);
  site.wind = {};  // where nothing would have a cost
  EXPECT_THROW(testing::make_objective("exposure", "{of: wind_speed}", site), ParameterError);
}

TEST(ExposureFields, LevelFlightHasAMeanOfItsHeight) {
  SplitMix64 draws(5);
  const World world = balls(draws);
  Site site = site_in(world);
  site.volume.min.z() = site.volume.max.z() = 20;
  const auto exposure = testing::make_objective("exposure", kByClearance, site);
  EXPECT_TRUE(dynamic_cast<const kit::MeanCost&>(*exposure).is_mean());
  const Request request = testing::request_in(world, {0, 0, 20}, {100, 0, 20}, site.volume);
  const Vec3 post(30, 36, 20);
  EXPECT_NEAR(exposure->cost(Leg::straight(post, post + Vec3(1e-3, 0, 0)), 0, request),
              1e-3 * price(world.clearance(post)), 1e-5);
}

TEST(ExposureFields, EdgesOfTheVolumeArePriced) {
  const World nothing;
  const auto exposure = testing::make_objective("exposure", kByClearance, site_in(nothing));
  const Request request = testing::request_in(nothing, {0, 0, 0}, {100, 0, 0}, kVolume);
  const Vec3 beyond = Vec3::Constant(0.9 * kLengthTolerance);
  const Leg diagonal = Leg::straight(kVolume.min - beyond, kVolume.max + beyond);
  EXPECT_EQ(exposure->cost(diagonal, 0, request), 0);  // far from all obstacles
}

TEST(ExposureFields, WhatIsMissingIsNamed) {
  const World radars = testing::world_of(
      testing::make_environment("radar", "{at_m: [60, 45, 0], range_m: 30}"), "eye");
  const auto refusal = [&](const std::string& yaml, const World& world) -> std::string {
    try {
      testing::make_objective("exposure", yaml, site_in(world));
    } catch (const ParameterError& error) {
      return error.key() + ": " + error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("{layer: ear}", radars),
            "layer: no known layer with a field has the id 'ear'; layers with one: 'eye'");
  EXPECT_EQ(refusal("{layer: layer}", testing::world_of({Shape(Sphere{{0, 0, 0}, 1})})),
            "layer: no known layer with a field has the id 'layer'; layers with one: none");
  EXPECT_EQ(refusal("{of: height_above_ground, price: [[0, 1]]}", radars),
            "of: needs a layer with ground (terrain)");
  EXPECT_EQ(refusal("{layer: eye, cell_m: [0.001, 0.001, 0.001]}", radars),
            "cell_m: the volume would have more than 100000000 places to ask: give larger cells, "
            "or a volume");
  const auto problems = [](const std::string& yaml) {
    return testing::parameter_problems("objective", "exposure", yaml);
  };
  EXPECT_NE(problems("{}").find("expected one of file, layer and of"), std::string::npos);
  EXPECT_NE(problems("{layer: eye, of: clearance}").find("expected one of"), std::string::npos);
  EXPECT_NE(problems("{of: clearance}").find("expected price"), std::string::npos);
  EXPECT_NE(problems("{layer: a, price: [[1, 1], [1, 2]]}").find("ascending"), std::string::npos);
  EXPECT_NE(problems("{layer: a, price: [[1, -1]]}").find("at least 0"), std::string::npos);
}
}  // namespace
}  // namespace altiplan::exposure_fields_test
