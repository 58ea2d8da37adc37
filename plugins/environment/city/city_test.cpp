// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstring>
#include <map>

#include "altiplan/error.hpp"
#include "altiplan/random.hpp"
#include "altiplan/world.hpp"
#include "support/files.hpp"
#include "support/folders.hpp"
#include "support/support.hpp"

namespace altiplan::testing::city_test {
namespace {

const World kNothing;

std::unique_ptr<Environment> city(const std::string& yaml, const World& before = kNothing,
                                  const std::optional<Vec3>& start = {},
                                  const std::optional<Vec3>& goal = {}) {
  Site site;
  site.before = &before;
  site.frame = before.frame();
  site.start = start;
  site.goal = goal;
  return make_environment("city", yaml, site);
}

std::string refusal(const std::string& yaml) {
  try {
    city(yaml);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

VoxelGrid cells_of(const Environment& layer) {
  VoxelGrid grid(layer.info().native_grid.value());
  layer.rasterize(grid);
  return grid;
}

/// A direct implementation of the specification, cell by cell: a building grown by one cell on its
/// sides and top.
class Plain {
 public:
  Plain(Cell start, Cell goal) : kept_{start, goal} {}
  void place(int x, int y, int w, int d, int h) {
    const auto in = [&](const Cell& c) {
      return c[0] >= x - 1 && c[0] < x + w + 1 && c[1] >= y - 1 && c[1] < y + d + 1 && c[2] < h + 1;
    };
    if (in(kept_[0]) || in(kept_[1])) {
      return;
    }
    for (int k = 0; k < 100; ++k) {
      for (int j = 0; j < 80; ++j) {
        for (int i = 0; i < 80; ++i) {
          if (in({i, j, k})) {
            blocked[std::size_t((k * 80 + j) * 80 + i)] = true;
          }
        }
      }
    }
  }
  std::vector<bool> blocked = std::vector<bool>(80 * 80 * 100, false);

 private:
  std::array<Cell, 2> kept_;
};

Plain plain_city(bool simple, std::uint64_t seed, Cell start, Cell goal) {
  Plain plain(start, goal);
  SplitMix64 random(seed);
  const int count = simple ? 16 : 60;
  for (int n = 0; n < count; ++n) {
    if (simple) {
      const double u = random.uniform();
      const int w = random.integer(6, 10);
      const int d = random.integer(6, 10);
      const int h = random.integer(20, 60);
      if (u < 0.75) {
        plain.place(20 * (n % 4) + (20 - w) / 2, 20 * (n / 4) + (20 - d) / 2, w, d, h);
      }
    } else {
      const int w = random.integer(3, 9);
      const int d = random.integer(3, 9);
      const int x = random.integer(0, 80 - w);
      const int y = random.integer(0, 80 - d);
      const int h = random.integer(60, 95);
      plain.place(x, y, w, d, h);
    }
  }
  return plain;
}

TEST(City, DrawsThePagesCities) {
  for (const bool simple : {true, false}) {
    const Cell start = simple ? Cell{1, 1, 1} : Cell{1, 2, 4};
    const Cell goal = simple ? Cell{67, 64, 99} : Cell{67, 64, 4};
    for (const int seed : {0, 1, 17, 199}) {
      const auto at = [](const Cell& c) {
        return Vec3(10 * c[0] + 5, 10 * c[1] + 5, 10 * c[2] + 5);
      };
      const auto layer = city(std::string("{generate: ") + (simple ? "simple" : "complex") +
                                  ", seed: " + std::to_string(seed) + "}",
                              kNothing, at(start), at(goal));
      const VoxelGrid grid = cells_of(*layer);
      const Plain plain = plain_city(simple, std::uint64_t(seed), start, goal);
      std::size_t differ = 0;
      for (std::size_t n = 0; n < plain.blocked.size(); ++n) {
        const int i = int(n % 80);
        const int j = int(n / 80 % 80);
        differ += grid.blocked(i, j, int(n / 6400)) != plain.blocked[n];
      }
      EXPECT_EQ(differ, 0U) << simple << seed;
      EXPECT_FALSE(grid.blocked(start));
      EXPECT_FALSE(grid.blocked(goal));
    }
  }
}

TEST(City, TheRunsSeedMovesACityWithoutItsOwn) {
  const auto drawn = [](std::uint64_t seed) {
    Site site;
    site.before = &kNothing;
    site.random = RandomStream(seed);
    return cells_of(*make_environment("city", "{generate: complex}", site));
  };
  EXPECT_TRUE(VoxelGrid::diff(drawn(1), drawn(1)).empty());
  EXPECT_FALSE(VoxelGrid::diff(drawn(1), drawn(2)).empty());
}

std::string footprint(const std::string& properties, double lon = 8.1) {
  const auto at = [&](double east, double north) {
    return "[" + std::to_string(lon + east) + "," + std::to_string(46.5 + north) + "]";
  };
  return R"({"type":"Feature","id":"hall","properties":{)" + properties +
         R"(},"geometry":{"type":"Polygon","coordinates":[[)" + at(0, 0) + "," + at(0.001, 0) +
         "," + at(0.001, 0.001) + "," + at(0, 0.001) + "," + at(0, 0) + "]]}}";
}

TEST(City, HeightsAreNumbersOrTextAndTheRestByRule) {
  const TempFolder folder;
  const auto top = [&](const std::string& properties, const std::string& more) {
    const auto file = folder.write("f.geojson", footprint(properties));
    return city("{file: " + file.string() + more + "}")->bounds().max.z();
  };
  EXPECT_EQ(top(R"("height": 21.5)", ""), 21.5);
  EXPECT_EQ(top(R"("height": "21.5")", ""), 21.5);
  EXPECT_EQ(top(R"("levels": 4)", ", levels_property: levels"), 12);
  EXPECT_EQ(top(R"("levels": 4)", ", levels_property: levels, metres_per_level: 2.5"), 10);
  EXPECT_EQ(top(R"("name": "x")", ", default_height_m: 7, base_m: 100"), 107);
  EXPECT_EQ(top(R"("height": null, "tall": 3)", ", height_property: tall"), 3);
}

TEST(City, AnOutlineThatMeetsItselfIsBuiltOnInAllItsLoops) {
  const TempFolder folder;
  const auto file = folder.write(
      "bow.geojson",
      R"({"type":"Feature","id":"bow","properties":{"height":20},"geometry":{"type":"Polygon",)"
      R"("coordinates":[[[8,46],[8.001,46.001],[8.001,46],[8,46.001],[8,46]]]}})");
  const World here = World().with_frame(Frame::geographic(8, 46, 46));
  const auto layer = city("{file: " + file.string() + "}", here);
  for (const double lon : {8.0002, 8.0008}) {
    const auto [x, y] = here.frame().to_local(lon, 46.0005);
    EXPECT_LT(layer->clearance({x, y, 10}), 0) << lon;
  }
  EXPECT_EQ(layer->info().notes.back(),
            "rings that are no polygon, closed in all that they may enclose: 'bow'");
}

TEST(City, FootprintsStandOnTheGround) {
  const World ground = world_of(make_environment(
      "hills", "{base_m: 100, peaks: [{at_m: [40, 40], height_m: 30, sigma_m: [60, 60]}]}"));
  const TempFolder folder;
  const auto file = folder.write("f.geojson", footprint(R"("height": 10)"));
  const World placed = ground.with_frame(Frame::geographic(8.1, 46.5, 46.5));
  const Box box = city("{file: " + file.string() + "}", placed)->bounds();
  double low = kInfinity;
  double high = -kInfinity;
  for (const double x : {box.min.x(), box.max.x()}) {
    for (const double y : {box.min.y(), box.max.y()}) {
      low = std::min(low, *placed.ground(x, y));
      high = std::max(high, *placed.ground(x, y));
    }
  }
  EXPECT_DOUBLE_EQ(box.min.z(), low);
  EXPECT_DOUBLE_EQ(box.max.z(), high + 10);
  EXPECT_GT(high, low);
}

TEST(City, CollidersAreNorthEastUp) {
  const TempFolder folder;
  const auto file = folder.write("c.csv",
                                 "lat0 37.79248, lon0 -122.39745\n"
                                 "posX,posY,posZ,halfSizeX,halfSizeY,halfSizeZ\n"
                                 "100,-40,20,5,8,20\r\n\n");
  const auto layer = city("{file: " + file.string() + "}");
  EXPECT_EQ(layer->bounds().min, Vec3(-48, 95, 0));
  EXPECT_EQ(layer->bounds().max, Vec3(-32, 105, 40));
  const auto lonlat = layer->info().frame->to_lonlat(0, 0);
  EXPECT_DOUBLE_EQ(lonlat[0], -122.39745);
  EXPECT_DOUBLE_EQ(lonlat[1], 37.79248);
}

std::string sample(const char* name) {
  return altiplan::folders::source().string() + "/plugins/environment/city/" + name;
}

TEST(City, CityJsonIsNeverSmallerThanItsModel) {
  const auto layer = city("{file: " + sample("conformance.city.json") + "}");
  // The farm: a gable of 11 m; the barn protrudes to 37 m east of the origin, at any height.
  EXPECT_EQ(layer->bounds().min, Vec3(0, 0, 3));
  EXPECT_LT(layer->clearance({6, 9, 13.9}), 0);
  EXPECT_LT(layer->clearance({36.5, 8, 7}), 0);
  EXPECT_GT(layer->clearance({37.5, 8, 7}), 0);
  EXPECT_GT(layer->clearance({18, 9, 5}), 0);
}

/// A building of 40 m by 40 m at 60 degrees north, where Web Mercator doubles lengths.
TEST(City, MetresAreMetresOnTheGround) {
  const std::string json = R"({"type": "CityJSON", "version": "2.0",
    "metadata": {"referenceSystem": "https://www.opengis.net/def/crs/EPSG/0/CODE"},
    "transform": {"scale": [1, 1, 1], "translate": [EAST, NORTH, 0]},
    "CityObjects": {"b": {"type": "Building", "geometry": [{"type": "Solid", "lod": "1",
      "boundaries": [[[[3, 2, 1, 0]], [[4, 5, 6, 7]], [[0, 1, 5, 4]], [[1, 2, 6, 5]],
                      [[2, 3, 7, 6]], [[3, 0, 4, 7]]]]}]}},
    "vertices": [[0, 0, 0], [SIDE, 0, 0], [SIDE, SIDE, 0], [0, SIDE, 0],
                 [0, 0, 9], [SIDE, 0, 9], [SIDE, SIDE, 9], [0, SIDE, 9]]})";
  const TempFolder folder;
  const auto written = [&](std::string text, const char* code, const char* east, const char* north,
                           const char* side) {
    for (const auto& [word, value] : {std::pair("CODE", code), std::pair("EAST", east),
                                      std::pair("NORTH", north), std::pair("SIDE", side)}) {
      for (std::size_t at; (at = text.find(word)) != text.npos;) {
        text.replace(at, std::strlen(word), value);
      }
    }
    return folder.write(std::string(code) + ".city.json", text).string();
  };
  const std::string mercator = written(json, "3857", "2771815", "8399737", "80");
  const std::string utm = written(json, "25835", "400000", "6652000", "40");
  for (const std::string& file : {mercator, utm}) {
    const Box box = city("{file: " + file + "}")->bounds();
    EXPECT_NEAR(box.max.x() - box.min.x(), 40, 0.3) << file;
    EXPECT_NEAR(box.max.y() - box.min.y(), 40, 0.3) << file;
  }
  EXPECT_NE(refusal("{file: " + mercator + ", origin_m: [0, 0]}").find("lengths that are not true"),
            std::string::npos);
}

TEST(City, RealFilesAreReadWhole) {
  ALTIPLAN_DATA_OR_SKIP(folder, "city");
  const auto notes = [&](const std::string& name, const std::string& more) {
    return city("{file: " + (folder / name).string() + more + "}")->info().notes;
  };
  EXPECT_EQ(notes("ny_buildings.geojson", "").front(),
            "15 buildings, 0 features without an area skipped");
  EXPECT_EQ(notes("brussels_place_saint_jean.geojson", "").front(),
            "58 buildings, 11 features without an area skipped");
  const auto berlin =
      notes("berlin_buildings.geojson", ", levels_property: levels, default_height_m: 12");
  EXPECT_EQ(berlin[0], "635 buildings, 0 features without an area skipped");
  EXPECT_EQ(berlin[1], "305 heights as given, 161 from levels, 169 from default_height_m");
  EXPECT_EQ(notes("sf_colliders.csv", "").front(), "3845 boxes");
  EXPECT_EQ(notes("DH_01_subs.city.json", "").front().substr(0, 9), "9 prisms,");
  EXPECT_NE(refusal("{file: " + (folder / "berlin_buildings.geojson").string() + "}")
                .find("has no "
                      "'height'"),
            std::string::npos);
  const Box san_francisco =
      city("{file: " + (folder / "sf_colliders.csv").string() + "}")->bounds();
  EXPECT_NEAR(san_francisco.max.z(), 212, 1);
  EXPECT_NEAR(san_francisco.min.x(), -444.2, 0.1);  // east: the file's second column
  EXPECT_NEAR(san_francisco.min.y(), -315.2, 0.1);
}

TEST(City, WhatIsWrongIsNamed) {
  const TempFolder folder;
  const std::string csv = "lat0 37.8, lon0 -122.4\nposX,posY,posZ,halfSizeX,halfSizeY,halfSizeZ\n";
  const std::string json = text_of(sample("conformance.city.json"));
  struct Case {
    std::string name;
    std::string text;
    std::string why;
  };
  const std::vector<Case> cases = {
      {"a.csv", "", ":1: expected 'lat0 DEGREES, lon0 DEGREES'"},
      {"a.csv", "lat0 137.8, lon0 -122.4\n", ":1: expected 'lat0"},
      {"a.csv", "lat0 nan, lon0 -122.4\n", ":1: expected 'lat0"},
      {"a.csv", "lat0 37.8, lon0 -122.4\nx,y,z\n", ":2: expected the columns"},
      {"a.csv", csv, "contains no box"},
      {"a.csv", csv + "1,2,3,4,5\n", ":3: expected six numbers"},
      {"a.csv", csv + "1,2,3,4,5,6,7\n", ":3: expected six numbers"},
      {"a.csv", csv + "1,2,3,4,5,nan\n", ":3: expected six numbers"},
      {"a.csv", csv + "1,2,3,4,5,1e999\n", ":3: expected six numbers"},
      {"a.csv", csv + "1,2,3,4,0,6\n", ":3: expected half sizes above 0"},
      {"a.csv", csv + "1,2,3,4,-5,6\n", ":3: expected half sizes above 0"},
      {"a.json", replaced(json, "\"CityObjects\"", "\"Objects\""), "key 'CityObjects' not found"},
      {"a.json", replaced(json, "\"vertices\"", "\"vertexes\""), "key 'vertices' not found"},
      {"a.json", replaced(json, "[[[[3", "[[[[999"), "expected the index of one of the"},
      {"a.json", replaced(json, "[[[[3", "[[[[-1"), "expected the index of one of the"},
      {"a.json", replaced(json, "\"Solid\"", "\"Sponge\""), "surfaces or solids, found 'Sponge'"},
      {"a.json", replaced(json, "[0.001", "[1e308"), "is not finite"},
      {"a.json", replaced(json, "[0.001", "[\"x\""), "must be number"},
      {"a.json", json.substr(0, json.size() / 2), "is not valid JSON"},
      {"a.json", replaced(json, "\"semantics\"", "\"semantics\": 7, \"other\""), ""},
      {"a.geojson", R"({"type":"FeatureCollection","features":[]})", "contains no building"},
      {"a.geojson", footprint(R"("height": "tall")"), "expected metres in the property 'height'"},
      {"a.geojson", footprint(R"("height": -3)"), "expected a 'height' above 0"},
      {"a.geojson", footprint(R"("height": 0)"), "expected a 'height' above 0"},
      {"a.geojson", footprint(R"("height": 1e999)"), "too large"},
      {"a.geojson", footprint(""), "'hall': has no 'height'"},
      {"a.geojson", footprint(R"("height": 3)", 190), "expected longitude"},
      {"a.geojson", "[1,\n2", "a.geojson:2:2: is not valid JSON"},
      {"a.geojson", "lat0 37.8", "is not valid JSON"}};
  for (const Case& one : cases) {
    const auto file = folder.write(one.name, one.text);
    const std::string said = refusal("{file: " + file.string() + "}");
    EXPECT_NE(said.find(one.why), std::string::npos) << one.text.substr(0, 200) << "\n" << said;
  }
  EXPECT_NE(refusal("{}").find("give either file, or generate"), std::string::npos);
  EXPECT_NE(refusal("{generate: simple, cells: [1e5, 1e5, 1e5]}").find("max_cells"),
            std::string::npos);
  EXPECT_NE(refusal("{generate: simple, cells: [80.5, 80, 100]}").find("whole numbers"),
            std::string::npos);
}
}  // namespace
}  // namespace altiplan::testing::city_test
