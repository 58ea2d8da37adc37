// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/layers/obstacle_set.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <thread>

#include "altiplan/error.hpp"
#include "altiplan/world.hpp"
#include "framework/shape_oracle.hpp"

namespace altiplan::kit::obstacle_set_test {
namespace {

using oracle::Draw;
using oracle::Solid;

struct Scene {
  std::vector<Solid> solids;
  ObstacleSet set;
};

Scene scene(Draw& draw, double scale, int count) {
  std::vector<Solid> solids;
  std::vector<Shape> shapes;
  for (int n = 0; n < count; ++n) {
    solids.push_back(oracle::random_solid(draw, draw.point(scale), scale * draw(0.01, 0.3)));
    shapes.push_back(solids.back().shape);
  }
  return {solids, ObstacleSet(shapes)};
}

double leg_distance(const std::vector<Solid>& solids, const Vec3& a, const Vec3& b) {
  double least = kInfinity;
  for (const Solid& solid : solids) {
    double from_middle = kInfinity;
    for (std::size_t piece = 0; piece < oracle::pieces(solid); ++piece) {
      from_middle = std::min(from_middle, oracle::outside(solid, piece, (a + b) / 2));
    }
    if (from_middle - (b - a).norm() / 2 < least) {
      least = std::min(least, oracle::leg_distance(solid, a, b));
    }
  }
  return least;
}

double signed_distance(const std::vector<Solid>& solids, const Vec3& p) {
  double least = kInfinity;
  for (const Solid& solid : solids) {
    least = std::min(least, oracle::signed_distance(solid, p));
  }
  return least;
}

// Queries on random scenes, from 1 to 30,000 m, each against the oracle; the radii lie as close to
// the true distance as the contract allows.
void compare(std::uint64_t seed, int queries) {
  Draw draw(seed);
  int asked = 0;
  int wrong = 0;
  int blocked = 0;
  while (asked < queries) {
    const double scale = std::exp(draw(0, std::log(30000)));
    const Scene world = scene(draw, scale, 1 + draw.below(12));
    for (int n = 0; n < 100; ++n) {
      const Vec3 a = draw.point(1.3 * scale);
      const Vec3 b = n % 3 == 0 ? Vec3(a + draw.point(0.1 * scale)) : draw.point(1.3 * scale);
      const double distance = leg_distance(world.solids, a, b);
      const double r = draw(0, 0.2 * scale);
      const bool expected = distance < r - kLengthTolerance;
      blocked += expected;
      if (std::abs(distance - (r - kLengthTolerance)) > kLengthTolerance) {
        wrong += world.set.blocked(a, b, r) != expected;
      }
      wrong += !world.set.blocked(a, b, distance + 1.01 * kLengthTolerance);
      wrong += distance > 0 && world.set.blocked(a, b, distance);
      const double depth = signed_distance(world.solids, a);
      wrong += std::abs(world.set.clearance(a) - depth) > kLengthTolerance;
      asked += 4;
    }
  }
  EXPECT_EQ(wrong, 0) << "of " << asked;
  EXPECT_GT(blocked, asked / 40);
}

TEST(ObstacleSet, AgreesWithTheOracle) { compare(1, 30000); }
TEST(NightlyObstacleSet, AgreesWithTheOracleAMillionTimes) { compare(2, 1000000); }

TEST(ObstacleSet, ThinWallsAndSpikesAreNeverMissed) {
  Draw draw(3);
  for (const double span : {10.0, 1000.0, 30000.0}) {
    const double tall = span / 2;
    const std::vector<Shape> thin{
        BoxShape{{{0, -span, 0}, {0.01, span, tall}}},
        Prism{{{0, -span}, {0.01, -span}, {0.01, span}, {0, span}}, {}, 0, tall},
        Prism{{{0, -span}, {0.01, -span}, {0.01, span}, {0, span}}, {}, -kInfinity, kInfinity}};
    const std::vector<Shape> spikes{Cylinder{0.005, 0, 0.005, 0, tall},
                                    BoxShape{{{0, -0.005, 0}, {0.01, 0.005, tall}}},
                                    Prism{{{0, -0.005}, {0.01, 0}, {0, 0.005}}, {}, 0, tall},
                                    Sphere{{0.005, 0, tall / 2}, 0.005}};
    for (int n = 0; n < 2000; ++n) {
      const double height = draw(0.01, 0.99) * tall;
      const Vec3 through(0.005, draw(-0.9, 0.9) * span, height);
      const Vec3 way = Vec3(draw(0.1, 1), draw(-0.3, 0.3), draw(-0.01, 0.01)) * span;
      for (const Shape& shape : thin) {
        const ObstacleSet set({shape});
        for (const double r : {0.0, 1e-3, 2.0}) {
          ASSERT_TRUE(set.blocked(through - way, through + way, r)) << span << ' ' << r;
        }
      }
      for (const Shape& shape : spikes) {
        const bool round = std::holds_alternative<Sphere>(shape);
        const Vec3 at(0.004, 0, round ? tall / 2 : height);
        const ObstacleSet set({shape});
        for (const double r : {0.0, 1e-3, 2.0}) {
          ASSERT_TRUE(set.blocked(at - way, at + way, r)) << span << ' ' << r;
        }
        const Vec3 aside = at + Vec3(0, 0.02 + 2, 0);
        const Vec3 straight(span, 0, 0);
        ASSERT_FALSE(set.blocked(aside - straight, aside + straight, 2)) << span;
      }
    }
  }
}

TEST(ObstacleSet, TouchingIsFree) {
  const double far = 20000;
  const std::vector<Shape> shapes{
      Sphere{{0, 0, 50}, 30}, Cylinder{0, 0, 30, 0, 100}, BoxShape{{{-30, -30, 0}, {30, 30, 100}}},
      Prism{{{-30, -30}, {30, -30}, {30, 30}, {0, 10}, {-30, 30}}, {}, 0, 100}};
  for (const Shape& shape : shapes) {
    const ObstacleSet set({shape});
    for (const double r : {0.0, 2.0, 500.0}) {
      const Vec3 a(30 + r, -far, 50);
      const Vec3 b(30 + r, far, 50);
      EXPECT_FALSE(set.blocked(a, b, r)) << shape.index() << ' ' << r;
      EXPECT_TRUE(set.blocked(a - Vec3(2e-6, 0, 0), b - Vec3(2e-6, 0, 0), r));
      if (shape.index() > 0) {
        EXPECT_FALSE(set.blocked({-far, 0, 100 + r}, {far, 0, 100 + r}, r)) << shape.index();
        EXPECT_TRUE(set.blocked({-far, 0, 100 + r - 3e-6}, {far, 0, 100 + r - 3e-6}, r));
        EXPECT_FALSE(set.blocked({0, 0, -r}, {0, 0, -r - far}, r)) << shape.index();
      }
    }
  }
}

TEST(ObstacleSet, NearFindsEveryShapeInReach) {
  Draw draw(5);
  const Scene world = scene(draw, 1000, 200);
  for (int n = 0; n < 500; ++n) {
    const Vec3 p = draw.point(1200);
    const double reach = draw(0, 500);
    std::vector<int> found;
    world.set.near(p, reach, [&](const Nearby& nearby) {
      found.push_back(nearby.id);
      const double distance = oracle::signed_distance(world.solids[nearby.id], p);
      EXPECT_NEAR(nearby.distance, distance, 1e-6);
      EXPECT_NEAR((nearby.point - p).norm(), std::abs(distance), 1e-6);
      EXPECT_LT((nearby.point + nearby.distance * nearby.normal - p).norm(), 1e-6);
    });
    std::vector<int> expected;
    for (int id = 0; id < 200; ++id) {
      if (oracle::signed_distance(world.solids[id], p) <= reach) {
        expected.push_back(id);
      }
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(ObstacleSet, RasterizesByTheRule) {
  Draw draw(6);
  for (int n = 0; n < 12; ++n) {
    const Scene world = scene(draw, 20, 4);
    GridSpec spec;
    spec.origin = {-20, -20, -20};
    spec.cell = {1.3, 0.9, 2};
    spec.counts = {32, 45, 20};
    spec.inflation = n % 3 == 0 ? 0 : draw(0, 4);
    spec.rule = n % 2 == 0 ? GridSpec::Rule::touched : GridSpec::Rule::centre;
    VoxelGrid grid(spec);
    world.set.rasterize(grid);
    EXPECT_GT(grid.blocked_count(), 0U);
    for (int k = 0; k < spec.counts[2]; ++k) {
      for (int j = 0; j < spec.counts[1]; ++j) {
        for (int i = 0; i < spec.counts[0]; ++i) {
          const Cell c{i, j, k};
          const double at_centre = signed_distance(world.solids, spec.centre(c));
          bool expected = at_centre <= spec.inflation;
          if (spec.rule == GridSpec::Rule::touched) {
            expected = false;
            for (const Solid& solid : world.solids) {
              expected |= overlaps(solid.shape, spec.cell_box(c), spec.inflation);
            }
          }
          ASSERT_EQ(grid.blocked(c), expected) << n << ": " << i << ' ' << j << ' ' << k;
        }
      }
    }
  }
}

TEST(ObstacleSet, ManyThreadsGiveOneAnswer) {
  Draw draw(8);
  const Scene world = scene(draw, 5000, 2000);
  std::vector<std::array<Vec3, 2>> legs;
  for (int n = 0; n < 4000; ++n) {
    legs.push_back({draw.point(5000), draw.point(5000)});
  }
  const auto answers = [&] {
    std::vector<double> result;
    for (const auto& [a, b] : legs) {
      result.push_back(world.set.clearance(a) + (world.set.blocked(a, b, 5) ? 1e9 : 0));
    }
    return result;
  };
  const std::vector<double> expected = answers();
  std::vector<std::vector<double>> found(4);
  std::vector<std::thread> threads;
  for (std::vector<double>& result : found) {
    threads.emplace_back([&] { result = answers(); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const std::vector<double>& result : found) {
    EXPECT_EQ(result, expected);
  }
}

TEST(ObstacleSet, EmptyEqualAndEndlessSets) {
  const ObstacleSet none({});
  EXPECT_EQ(none.clearance({0, 0, 0}), kInfinity);
  EXPECT_FALSE(none.blocked({0, 0, 0}, {1, 0, 0}, 1e6));
  EXPECT_TRUE(none.bounds().is_empty());
  const ObstacleSet same(std::vector<Shape>(20000, Sphere{{1, 2, 3}, 1}));
  EXPECT_EQ(same.clearance({1, 2, 5}), 1);
  const ObstacleSet endless(
      {BoxShape{{{0, -kInfinity, -kInfinity}, {1, kInfinity, kInfinity}}}, Sphere{{-9, 0, 0}, 1}});
  EXPECT_TRUE(endless.blocked({-1e7, 4e6, 9e6}, {1e7, 5e6, -9e6}, 0));
  EXPECT_EQ(endless.clearance({5, 1e8, -1e8}), 4);
  EXPECT_EQ(ObstacleSet({BoxShape{}}).clearance({0, 0, 0}), -kInfinity);
}

TEST(ObstacleSet, APointIsBlockedWhereItIsInside) {
  // By more than the tolerance, whichever way it leaves: a leg that ends there is blocked too.
  Draw draw(17);
  for (int n = 0; n < 3000; ++n) {
    const double radius = std::pow(10, draw(0, 3));
    const Vec3 centre = draw.point(1e4);
    const Vec3 away = draw.point(1).normalized();
    const Vec3 inside = centre + (radius - 1.1e-6) * away;
    const Vec3 outside = inside + (away + 0.9 * draw.point(1)).normalized() * draw(1, 1000);
    const ObstacleSet ball({Sphere{centre, radius}});
    ASSERT_TRUE(ball.blocked(inside, inside, 0)) << n;
    ASSERT_TRUE(ball.blocked(inside, outside, 0)) << n;
    ASSERT_TRUE(ball.blocked(outside, inside, 0)) << n;
    const MovingObstacle moving{"ball", Sphere{centre, radius}};
    ASSERT_TRUE(hits(moving, inside, 0, outside, 1, 0)) << n;
    // What only touches is free.
    const Vec3 on = centre + radius * away;
    const Vec3 along = away.cross(draw.point(1)).normalized();
    ASSERT_FALSE(ball.blocked(on - radius * along, on + radius * along, 0)) << n;
  }
}

TEST(ObstacleSet, RefusesWhatIsNoSolid) {
  EXPECT_THROW(ObstacleSet({Sphere{{0, 0, 0}, -1}}), Error);
  EXPECT_THROW(ObstacleSet({Sphere{{0, NAN, 0}, 1}}), Error);
  EXPECT_THROW(ObstacleSet({Cylinder{0, 0, 1, 10, 5}}), Error);
  EXPECT_THROW(ObstacleSet({Prism{{{0, 0}, {1, 1}}, {}, 0, 1}}), Error);
}
}  // namespace
}  // namespace altiplan::kit::obstacle_set_test
