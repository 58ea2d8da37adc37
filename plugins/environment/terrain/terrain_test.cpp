// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <thread>

#include "terrain_files_test.hpp"

namespace altiplan::terrain_test {
namespace {

struct Sample {
  int column;
  int row;  // from the north
  double height;
};

// Posts of a layer in its own frame lie at multiples of the spacing.
void expect_samples(const Environment& layer, int columns, int rows,
                    const std::vector<Sample>& samples) {
  const Box box = layer.bounds();
  for (const Sample& s : samples) {
    const double x = box.max.x() * s.column / (columns - 1);
    const double y = box.max.y() * (rows - 1 - s.row) / (rows - 1);
    ASSERT_TRUE(layer.ground()->height(x, y).has_value()) << s.column << ", " << s.row;
    EXPECT_NEAR(*layer.ground()->height(x, y), s.height, 1e-6) << s.column << ", " << s.row;
  }
}

struct RealDem {
  const char* file;
  const char* refused_for;  // message without parameters; "" if it loads
  const char* parameters;   // with which it loads
  int columns, rows;
  std::vector<Sample> samples;
  double lowest, highest;
};

class RealDems : public ::testing::TestWithParam<RealDem> {};

TEST_P(RealDems, LoadsOrIsRefusedAndHeightsAreExact) {
  const RealDem& dem = GetParam();
  ALTIPLAN_DATA_OR_SKIP(file, std::string("dem/") + dem.file);
  const std::string why = refusal(file);
  if (*dem.refused_for) {
    EXPECT_SAYS(why, dem.refused_for);
  } else {
    EXPECT_EQ(why, "");
  }
  const Made layer = make_environment("terrain", file_yaml(file, dem.parameters));
  expect_samples(*layer, dem.columns, dem.rows, dem.samples);
  ASSERT_FALSE(layer->info().notes.empty());
  const std::string note = layer->info().notes[0];
  EXPECT_SAYS(note, std::to_string(dem.columns) + " x " + std::to_string(dem.rows) + " posts");
  EXPECT_SAYS(note, std::to_string(int(dem.lowest)) + " to " + std::to_string(int(dem.highest)));
}

INSTANTIATE_TEST_SUITE_P(
    Files, RealDems,
    ::testing::Values(
        RealDem{"jacksboro_fault.tif", "", "", 403, 344, {}, 236, 1076},
        RealDem{
            "N46E008.tif",
            "103743 of 1442401 posts",
            "voids: neighbours",
            1201,
            1201,
            {{0, 0, 932}, {600, 600, 1473}, {1200, 1200, 272}, {300, 900, 2234}, {151, 556, 4173}},
            187,
            4173},
        RealDem{
            "N44W072.hgt",
            "",
            "",
            1201,
            1201,
            {{0, 0, 415}, {600, 600, 315}, {1200, 1200, 139}, {300, 900, 432}, {836, 875, 1908}},
            115,
            1908},
        RealDem{"n00_e006_3arc_v2.dt1",
                "4072 of 1442401 posts",
                "voids: fill_m, fill_m: 0",
                1201,
                1201,
                {{650, 877, 1979}},
                -7,
                1979},
        RealDem{"elev_vinschgau.tif",
                "445 of 48888 posts",
                "voids: neighbours",
                252,
                194,
                {{126, 97, 2030}, {63, 145, 2488}},
                388,
                3863},
        RealDem{"bigtujunga.tif",
                "",
                "",
                1197,
                643,
                {{0, 0, 945}, {598, 321, 1265}, {1196, 642, 872}, {299, 482, 1321}},
                315,
                2295},
        RealDem{"srtmgl3_boulder_co.asc",
                "crs: EPSG:4326",
                "crs: 'EPSG:4326'",
                144,
                144,
                {{0, 0, 2588}, {72, 72, 2754}, {143, 143, 2627}, {36, 108, 2850}},
                2186,
                3345}),
    [](const auto& named) {
      std::string name = named.param.file;
      std::replace_if(
          name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
      return name;
    });

TEST(Terrain, PlacesPostsByLonLat) {
  ALTIPLAN_DATA_OR_SKIP(hgt, "dem/N44W072.hgt");
  const Made geographic = make_environment("terrain", file_yaml(hgt));
  const Frame frame = *geographic->info().frame;
  const auto summit = frame.to_local(-71 - 364.0 / 1200, 44 + 325.0 / 1200);  // col 836, row 875
  EXPECT_NEAR(*geographic->ground()->height(summit[0], summit[1]), 1908, 1e-3);
  const auto corner = frame.to_lonlat(0, 0);
  EXPECT_NEAR(corner[0], -72, 1e-9);
  EXPECT_NEAR(corner[1], 44, 1e-9);
  const std::string extent = geographic->info().notes.back();
  EXPECT_SAYS(extent, "x 0 to " + std::to_string(std::lround(geographic->bounds().max.x())) + " m");
  EXPECT_SAYS(extent, "longitude -72.0000 to -71.0000, latitude 44.0000 to 45.0000");

  ALTIPLAN_DATA_OR_SKIP(utm, "dem/elev_vinschgau.tif");
  const Made projected = make_environment("terrain", file_yaml(utm, "voids: neighbours"));
  // Ortler, 10.5448 E 46.5090 N, lies at its UTM 32 position: 618375, 5151625 in the file.
  const auto lonlat = projected->info().frame->to_lonlat(0, 0);
  const auto back = projected->info().frame->to_local(lonlat[0], lonlat[1]);
  EXPECT_NEAR(back[0], 0, 1e-6);
  EXPECT_NEAR(back[1], 0, 1e-6);
  const auto ortler = projected->info().frame->to_local(10.5448, 46.5090);
  EXPECT_GT(*projected->ground()->height(ortler[0], ortler[1]), 3500);
}

TEST(Terrain, ComesIntoTheFrameOfTheWorld) {
  ALTIPLAN_DATA_OR_SKIP(file, "dem/jacksboro_fault.tif");
  const Made own = make_environment("terrain", file_yaml(file));
  Site site;
  site.frame = *own->info().frame;
  const Made again = make_environment("terrain", file_yaml(file), site);
  EXPECT_NEAR((again->bounds().max - own->bounds().max).head<2>().norm(), 0, 1e-4);
  EXPECT_NEAR(*again->ground()->height(15000, 15000), *own->ground()->height(15000, 15000), 1e-3);

  // Warped to UTM 16 N: the same ground at the same longitude and latitude.
  Site utm;
  utm.frame_crs = "EPSG:32616";
  const Made warped = make_environment("terrain", file_yaml(file), utm);
  EXPECT_NEAR(warped->bounds().min.head<2>().norm(), 0, 1e-5);
  EXPECT_LT(warped->info().frame->scale_error(warped->bounds()), 0.005);
  RandomStream random(1);
  int compared = 0;
  double worst = 0;
  for (int n = 0; n < 2000; ++n) {
    const double x = random.uniform(0, own->bounds().max.x());
    const double y = random.uniform(0, own->bounds().max.y());
    const auto lonlat = own->info().frame->to_lonlat(x, y);
    const auto there = warped->info().frame->to_local(lonlat[0], lonlat[1]);
    if (const auto height = warped->ground()->height(there[0], there[1])) {
      ++compared;
      worst = std::max(worst, std::abs(*height - *own->ground()->height(x, y)));
    }
  }
  EXPECT_GT(compared, 1800);
  EXPECT_LT(worst, 40);  // bilinear twice, posts 70 to 90 m apart on slopes of up to 45 degrees
  EXPECT_SAYS(warped->info().notes[1], "resampled");
  EXPECT_SAYS(refusal(file, "",
                      [] {
                        Site s;
                        s.frame_crs = "EPSG:4326";
                        return s;
                      }()),
              "projected");
}

TEST(Terrain, ProjectsFromSeveralThreads) {
  ALTIPLAN_DATA_OR_SKIP(utm, "dem/elev_vinschgau.tif");
  const Made layer = make_environment("terrain", file_yaml(utm, "voids: neighbours"));
  const Frame frame = *layer->info().frame;
  constexpr int kPoints = 500;
  const auto lonlat_of = [&](int n) { return frame.to_lonlat(20.0 * n, 9000 - 15.0 * n); };
  std::vector<std::array<double, 2>> expected;
  for (int n = 0; n < kPoints; ++n) {
    expected.push_back(lonlat_of(n));
  }
  std::array<int, 4> same{};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      const Frame& copy = frame;
      for (int n = t; n < kPoints + t; ++n) {
        const std::size_t k = std::size_t(n % kPoints);
        const auto lonlat = lonlat_of(int(k));
        const auto back = copy.to_local(lonlat[0], lonlat[1]);
        same[std::size_t(t)] +=
            lonlat == expected[k] && std::abs(back[0] - 20.0 * double(k)) < 1e-5;
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const int count : same) {
    EXPECT_EQ(count, kPoints);
  }
}

TEST(Terrain, LawsHoldOnRealGround) {
  ALTIPLAN_DATA_OR_SKIP(file, "dem/jacksboro_fault.tif");
  const Made layer = make_environment("terrain", file_yaml(file));
  const Box box = layer->bounds();
  RandomStream random(3);
  const Box around{{-500, -500, 200}, {box.max.x() + 500, box.max.y() + 500, 1600}};
  for (int n = 0; n < 3000; ++n) {
    const Vec3 p = random.in(around);
    const double clearance = layer->clearance(p);
    const Vec3 q = p + 100 * Vec3(random.normal(), random.normal(), random.normal());
    EXPECT_LE(std::abs(layer->clearance(q) - clearance), (q - p).norm() * (1 + 1e-9) + 1e-9);
    const auto ground = layer->ground()->height(p.x(), p.y());
    EXPECT_EQ(clearance<0, ground&& * ground> p.z());
    double minimum = kInfinity;
    layer->near(p, 5000, [&](const Nearby& nearby) {
      minimum = std::min(minimum, nearby.distance);
      EXPECT_NEAR(nearby.normal.norm(), 1, 1e-9);
      if (clearance > 0) {
        const double height = *layer->ground()->height(nearby.point.x(), nearby.point.y());
        if (ground) {
          EXPECT_NEAR(nearby.point.z(), height, 1e-6);
        } else {
          EXPECT_LE(nearby.point.z(), height + 1e-6);
        }
        EXPECT_NEAR((p - nearby.point).norm(), nearby.distance, 1e-6);
      }
    });
    EXPECT_GE(minimum, clearance - 1e-6);
    // Blocked is true if the ground near a sample of the leg is nearer than r, and false if
    // clearance exceeds r everywhere.
    const double r = random.uniform(0, 60);
    const Vec3 b = p + random.uniform(0, 10) * (q - p);
    const bool blocked = layer->blocked(p, b, r);
    EXPECT_EQ(blocked, layer->blocked(b, p, r));
    EXPECT_LE(layer->blocked(p, b, r / 2), blocked);
    double lowest = kInfinity;
    for (int k = 0; k <= 100; ++k) {
      const Vec3 on = p + (b - p) * k / 100;
      lowest = std::min(lowest, layer->clearance(on));
      const Vec3 near_it =
          on + random.uniform(0, r) * Vec3(random.normal(), random.normal(), -1).normalized();
      const auto height = layer->ground()->height(near_it.x(), near_it.y());
      if (height && *height > near_it.z()) {
        EXPECT_TRUE(blocked || (near_it - on).norm() > r - 1e-5) << n;
      }
    }
    EXPECT_FALSE(blocked && lowest > r + (b - p).norm() / 200) << n;
  }
}

TEST(Terrain, RasterLeavesNoGroundFree) {
  ALTIPLAN_DATA_OR_SKIP(file, "dem/jacksboro_fault.tif");
  const Made layer = make_environment("terrain", file_yaml(file));
  GridSpec spec;
  spec.origin = {-700, 1000, 200};
  spec.cell = {200, 300, 40};
  spec.counts = {160, 100, 30};
  for (const double inflation : {0.0, 35.0}) {
    spec.inflation = inflation;
    VoxelGrid grid(spec);
    layer->rasterize(grid);
    EXPECT_FALSE(grid.blocked(1, 50, 0)) << "beyond the posts";
    RandomStream random(5);
    std::size_t free = 0;
    for (int n = 0; n < 20000; ++n) {
      const Vec3 p = random.in(spec.box());
      const bool is_blocked = grid.blocked(spec.cell_of(p));
      free += !is_blocked;
      const auto ground = layer->ground()->height(p.x(), p.y());
      EXPECT_TRUE(is_blocked || !ground ||
                  (*ground < p.z() + 1e-6 && layer->ground()->gap(p, p) >= inflation - 1e-6));
    }
    EXPECT_GT(free, 5000u);
  }
  // Rule centre: no column is blocked higher than its ground requires.
  spec.rule = GridSpec::Rule::centre;
  spec.inflation = 0;
  VoxelGrid grid(spec);
  layer->rasterize(grid);
  for (int j = 0; j < spec.counts[1]; ++j) {
    for (int k = 0; k < spec.counts[2]; ++k) {
      const Vec3 c = spec.centre({80, j, k});
      EXPECT_EQ(grid.blocked(80, j, k),
                c.z() <= layer->ground()->height(c.x(), c.y()).value_or(-kInfinity));
    }
  }
}
}  // namespace
}  // namespace altiplan::terrain_test
