// SPDX-License-Identifier: Apache-2.0
// The world's queries over several layers against all solids asked one by one.
#include <gtest/gtest.h>

#include "reference/random_problem.hpp"

namespace altiplan::reference::world_oracle_test {
namespace {

struct Place {
  Scene scene;
  World world;
  Box box;
};

/// Layers of solids and, every third time, one of cells; layers that came and went on the way.
Place random_place(std::uint64_t seed, bool prisms) {
  oracle::Draw draw(seed);
  Place place;
  place.box = {{0, 0, 0}, {10, 8, 6}};
  const auto at = [&] { return draw.within({0, 0, 0}, {10, 8, 6}); };
  GridSpec asked;  // before and between the changes, so that grids are patched
  asked.counts = {10, 8, 6};
  if (seed % 3 == 0) {
    std::vector<std::string> levels(6,
                                    "..........\n..........\n..........\n..........\n"
                                    "..........\n..........\n..........\n..........");
    for (int n = 0; n < 12; ++n) {
      const Cell c = {draw.below(10), draw.below(8), draw.below(6)};
      levels[std::size_t(c[2])][std::size_t(11 * (7 - c[1]) + c[0])] = '#';
      const Vec3 low(c[0], c[1], c[2]);
      place.scene.solids.push_back({BoxShape{{low, low + Vec3(1, 1, 1)}}, {}});
    }
    // A cell drawn twice is one obstacle of the layer.
    auto& solids = place.scene.solids;
    const auto less = [](const oracle::Solid& x, const oracle::Solid& y) {
      const Vec3& p = std::get<BoxShape>(x.shape).box.min;
      const Vec3& q = std::get<BoxShape>(y.shape).box.min;
      return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
    };
    std::sort(solids.begin(), solids.end(), less);
    solids.erase(
        std::unique(solids.begin(), solids.end(),
                    [&](const auto& x, const auto& y) { return !less(x, y) && !less(y, x); }),
        solids.end());
    place.world = place.world.with(testing::draw(levels).world->layers().front());
  }
  const int layers = 1 + draw.below(4);
  for (int n = 0; n < layers; ++n) {
    std::vector<Shape> shapes;
    for (int s = draw.below(4); s >= 0; --s) {
      oracle::Solid solid = oracle::random_solid(draw, at(), draw(0.5, 2.5));
      while (!prisms && std::holds_alternative<Prism>(solid.shape)) {
        solid = oracle::random_solid(draw, at(), draw(0.5, 2.5));
      }
      shapes.push_back(solid.shape);
      place.scene.solids.push_back(std::move(solid));
    }
    Layer layer = testing::world_of(std::move(shapes)).layers().front();
    layer.id = "layer" + std::to_string(n);
    Layer passing = testing::world_of({Sphere{at(), 2}}).layers().front();
    passing.id = "passing";
    place.world.voxels(asked);
    place.world = place.world.with(std::move(passing)).with(std::move(layer));
    place.world.voxels(asked);
    place.world = place.world.without("passing");
  }
  return place;
}

double min_distance(const Scene& scene, const Vec3& a, const Vec3& b) {
  double least = kInfinity;
  for (const oracle::Solid& solid : scene.solids) {
    least = std::min(least, oracle::leg_distance(solid, a, b));
  }
  return least;
}

double min_clearance(const Scene& scene, const Vec3& p) {
  double least = kInfinity;
  for (const oracle::Solid& solid : scene.solids) {
    least = std::min(least, oracle::signed_distance(solid, p));
  }
  return least;
}

void hold_queries(std::uint64_t from, std::uint64_t to) {
  int blocked = 0;
  int free = 0;
  std::size_t seen = 0;
  for (std::uint64_t seed = from; seed < to; ++seed) {
    const Place place = random_place(seed, true);
    oracle::Draw draw(seed + 1);
    SCOPED_TRACE(seed);
    for (int n = 0; n < 40; ++n) {
      const Vec3 a = draw.within({-1, -1, -1}, {11, 9, 7});
      const Vec3 b = draw.within({-1, -1, -1}, {11, 9, 7});
      EXPECT_NEAR(place.world.clearance(a), min_clearance(place.scene, a), 1e-6);
      for (const double r : {0.0, 0.4}) {
        const double least = min_distance(place.scene, a, b);
        if (least > 0 && std::abs(least - r) < kDoubt) {
          continue;
        }
        const bool expected = least == 0 || least < r;
        EXPECT_EQ(place.world.blocked(a, b, r), expected) << least << ' ' << r;
        ++(expected ? blocked : free);
      }
      const double reach = draw(0.2, 3);
      std::vector<double> near;
      place.world.near(a, reach, [&](const Layer&, const Nearby& obstacle) {
        near.push_back(obstacle.distance);
        EXPECT_NEAR((obstacle.point - a).norm(), std::abs(obstacle.distance), 1e-6);
      });
      std::vector<double> expected;
      for (const oracle::Solid& solid : place.scene.solids) {
        if (const double d = oracle::signed_distance(solid, a); d <= reach) {
          expected.push_back(d);
        }
      }
      std::sort(near.begin(), near.end());
      std::sort(expected.begin(), expected.end());
      ASSERT_EQ(near.size(), expected.size());
      for (std::size_t i = 0; i < near.size(); ++i) {
        EXPECT_NEAR(near[i], expected[i], 1e-6);
      }
      seen += near.size();
    }
  }
  EXPECT_GT(blocked, int(to - from));
  EXPECT_GT(free, int(to - from));
  EXPECT_GT(seen, std::size_t(to - from));
}
TEST(WorldOracle, QueriesAreThoseOfAllSolids) { hold_queries(0, 90); }
TEST(NightlyWorldOracle, QueriesAreThoseOfAllSolids) { hold_queries(1000, 4000); }

template <class Visit>
void each_cell(const GridSpec& spec, const Visit& visit) {
  for (int k = 0; k < spec.counts[2]; ++k) {
    for (int j = 0; j < spec.counts[1]; ++j) {
      for (int i = 0; i < spec.counts[0]; ++i) {
        visit(Cell{i, j, k});
      }
    }
  }
}

GridSpec random_spec(oracle::Draw& draw) {
  GridSpec spec;
  spec.origin = {draw(-1, 1), draw(-1, 1), draw(-1, 1)};
  spec.cell = {draw(0.5, 1.5), draw(0.5, 1.5), draw(0.3, 1.5)};
  spec.counts = {9, 8, 6};
  spec.inflation = draw.below(2) == 0 ? 0 : draw(0.1, 0.8);
  return spec;
}

void hold_rasters(std::uint64_t from, std::uint64_t to) {
  std::array<int, 2> count{};
  for (std::uint64_t seed = from; seed < to; ++seed) {
    oracle::Draw draw(seed + 1);
    GridSpec spec = random_spec(draw);
    SCOPED_TRACE(seed);
    // Touched, where closed forms tell it: exactly the cells that a grown solid overlaps.
    const Place plain = random_place(seed, false);
    const auto touched = plain.world.voxels(spec);
    each_cell(spec, [&](const Cell& c) {
      double least = kInfinity;
      for (const oracle::Solid& solid : plain.scene.solids) {
        least = std::min(least, box_distance(spec.cell_box(c), solid));
      }
      if (least == 0 || std::abs(least - spec.inflation) > kDoubt) {
        const bool expected = least == 0 || least < spec.inflation;
        EXPECT_EQ(touched->blocked(c), expected) << c[0] << ' ' << c[1] << ' ' << c[2];
        ++count[expected];
      }
    });
    // Prisms too: no point of a free cell is in a grown solid.
    const Place place = random_place(seed, true);
    const auto all = place.world.voxels(spec);
    each_cell(spec, [&](const Cell& c) {
      for (int n = 0; n < 8 && !all->blocked(c); ++n) {
        const Box box = spec.cell_box(c);
        const Vec3 p = draw.within(box.min, box.max);
        EXPECT_GE(min_clearance(place.scene, p), spec.inflation - 1e-6);
      }
    });
    spec.rule = GridSpec::Rule::centre;
    const auto centres = place.world.voxels(spec);
    each_cell(spec, [&](const Cell& c) {
      const double clearance = min_clearance(place.scene, spec.centre(c));
      if (std::abs(clearance - spec.inflation) > kDoubt) {
        EXPECT_EQ(centres->blocked(c), clearance < spec.inflation);
      }
    });
    const auto distances = place.world.distances(spec);
    each_cell(spec, [&](const Cell& c) {
      double least = kInfinity;
      each_cell(spec, [&](const Cell& other) {
        if (centres->blocked(other)) {
          least = std::min(least, (spec.centre(other) - spec.centre(c)).norm());
        }
      });
      const double found = distances->centre_distance(c);
      EXPECT_TRUE(found == least || std::abs(found - least) < 1e-5 * least) << found;
    });
  }
  EXPECT_GT(count[0], 1000);
  EXPECT_GT(count[1], 1000);
}
TEST(WorldOracle, RastersAreThoseOfAllSolids) { hold_rasters(0, 30); }
TEST(NightlyWorldOracle, RastersAreThoseOfAllSolids) { hold_rasters(1000, 1500); }

TEST(WorldOracle, TheGroundOfSeveralLayersIsTheHighest) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    oracle::Draw draw(seed);
    std::vector<Plane> planes;
    World world;
    for (int n = 0; n < 3; ++n) {
      planes.push_back({draw(-2, 2), {draw(-1, 1), draw(-1, 1)}});
      world = world.with({"ground" + std::to_string(n), "plane",
                          std::make_shared<GroundPlane>(planes.back()), true});
    }
    const Vec3 a = draw.point(10);
    const Vec3 b = draw.point(10);
    double highest = -kInfinity;
    for (const Plane& plane : planes) {
      highest = std::max(highest, a.z() - plane.above(a));
    }
    EXPECT_NEAR(world.ground(a.x(), a.y()).value(), highest, 1e-9);
    double least = kInfinity;
    for (int n = 0; n <= 100; ++n) {
      for (const Plane& plane : planes) {
        least = std::min(least, plane.above(a + n / 100.0 * (b - a)));
      }
    }
    EXPECT_NEAR(world.ground_gap(a, b), least, 1e-9);
    EXPECT_TRUE(world.ground_below(a, b));
  }
}

