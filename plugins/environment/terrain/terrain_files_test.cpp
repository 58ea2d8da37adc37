// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>

#include <algorithm>

#include "terrain_files_test.hpp"

namespace altiplan::terrain_files_test {
namespace {

TEST_F(MadeFiles, SpikeBetweenSamplesIsSeen) {
  const auto file = grid("10 10 10 10 10\n10 10 10 10 10\n10 10 10.01 10 10\n10 10 10 10 10\n");
  const Made layer = make_environment("terrain", file_yaml(file));
  // Over the spike's post (200, 100); all 40 posts on the leg's line lie beside it.
  const Vec3 a(0, 100, 10.009);
  const Vec3 b(400, 100, 10.009);
  EXPECT_NEAR(layer->ground()->gap(a, b), -0.001, 1e-5);
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
  // Beside the solid's wall, over its upper edge and around its corner.
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

/// A GeoTIFF with only a header: the one strip of its posts is missing.
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
  tag(258, 3, 1, 16);    // bits per post
  tag(259, 3, 1, 1);     // not compressed
  tag(262, 3, 1, 1);     // black is zero
  tag(273, 4, 1, 0);     // the strip has no offset
  tag(277, 3, 1, 1);     // one band
  tag(278, 4, 1, rows);  // rows per strip
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
  EXPECT_SAYS(refusal(write("sparse.tif", hollow_tiff(40, 30))), "contain no data");
}

TEST_F(MadeFiles, VoidsFollowTheRule) {
  const auto file =
      grid("10 10 10 10 10\n10 -9 -9 10 10\n10 20 20 10 10\n10 10 10 10 10\n", "NODATA_value -9\n");
  EXPECT_SAYS(refusal(file), "2 of 20 posts");
  EXPECT_SAYS(refusal(file), "voids: neighbours");
  const Made filled = make_environment("terrain", file_yaml(file, "voids: fill_m, fill_m: 99"));
  EXPECT_DOUBLE_EQ(*filled->ground()->height(100, 200), 99);
  const Made mean = make_environment("terrain", file_yaml(file, "voids: neighbours"));
  EXPECT_NEAR(*mean->ground()->height(100, 200), (10 * 5 + 20 * 2) / 7.0, 1e-5);
  EXPECT_SAYS(mean->info().notes[0], "2 voids filled from their neighbours");
  EXPECT_SAYS(testing::parameter_problems("environment", "terrain", file_yaml(file, "fill_m: 1")),
              "requires voids: fill_m");
  EXPECT_SAYS(
      testing::parameter_problems("environment", "terrain", file_yaml(file, "voids: fill_m")),
      "requires fill_m, the height");
  const auto undeclared = grid("10 10 10 10 10\n10 -9999 5 10 10\n1 1 1 1 1\n1 1 1 1 1\n");
  EXPECT_SAYS(refusal(undeclared), "-9999 at column 1, row 1");
  EXPECT_EQ(refusal(undeclared, "nodata: -9999, voids: neighbours"), "");
}

TEST_F(MadeFiles, WhatIsNoNumberIsAVoidAmongWholeNumbersToo) {
  const auto file = grid("10 10 10 10 10\n10 nan 10 10 10\n10 10 10 10 10\n10 10 10 10 10\n");
  EXPECT_SAYS(refusal(file), "1 of 20 posts");
  for (const char* name : {"MADE.ASC", "other.grd", "other"}) {
    std::filesystem::copy_file(file, folder_ / name);
    EXPECT_SAYS(refusal(folder_ / name, "crs: EPSG:32632"), "1 of 20 posts");
  }
}

TEST_F(MadeFiles, AGridMayBeginWithAVoid) {
  for (const std::string nan : {"nan", "NaN", " nan"}) {
    const auto file = grid(nan + " 1 2 3 4\n" + nan + " 6 7 8 9\n10 11 12 13 14\n15 16 17 18 19\n");
    EXPECT_SAYS(refusal(file), "2 of 20 posts");
    const Made filled = make_environment("terrain", file_yaml(file, "voids: fill_m, fill_m: 99"));
    EXPECT_SAYS(filled->info().notes[0], "1 to 99 m");
  }
}

TEST_F(MadeFiles, HeightsAreAboveSeaLevel) {
  const auto of = [&](const std::string& vertical) {
    const auto file = grid(kFlat);
    std::ifstream in(folder_ / "made.prj");
    const std::string plane((std::istreambuf_iterator<char>(in)), {});
    write("made.prj", "COMPD_CS[\"both\"," + plane + ",VERT_CS[\"" + vertical +
                          "\",VERT_DATUM[\"a datum\",2005],UNIT[\"metre\",1],"
                          "AXIS[\"Up\",UP]]]");
    return file;
  };
  EXPECT_SAYS(refusal(of("Depth")), "expected heights");
  // EGM96's grid has the geoid 41.5 m above the ellipsoid at 9 degrees east, 45 degrees north.
  const Made lowered = make_environment("terrain", file_yaml(of("Ellipsoidal height")));
  EXPECT_NEAR(*lowered->ground()->height(100, 100), 10 - 41.5, 0.2);
  const Made layer = make_environment("terrain", file_yaml(of("EGM96 height")));
  const auto& notes = layer->info().notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note == "heights above the zero of 'EGM96 height'";
  }));
}

