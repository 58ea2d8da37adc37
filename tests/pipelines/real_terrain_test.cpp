// SPDX-License-Identifier: Apache-2.0
// Routes over real elevation models: planned, judged, and looked at again by sampling the ground.
#include <gtest/gtest.h>

#include <ostream>

#include "altiplan/environment.hpp"
#include "altiplan/world.hpp"
#include "support/files.hpp"
#include "support/support.hpp"

namespace altiplan::real_terrain_test {
namespace {

constexpr double kGroundClearance = 100;

struct Case {
  const char* name;
  const char* file;
  const char* more;    ///< parameters of terrain beside the file
  const char* volume;  ///< its two corners; the ceiling lies below the summits between the ends
  const char* cell;
  const char* start;  ///< east and north
  const char* goal;
};

// Metres from the south-west post. Each pair of ends has a mountain in between.
const Case kCases[] = {
    {"white_mountains_hgt", "dem/N44W072.hgt", "",
     "{min_m: [45000, 20000, 0], max_m: [66000, 42000, 1500]}", "[300, 300, 50]", "[47000, 29000]",
     "[64000, 31000]"},
    {"san_gabriel_utm", "dem/bigtujunga.tif", "", "{min_m: [0, 0, 0], max_m: [35800, 19200, 1700]}",
     "[250, 250, 50]", "[4000, 4000]", "[32000, 9000]"},
    {"front_range_without_crs", "dem/srtmgl3_boulder_co.asc", "crs: EPSG:4326",
     "{min_m: [0, 0, 2000], max_m: [10000, 13000, 3100]}", "[150, 150, 40]", "[9000, 1500]",
     "[1500, 11500]"},
    {"bernese_alps_with_voids", "dem/N46E008.tif", "voids: neighbours",
     "{min_m: [0, 40000, 0], max_m: [30000, 75000, 3400]}", "[400, 400, 80]", "[4000, 45000]",
     "[26000, 70000]"},
    {"sao_tome_dted", "dem/n00_e006_3arc_v2.dt1", "voids: neighbours",
     "{min_m: [45000, 8000, -50], max_m: [85000, 60000, 1500]}", "[400, 400, 50]", "[50000, 30000]",
     "[75000, 28000]"}};

void PrintTo(const Case& instance, std::ostream* out) { *out << instance.name; }

class RealTerrain : public ::testing::TestWithParam<Case> {};

std::string point(const char* east_north) {
  return "{at_m: " + std::string(east_north) + ", above_ground_m: 200}";
}

TEST_P(RealTerrain, ARouteIsPlannedAndSound) {
  const Case& with = GetParam();
  ALTIPLAN_DATA_OR_SKIP(dem, with.file);
  const testing::TempFolder folder;
  const std::string terrain =
      "{file: " + dem.string() + (*with.more != 0 ? ", " : "") + with.more + "}";
  folder.write("scenario.yaml", "altiplan: 1\nenvironment:\n  - terrain: " + terrain +
                                    "\nvolume: " + with.volume + "\nvehicle: {radius_m: 2}" +
                                    "\nstart: " + point(with.start) +
                                    "\ngoal: " + point(with.goal) + "\n");
  const auto pipeline = folder.write(
      "pipeline.yaml",
      "altiplan: 1\nscenario: scenario.yaml\nconstraints:\n  - ground_clearance: {min_m: 100}\n"
      "  - climb_angle: {max_deg: 20}\nsteps:\n  - plan: astar\n    with: {cell_m: " +
          std::string(with.cell) + "}\n  - smooth: prune\n");
  const testing::Ran ran = testing::run_file(pipeline);
  const host::Json& result = ran.json;
  ASSERT_EQ(result["status"], "solved") << result["message"];
  EXPECT_TRUE(result["check"]["ok"]);
  EXPECT_EQ(result["steps"][0]["status"], "solved");

  // Looked at again: heights of the ground below the route, every 5 m.
  const auto layer = testing::make_environment("terrain", terrain);
  Polyline route;
  const Frame& frame = layer->info().frame.value();  // of the whole model, not about the volume
  for (const host::Json& p : result["route_lonlat"]) {
    const auto [x, y] = frame.to_local(p[0].get<double>(), p[1].get<double>());
    route.emplace_back(x, y, p[2].get<double>());
  }
  const auto min_height = [&](const Vec3& a, const Vec3& b) {
    double least = kInfinity;
    const int steps = 1 + int((b - a).norm() / 5);
    for (int i = 0; i <= steps; ++i) {
      const Vec3 p = a + (b - a) * (double(i) / steps);
      least = std::min(least, p.z() - layer->ground()->height(p.x(), p.y()).value());
    }
    return least;
  };
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    EXPECT_GE(min_height(route[i], route[i + 1]), kGroundClearance - 1e-6) << i;
  }
  EXPECT_LT(min_height(route.front(), route.back()), kGroundClearance)
      << "the straight line is free: this case shows nothing";
}

INSTANTIATE_TEST_SUITE_P(Dem, RealTerrain, ::testing::ValuesIn(kCases),
                         [](const auto& instance) { return instance.param.name; });
}  // namespace
}  // namespace altiplan::real_terrain_test