TEST(WorldOracle, MovingSolidsAreMetWhereSamplesInTimeMeetThem) {
  int met = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    oracle::Draw draw(seed);
    const oracle::Solid solid = oracle::random_solid(draw, draw.point(3), 1.5);
    const MovingObstacle obstacle{"m", solid.shape, draw.point(2), draw(-5, 5)};
    const Vec3 a = draw.point(6);
    const Vec3 b = draw.point(6);
    const double t0 = draw(0, 5);
    const double t1 = t0 + draw(0.5, 4);
    constexpr int kSteps = 2000;
    double least = kInfinity;
    for (int n = 0; n <= kSteps; ++n) {
      const double share = double(n) / kSteps;
      const double time = t0 + share * (t1 - t0);
      // The vehicle in the frame where the solid stands as it was drawn.
      const Vec3 p = a + share * (b - a) - obstacle.velocity * (time - obstacle.since_s);
      least = std::min(least, std::max(0.0, oracle::signed_distance(solid, p)));
    }
    const double speed = ((b - a) / (t1 - t0) - obstacle.velocity).norm();
    const double step = speed * (t1 - t0) / kSteps / 2 + 1e-6;
    const double found = separation(obstacle, a, t0, b, t1);
    EXPECT_LE(found, least + 1e-6) << seed;
    EXPECT_GE(found, least - step) << seed;
    EXPECT_TRUE(hits(obstacle, a, t0, b, t1, least + step)) << seed;
    EXPECT_FALSE(least > step && hits(obstacle, a, t0, b, t1, least - step)) << seed;
    met += least == 0;
  }
  EXPECT_GT(met, 10);
}
}  // namespace
}  // namespace altiplan::reference::world_oracle_test