TEST_F(MadeFiles, PipesAreNeverWaitedFor) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe.tif").c_str(), 0600), 0);
  EXPECT_SAYS(refusal(folder_ / "pipe.tif"), "is a pipe, expected a file");
  for (const char* beside : {"heights.prj", "heights.asc.aux.xml"}) {
    const auto file = write("heights.asc", "nothing");
    ASSERT_EQ(::mkfifo((folder_ / beside).c_str(), 0600), 0);
    EXPECT_SAYS(refusal(file), "'" + std::string(beside) + "' beside it is a pipe");
    std::filesystem::remove(folder_ / beside);
  }
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
  EXPECT_SAYS(refusal(write("137.hgt", std::string(2 * 1201 * 1201, 'x'))),
              "named by their south-west corner, as N46E008.hgt");
  EXPECT_SAYS(refusal(grid("10 10 10\n10 10")), "damaged");
  EXPECT_SAYS(refusal(write("huge.asc",
                            "ncols 100000\nnrows 100000\nxllcorner 0\nyllcorner 0\n"
                            "cellsize 0.001\n1 1\n")),
              "max_posts");
  EXPECT_SAYS(refusal(grid(kFlat), "max_posts: 19"), "5 x 4 posts, more than max_posts (19)");
  EXPECT_SAYS(refusal(grid(kFlat), "band: 2"), "no band 2");
  EXPECT_SAYS(refusal(grid(kFlat), "crs: 'EPSG:32633'"), "its own coordinate system");
  EXPECT_SAYS(refusal(grid(kFlat), "crs: UTM32"), "expected EPSG:");
  EXPECT_SAYS(refusal(grid(kFlat), "crs: local"), "its own coordinate system");
  EXPECT_EQ(refusal(grid(kFlat)), "");
}

TEST_F(MadeFiles, WithoutACoordinateSystemItsNumbersAreTheWorlds) {
  const auto file = write("local.asc",
                          "ncols 3\nnrows 2\nxllcorner 0.5\nyllcorner 4.5\ncellsize 1\n"
                          "1 2 3\n4 5 6\n");
  EXPECT_SAYS(refusal(file, ""), "names no coordinate system");
  const Made layer = make_environment("terrain", file_yaml(file, "crs: local"));
  EXPECT_EQ(layer->ground()->height(1, 5), 4);
  EXPECT_EQ(layer->ground()->height(3, 6), 3);
  EXPECT_EQ(layer->ground()->height(0.99, 5), std::nullopt);
  EXPECT_FALSE(layer->info().frame && layer->info().frame->has_position());
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

// Contract and metamorphic properties -------------------------------------------------------------
}  // namespace
}  // namespace altiplan::terrain_files_test
