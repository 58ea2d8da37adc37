// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "altiplan/random.hpp"
#include "distance_oracle.hpp"
#include "support/posts.hpp"
#include "support/support.hpp"

namespace altiplan::testing::ground_distance_test {
namespace {

constexpr double kEast = 20;
constexpr double kNorth = 30;
constexpr int kPosts = 9;

std::vector<float> heights_of(const std::function<double(double x, double y)>& height) {
  std::vector<float> all;
  for (int j = 0; j < kPosts; ++j) {
    for (int i = 0; i < kPosts; ++i) {
      all.push_back(float(height(i * kEast, j * kNorth)));
    }
  }
  return all;
}

std::shared_ptr<const Posts> posts_with(std::vector<float> heights) {
  return std::make_shared<Posts>(
      HeightField({0, 0}, {kEast, kNorth}, kPosts, kPosts, std::move(heights)));
}

World world_with(std::vector<float> heights) { return world_of(posts_with(std::move(heights))); }

std::string at_most(double metres) {
  char text[80];
  std::snprintf(text, sizeof text, "{max_m: %.17g}", metres);
  return text;
}

bool admits(const World& world, const Vec3& a, const Vec3& b, double max_m) {
  return make_constraint("ground_distance", at_most(max_m))->admits({std::nullopt, a, b, &world});
}

double flat(double, double) { return 0; }
double slope(double x, double) { return x; }                       // at 45 degrees
double cliff(double x, double) { return x > 80 ? 150 : 0; }        // within 20 m
double ridge(double x, double) { return x == 80 ? 150 : 0; }       // a wall with a crest
double crest(double x, double) { return 100 - std::abs(x - 80); }  // at 45 degrees

TEST(GroundDistance, RefusesWrongParameters) {
  EXPECT_EQ(parameter_problems("constraint", "ground_distance", "{max_m: 120}"), "");
  EXPECT_NE(parameter_problems("constraint", "ground_distance", "{}"), "");
  EXPECT_NE(parameter_problems("constraint", "ground_distance", "{max_m: 0}"), "");
}

TEST(GroundDistance, CountsTheNearestGroundNotThatBelow) {
  const World flat_world = world_with(heights_of(flat));
  EXPECT_TRUE(admits(flat_world, {10, 10, 120}, {150, 200, 120}, 120));
  EXPECT_FALSE(admits(flat_world, {10, 10, 120}, {150, 200, 120.001}, 120));
  const World hillside = world_with(heights_of(slope));
  // 169 m above the ground below, along the slope.
  const double up = 120 * std::sqrt(2);
  EXPECT_TRUE(admits(hillside, {10, 100, 10 + up}, {70, 100, 70 + up}, 120));
  EXPECT_FALSE(admits(hillside, {10, 100, 10.01 + up}, {70, 100, 70.01 + up}, 120));
  const World wall = world_with(heights_of(cliff));
  EXPECT_TRUE(admits(wall, {60, 10, 140}, {60, 200, 140}, 50)) << "beside the cliff";
  EXPECT_FALSE(admits(wall, {20, 10, 140}, {60, 200, 140}, 50));
}

TEST(GroundDistance, OverACrestTheMiddleIsNearest) {
  const World world = world_with(heights_of(crest));
  EXPECT_TRUE(admits(world, {70, 50, 150}, {90, 50, 150}, 60));
  EXPECT_FALSE(admits(world, {0, 50, 150}, {90, 50, 150}, 60));
}

TEST(GroundDistance, NeedsGround) {
  const World world = world_with(heights_of(flat));
  EXPECT_FALSE(admits(World(), {0, 0, 0}, {1, 0, 0}, 120));
  EXPECT_FALSE(admits(world, {-500, 100, 50}, {-400, 100, 50}, 120));
  EXPECT_FALSE(admits(world, {10, 100, 50}, {-400, 100, 50}, 120)) << "leaves the ground";
  EXPECT_TRUE(admits(world, {10, 100, 50}, {-50, 100, 50}, 120)) << "near its edge";
}

TEST(GroundDistance, TheNearestGroundOfAnyLayerCounts) {
  const World low = world_with(heights_of(flat));
  const Vec3 a(60, 10, 140);
  const Vec3 b(60, 200, 140);
  EXPECT_FALSE(admits(low, a, b, 50));
  const World both = low.with({"high", "posts", posts_with(heights_of(cliff)), true});
  EXPECT_TRUE(admits(both, a, b, 50));
}

TEST(GroundDistance, AVoidIsNoGround) {
  std::vector<float> heights = heights_of(ridge);
  const Vec3 a(80, 110, 160);
  const Vec3 b(80, 130, 160);
  EXPECT_TRUE(admits(world_with(heights), a, b, 20));
  for (int j = 0; j < kPosts; ++j) {
    heights[std::size_t(j * kPosts + 4)] = std::nanf("");
  }
  EXPECT_FALSE(admits(world_with(heights), a, b, 20));
}

Request problem(const std::string& yaml, AppliesTo to = AppliesTo::route) {
  Request request = request_in(world_with(heights_of(slope)), {10, 100, 110}, {150, 100, 250},
                               {{0, 0, 0}, {160, 240, 1000}});
  apply_constraints(request, {{"ground_distance", make_constraint("ground_distance", yaml)}}, to);
  return request;
}

TEST(GroundDistance, TheJudgeNamesTheDistance) {
  const Route route{{10, 100, 110}, {80, 100, 220}, {150, 100, 250}};  // 140 m above the ground
  EXPECT_TRUE(check(route, problem("{max_m: 99}")).ok());
  const CheckResult result = check(route, problem("{max_m: 90}"));
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.violations.size(), 2U);  // of each leg, not again of the route
  const Violation& last = result.violations.back();
  EXPECT_EQ(last.constraint, "ground_distance");
  EXPECT_GT(last.value, 90);
  EXPECT_LT(last.value, 99);
  EXPECT_EQ(last.limit, 90);
  EXPECT_NE(last.message.find("m from the nearest ground; at most 90.00 m are permitted"),
            std::string::npos)
      << last.message;
}

TEST(GroundDistance, JudgesTurns) {
  const World world = world_with(heights_of(slope));
  Request request = problem("{max_m: 80}");
  request.vehicle.turns_on_the_spot = true;
  const Leg turn = Leg::turning({{80, 60, 190}, 0}, kPi, 40, 0);  // eastward, then back west
  EXPECT_TRUE(leg_ok(std::nullopt, turn, request));
  const Leg west = Leg::turning({{80, 60, 190}, kPi}, -kPi, 40, 0);
  EXPECT_FALSE(leg_ok(std::nullopt, west, request)) << "over lower ground";
}

TEST(GroundDistance, MayHoldForRoutesAlone) {
  const std::string yaml = "{max_m: 61, applies_to: route}";
  EXPECT_EQ(problem(yaml).constraints.size(), 1U);
  EXPECT_TRUE(problem(yaml, AppliesTo::track).constraints.empty());
}

std::vector<float> random_heights(RandomStream& random) {
  const auto kind = random.integer(0, 4);
  const double rough = random.uniform() < 0.5 ? 0 : random.uniform(0, 8);
  const double east = random.uniform(-1.5, 1.5);
  const double north = random.uniform(-1.5, 1.5);
  const double high = random.uniform(20, 200);
  const double where = double(random.integer(2, 6));
  return heights_of([&](double x, double y) {
    const double ground = kind == 0   ? random.uniform(0, high)
                          : kind == 1 ? 100 + east * (x - 80) + north * (y - 120)
                          : kind == 2 ? (x > where * kEast ? high : 0)
                          : kind == 3 ? (y == where * kNorth ? high : 0)
                                      : high - std::abs(x - where * kEast);
    return ground + random.uniform(-rough, rough);
  });
}

struct Tally {
  int missed = 0;
  int invented = 0;
  int legs = 0;
  int beside = 0;  ///< legs whose limit is decided by ground that is not below
};

/// Asks for limits a little more than the tolerance below and above the greatest distance.
Tally compare(int legs, std::uint64_t seed) {
  constexpr double kMore = 1.1e-6;
  RandomStream random(seed);
  Tally tally;
  while (tally.legs < legs) {
    const std::vector<float> heights = random_heights(random);
    const DistanceOracle oracle(kEast, kNorth, kPosts, kPosts, heights);
    const World world = world_with(heights);
    for (int n = 0; n < 10; ++n) {
      const auto place = [&] {
        const double x = random.uniform(1, 159);
        const double y = random.uniform(1, 239);
        return Vec3(x, y, double(oracle.height(x, y)) + random.uniform(0, 160));
      };
      const Vec3 a = place();
      Vec3 b = place();
      b = random.uniform() < 0.3 ? Vec3(a + 0.05 * (b - a)) : b;
      const double farthest = double(oracle.farthest(a, b));
      if (farthest < 1) {
        continue;
      }
      ++tally.legs;
      tally.beside += world.ground_gap_max(a, b) > farthest + 1;
      tally.missed += admits(world, a, b, farthest - kMore);
      tally.invented += !admits(world, a, b, farthest + kMore);
    }
  }
  return tally;
}

TEST(GroundDistance, AgreesWithAnIndependentReference) {
  const Tally tally = compare(200, 28);
  EXPECT_EQ(tally.missed, 0);
  EXPECT_EQ(tally.invented, 0);
  EXPECT_GT(tally.beside, tally.legs / 3);
}

TEST(GroundDistance, OverHillsItAgreesWithTheirDistances) {
  Site site;
  const World before;
  site.before = &before;
  const World world = world_of(make_environment("hills",
                                                "{base_m: 100, peaks: [{at_m: [0, 0], height_m: "
                                                "400, sigma_m: [150, 250]}, {at_m: [500, 100], "
                                                "height_m: 300, sigma_m: [80, 200]}]}",
                                                site));
  const Ground& hills = *world.layers().front().environment->ground();
  RandomStream random(30);
  int beside = 0;
  for (int n = 0; n < 16; ++n) {
    const auto place = [&] {
      const double x = random.uniform(-300, 700);
      const double y = random.uniform(-300, 300);
      return Vec3(x, y, *world.ground(x, y) + random.uniform(60, 160));
    };
    const Vec3 a = place();
    const Vec3 b = a + 0.3 * (place() - a);
    if (world.ground_gap(a, b) < 1) {
      continue;
    }
    double farthest = 0;
    constexpr int kSamples = 1000;
    for (int k = 0; k <= kSamples; ++k) {
      const Vec3 p = a + double(k) / kSamples * (b - a);
      farthest = std::max(farthest, *hills.distance(p, p));
    }
    beside += world.ground_gap_max(a, b) > farthest + 1;
    EXPECT_FALSE(admits(world, a, b, farthest - 1e-5)) << n;
    EXPECT_TRUE(admits(world, a, b, farthest + (b - a).norm() / kSamples)) << n;
  }
  EXPECT_GT(beside, 8);
}

TEST(NightlyGroundDistance, AgreesWithAnIndependentReference) {
  const Tally tally = compare(4000, 29);
  RecordProperty("legs", tally.legs);
  RecordProperty("beside", tally.beside);
  EXPECT_EQ(tally.missed, 0);
  EXPECT_EQ(tally.invented, 0);
}
}  // namespace
}  // namespace altiplan::testing::ground_distance_test
