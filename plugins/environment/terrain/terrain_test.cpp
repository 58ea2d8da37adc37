// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <thread>

#include "support/support.hpp"

namespace altiplan {
namespace {

using testing::make_environment;
using Made = std::unique_ptr<Environment>;

std::string file_yaml(const std::filesystem::path& file, const std::string& more = "") {
  return "{file: '" + file.string() + "'" + (more.empty() ? "" : ", " + more) + "}";
}

// What the plugin says of a file that it refuses; "" where it does not.
std::string refusal(const std::filesystem::path& file, const std::string& more = "",
                    const Site& site = {}) {
  try {
    make_environment("terrain", file_yaml(file, more), site);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

struct Sample {
  int column;
  int row;  // from the north
  double height;
};

// Posts of a layer in its own frame stand at multiples of the spacing.
void expect_samples(const Environment& layer, int columns, int rows,
                    const std::vector<Sample>& samples) {
  const Box box = layer.bounds();
  for (const Sample& s : samples) {
    const double x = box.max.x() * s.column / (columns - 1);
    const double y = box.max.y() * (rows - 1 - s.row) / (rows - 1);
    ASSERT_TRUE(layer.ground(x, y).has_value()) << s.column << ", " << s.row;
    EXPECT_NEAR(*layer.ground(x, y), s.height, 1e-6) << s.column << ", " << s.row;
  }
}

struct RealDem {
  const char* file;
  const char* refused_for;  // without parameters; "" where it loads
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
  ASSERT_FALSE(layer->notes().empty());
  const std::string note = layer->notes()[0];
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
  const Frame frame = *geographic->frame();
  const auto summit = frame.to_local(-71 - 364.0 / 1200, 44 + 325.0 / 1200);  // col 836, row 875
  EXPECT_NEAR(*geographic->ground(summit[0], summit[1]), 1908, 1e-3);
  const auto corner = frame.to_lonlat(0, 0);
  EXPECT_NEAR(corner[0], -72, 1e-9);
  EXPECT_NEAR(corner[1], 44, 1e-9);

  ALTIPLAN_DATA_OR_SKIP(utm, "dem/elev_vinschgau.tif");
  const Made projected = make_environment("terrain", file_yaml(utm, "voids: neighbours"));
  // Ortler, 10.5448 E 46.5090 N, stands where UTM 32 has it: 618375, 5151625 in the file.
  const auto lonlat = projected->frame()->to_lonlat(0, 0);
  const auto back = projected->frame()->to_local(lonlat[0], lonlat[1]);
  EXPECT_NEAR(back[0], 0, 1e-6);
  EXPECT_NEAR(back[1], 0, 1e-6);
  const auto ortler = projected->frame()->to_local(10.5448, 46.5090);
  EXPECT_GT(*projected->ground(ortler[0], ortler[1]), 3500);
}

TEST(Terrain, ComesIntoTheFrameOfTheWorld) {
  ALTIPLAN_DATA_OR_SKIP(file, "dem/jacksboro_fault.tif");
  const Made own = make_environment("terrain", file_yaml(file));
  Site site;
  site.frame = *own->frame();
  const Made again = make_environment("terrain", file_yaml(file), site);
  EXPECT_NEAR((again->bounds().max - own->bounds().max).head<2>().norm(), 0, 1e-4);
  EXPECT_NEAR(*again->ground(15000, 15000), *own->ground(15000, 15000), 1e-3);

  // Warped to UTM 16 N: the same ground at the same longitude and latitude.
  Site utm;
  utm.frame_crs = "EPSG:32616";
  const Made warped = make_environment("terrain", file_yaml(file), utm);
  EXPECT_NEAR(warped->bounds().min.head<2>().norm(), 0, 1e-5);
  EXPECT_LT(warped->frame()->scale_error(warped->bounds()), 0.005);
  RandomStream random(1);
  int compared = 0;
  double worst = 0;
  for (int n = 0; n < 2000; ++n) {
    const double x = random.uniform(0, own->bounds().max.x());
    const double y = random.uniform(0, own->bounds().max.y());
    const auto lonlat = own->frame()->to_lonlat(x, y);
    const auto there = warped->frame()->to_local(lonlat[0], lonlat[1]);
    if (const auto height = warped->ground(there[0], there[1])) {
      ++compared;
      worst = std::max(worst, std::abs(*height - *own->ground(x, y)));
    }
  }
  EXPECT_GT(compared, 1800);
  EXPECT_LT(worst, 40);  // bilinear twice, posts 70 to 90 m apart on slopes of up to 45 degrees
  EXPECT_SAYS(warped->notes()[1], "resampled");
  EXPECT_SAYS(refusal(file, "",
                      [] {
                        Site s;
                        s.frame_crs = "EPSG:4326";
                        return s;
                      }()),
              "projected");
}

// Files made here -----------------------------------------------------------------------------

class MadeFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::temp_directory_path() / ("altiplan_terrain_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  /// 5 x 4 posts 100 m apart in UTM 32 N, rows from the north.
  std::filesystem::path grid(const std::string& rows, const std::string& header = "") const {
    write("made.prj",
          "PROJCS[\"UTM32\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\","
          "6378137,298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\","
          "0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],PARAMETER["
          "\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",9],PARAMETER["
          "\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],PARAMETER["
          "\"false_northing\",0],UNIT[\"metre\",1]]");
    return write("made.asc",
                 "ncols 5\nnrows 4\nxllcorner 500000\nyllcorner 5000000\n"
                 "cellsize 100\n" +
                     header + rows);
  }
  static constexpr const char* kFlat =
      "10 10 10 10 10\n10 10 10 10 10\n10 10 10 10 10\n10 10 10 10 10\n";
  std::filesystem::path folder_;
};

TEST_F(MadeFiles, SpikeBetweenSamplesIsSeen) {
  const auto file = grid("10 10 10 10 10\n10 10 10 10 10\n10 10 10.01 10 10\n10 10 10 10 10\n");
  const Made layer = make_environment("terrain", file_yaml(file));
  // Over the spike's post (200, 100); all 40 posts of the leg's line lie beside it.
  const Vec3 a(0, 100, 10.009);
  const Vec3 b(400, 100, 10.009);
  EXPECT_NEAR(layer->ground_gap(a, b), -0.001, 1e-5);
  EXPECT_TRUE(layer->blocked(a, b, 0));
  const Vec3 up(0, 0, 0.0011);
  EXPECT_FALSE(layer->blocked(a + up, b + up, 0));
  EXPECT_FALSE(layer->blocked({10, 150, 12}, {390, 150, 12}, 1.9));
  EXPECT_TRUE(layer->blocked({10, 150, 12}, {390, 150, 12}, 2.01));
}

TEST_F(MadeFiles, BeyondThePostsNothingIsBlocked) {
  const Made layer = make_environment("terrain", file_yaml(grid(kFlat)));  // to (400, 300), 10 high
  EXPECT_FALSE(layer->blocked({10, 150, 30}, {900, 150, 0}, 2)) << "over the edge and down";
  EXPECT_TRUE(layer->blocked({10, 150, 13}, {500, 150, 0}, 2));
  // Beside the solid's wall, over its upper edge and about its corner.
  EXPECT_FALSE(layer->blocked({402, -50, 3}, {402, 350, 3}, 2));
  EXPECT_TRUE(layer->blocked({401.9999, -50, 3}, {401.9999, 350, 3}, 2));
  EXPECT_FALSE(layer->blocked({403, -50, 14}, {403, 350, 14}, 5));
  EXPECT_TRUE(layer->blocked({403, -50, 13.999}, {403, 350, 13.999}, 5));
  EXPECT_FALSE(layer->blocked({403, 304, 5}, {403, 304, -900}, 5));
  EXPECT_TRUE(layer->blocked({403, 303.999, 5}, {403, 303.999, -900}, 5));
  EXPECT_FALSE(layer->blocked({500, 300, 0}, {400, 300, 0}, 0)) << "touches";
  EXPECT_TRUE(layer->blocked({500, 300, 0}, {400, 300, 0}, 0.01));
  EXPECT_TRUE(layer->blocked({-500, -500, 5}, {900, 900, 5}, 0)) << "through the solid";
  EXPECT_NEAR(layer->clearance({403, 150, 14}), 5, 1e-9);
  EXPECT_NEAR(layer->clearance({403, 304, -70}), 5, 1e-9);
  EXPECT_NEAR(layer->clearance({399, 150, 0}), -1, 1e-9);
  layer->near({403, 304, 2}, 9, [](const Nearby& nearby) {
    EXPECT_NEAR((nearby.point - Vec3(400, 300, 2)).norm(), 0, 1e-9);
    EXPECT_NEAR((nearby.normal - Vec3(0.6, 0.8, 0)).norm(), 0, 1e-9);
    EXPECT_NEAR(nearby.distance, 5, 1e-9);
  });
}

/// A GeoTIFF with a header alone: the one strip of its posts is not there.
std::string hollow_tiff(std::uint32_t columns, std::uint32_t rows) {
  std::string head("II*\0\0\0\0\0", 8);
  std::string values;
  std::string entries;
  int count = 0;
  const auto put = [](std::string& to, auto value) {
    to.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  constexpr std::uint32_t kEntries = 13;
  const std::uint32_t values_at = 8 + 2 + kEntries * 12 + 4;
  const auto tag = [&](std::uint16_t name, std::uint16_t type, std::uint32_t n,
                       std::uint32_t value) {
    put(entries, name);
    put(entries, type);
    put(entries, n);
    put(entries, value);
    ++count;
  };
  const auto doubles = [&](std::uint16_t name, std::initializer_list<double> list) {
    tag(name, 12, std::uint32_t(list.size()), values_at + std::uint32_t(values.size()));
    for (const double value : list) {
      put(values, value);
    }
  };
  tag(256, 4, 1, columns);
  tag(257, 4, 1, rows);
  tag(258, 3, 1, 16);    // bits a post
  tag(259, 3, 1, 1);     // not compressed
  tag(262, 3, 1, 1);     // black is zero
  tag(273, 4, 1, 0);     // the strip stands nowhere
  tag(277, 3, 1, 1);     // one band
  tag(278, 4, 1, rows);  // rows a strip
  tag(279, 4, 1, 0);     // and has no bytes
  tag(339, 3, 1, 2);     // signed
  doubles(33550, {0.001, 0.001, 0});
  doubles(33922, {0, 0, 0, 8, 46, 0});
  tag(34735, 3, 12, values_at + std::uint32_t(values.size()));
  for (const int key : {1, 1, 0, 2, 1024, 0, 1, 2, 2048, 0, 1, 4326}) {
    put(values, std::uint16_t(key));
  }
  EXPECT_EQ(count, int(kEntries));
  head[4] = 8;
  put(head, std::uint16_t(kEntries));
  return head + entries + std::string(4, '\0') + values;
}

TEST_F(MadeFiles, HugeAndSparseTiffsAreRefused) {
  EXPECT_SAYS(refusal(write("huge.tif", hollow_tiff(200000, 72000))),
              "200000 x 72000 posts, more than max_posts");
  EXPECT_SAYS(refusal(write("sparse.tif", hollow_tiff(40, 30))), "hold no data");
}

TEST(Terrain, ProjectsFromSeveralThreads) {
  ALTIPLAN_DATA_OR_SKIP(utm, "dem/elev_vinschgau.tif");
  const Made layer = make_environment("terrain", file_yaml(utm, "voids: neighbours"));
  const Frame frame = *layer->frame();
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

TEST_F(MadeFiles, VoidsFollowTheRule) {
  const auto file =
      grid("10 10 10 10 10\n10 -9 -9 10 10\n10 20 20 10 10\n10 10 10 10 10\n", "NODATA_value -9\n");
  EXPECT_SAYS(refusal(file), "2 of 20 posts");
  EXPECT_SAYS(refusal(file), "voids: neighbours");
  const Made filled = make_environment("terrain", file_yaml(file, "voids: fill_m, fill_m: 99"));
  EXPECT_DOUBLE_EQ(*filled->ground(100, 200), 99);
  const Made mean = make_environment("terrain", file_yaml(file, "voids: neighbours"));
  EXPECT_NEAR(*mean->ground(100, 200), (10 * 5 + 20 * 2) / 7.0, 1e-5);
  EXPECT_SAYS(mean->notes()[0], "2 voids filled from their neighbours");
  EXPECT_SAYS(testing::parameter_problems("environment", "terrain", file_yaml(file, "fill_m: 1")),
              "it needs voids: fill_m");
  EXPECT_SAYS(
      testing::parameter_problems("environment", "terrain", file_yaml(file, "voids: fill_m")),
      "needs fill_m, the height");
  const auto undeclared = grid("10 10 10 10 10\n10 -9999 5 10 10\n1 1 1 1 1\n1 1 1 1 1\n");
  EXPECT_SAYS(refusal(undeclared), "-9999 at column 1, row 1");
  EXPECT_EQ(refusal(undeclared, "nodata: -9999, voids: neighbours"), "");
}

TEST_F(MadeFiles, DamagedAndForeignFilesAreRefused) {
  EXPECT_SAYS(refusal("/vsicurl/https://example.com/a.tif"), "virtual files");
  EXPECT_SAYS(refusal("https://example.com/a.tif"), "URL");
  EXPECT_SAYS(refusal(folder_ / "none.tif"), "no such file");
  EXPECT_SAYS(refusal(folder_), "expected a file");
  EXPECT_SAYS(refusal(write("text.tif", "not a picture at all")), "expected an elevation model");
  EXPECT_SAYS(refusal(write("empty.asc", "")), "expected an elevation model");
  EXPECT_SAYS(refusal(write("vrt.tif", "<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\"/>")),
              "expected an elevation model");
  EXPECT_SAYS(refusal(write("N46E008.hgt", std::string(1000, 'x'))), "expected an elevation model");
  EXPECT_SAYS(refusal(grid("10 10 10\n10 10")), "damaged");
  EXPECT_SAYS(refusal(write("huge.asc",
                            "ncols 100000\nnrows 100000\nxllcorner 0\nyllcorner 0\n"
                            "cellsize 0.001\n1 1\n")),
              "max_posts");
  EXPECT_SAYS(refusal(grid(kFlat), "max_posts: 19"), "5 x 4 posts, more than max_posts (19)");
  EXPECT_SAYS(refusal(grid(kFlat), "band: 2"), "no band 2");
  EXPECT_SAYS(refusal(grid(kFlat), "crs: 'EPSG:32633'"), "coordinate system of its own");
  EXPECT_SAYS(refusal(grid(kFlat), "crs: UTM32"), "expected EPSG:");
  EXPECT_EQ(refusal(grid(kFlat)), "");
}

TEST_F(MadeFiles, TruncatedTiffIsRefused) {
  ALTIPLAN_DATA_OR_SKIP(whole, "dem/bigtujunga.tif");
  std::ifstream in(whole, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  for (const std::size_t size : {std::size_t(8), std::size_t(300), bytes.size() / 2}) {
    const std::string why = refusal(write("cut.tif", bytes.substr(0, size)));
    EXPECT_NE(why, "") << size;
  }
}

// Laws ----------------------------------------------------------------------------------------

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
    const auto ground = layer->ground(p.x(), p.y());
    EXPECT_EQ(clearance<0, ground&& * ground> p.z());
    double least = kInfinity;
    layer->near(p, 5000, [&](const Nearby& nearby) {
      least = std::min(least, nearby.distance);
      EXPECT_NEAR(nearby.normal.norm(), 1, 1e-9);
      if (clearance > 0) {
        const double height = *layer->ground(nearby.point.x(), nearby.point.y());
        if (ground) {
          EXPECT_NEAR(nearby.point.z(), height, 1e-6);
        } else {
          EXPECT_LE(nearby.point.z(), height + 1e-6);
        }
        EXPECT_NEAR((p - nearby.point).norm(), nearby.distance, 1e-6);
      }
    });
    EXPECT_GE(least, clearance - 1e-6);
    // Blocked is true where the ground near a sample of the leg is nearer than r, and false where
    // clearance is beyond r everywhere.
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
      const auto height = layer->ground(near_it.x(), near_it.y());
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
      const auto ground = layer->ground(p.x(), p.y());
      EXPECT_TRUE(is_blocked || !ground ||
                  (*ground < p.z() + 1e-6 && layer->ground_gap(p, p) >= inflation - 1e-6));
    }
    EXPECT_GT(free, 5000u);
  }
  // Rule centre, and no column is blocked higher than its ground asks for.
  spec.rule = GridSpec::Rule::centre;
  spec.inflation = 0;
  VoxelGrid grid(spec);
  layer->rasterize(grid);
  for (int j = 0; j < spec.counts[1]; ++j) {
    for (int k = 0; k < spec.counts[2]; ++k) {
      const Vec3 c = spec.centre({80, j, k});
      EXPECT_EQ(grid.blocked(80, j, k), c.z() <= layer->ground(c.x(), c.y()).value_or(-kInfinity));
    }
  }
}
}  // namespace
}  // namespace altiplan
