// SPDX-License-Identifier: Apache-2.0
// A world of neighbouring terrain tiles is the world of the whole model.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "altiplan/height_field.hpp"
#include "altiplan/world.hpp"
#include "support/support.hpp"

namespace altiplan::terrain_tiles_test {
namespace {

using testing::make_environment;

/// Columns and rows (from the south) of a model, the last ones not included.
struct Part {
  int west, east, south, north;
};

class Tiles : public ::testing::Test {
 protected:
  static constexpr int kColumns = 403;
  static constexpr int kRows = 344;
  static constexpr Part kWhole{0, kColumns, 0, kRows};

  void SetUp() override {
    folder_ =
        std::filesystem::temp_directory_path() / ("altiplan_tiles_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    const auto file = testing::configs() / "data/jacksboro_fault.tif";
    model_ = make_environment("terrain", "{file: '" + file.string() + "'}");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// The part as an ESRI ASCII grid.
  std::filesystem::path write(const Part& part) const {
    constexpr double kStep = 1.0 / 1200;
    const auto name =
        folder_ / (std::to_string(part.west) + "_" + std::to_string(part.east) + "_" +
                   std::to_string(part.south) + "_" + std::to_string(part.north) + ".asc");
    std::ofstream out(name);
    out.precision(17);
    out << "ncols " << part.east - part.west << "\nnrows " << part.north - part.south
        << "\nxllcorner " << -84.5 + (part.west - 0.5) * kStep << "\nyllcorner "
        << 36.25 + (part.south - 0.5) * kStep << "\ncellsize " << kStep << "\n";
    for (int j = part.north - 1; j >= part.south; --j) {
      for (int i = part.west; i < part.east; ++i) {
        out << model_->ground()->height_field()->post(i, j) << ' ';
      }
      out << '\n';
    }
    return name;
  }

  World world_of(const std::vector<Part>& parts) const {
    World world;
    for (const Part& part : parts) {
      Site site;
      site.before = &world;
      site.frame = world.frame();
      std::shared_ptr<const Environment> layer = make_environment(
          "terrain", "{crs: 'EPSG:4326', file: '" + write(part).string() + "'}", site);
      if (!world.frame().has_position()) {
        world = world.with_frame(*layer->info().frame);
      }
      world = world.with({"tile_" + std::to_string(world.layers().size()), "terrain", layer});
    }
    return world;
  }

  static Request request_in(World world, double ground_clearance) {
    const Box bounds = world.bounds();
    Request request = testing::request_in(
        std::move(world), {6000, 9000, 900}, {24000, 21000, 900},
        {{bounds.min.x(), bounds.min.y(), 200}, {bounds.max.x(), bounds.max.y(), 1400}});
    request.limits.min_clearance = 20;
    if (ground_clearance > 0) {
      request.limits.min_ground_clearance = ground_clearance;
    }
    return request;
  }

  static Route planned(const Request& request, const std::string& more) {
    const PlanResult result =
        testing::make_planner("astar", "{cell_m: [600, 600, 60]" + more + "}")->plan(request);
    EXPECT_EQ(result.status, PlanStatus::solved) << result.message;
    for (const Violation& violation : check(result.route, request).violations) {
      ADD_FAILURE() << violation.constraint << ": " << violation.message;
    }
    return result.route;
  }

  static void expect_same(const Route& a, const Route& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_NEAR((a[i] - b[i]).norm(), 0, 1e-5) << i;
    }
  }

  std::filesystem::path folder_;
  std::unique_ptr<Environment> model_;
};

const std::vector<std::vector<Part>> kCuts = {
    {{0, 200, 0, 344}, {200, 403, 0, 344}},  // half open: a spacing between the last posts
    {{0, 201, 0, 344}, {200, 403, 0, 344}},  // a column of posts in both
    {{0, 200, 0, 344}, {197, 403, 0, 344}},  // overlapping
};

TEST_F(Tiles, GroundHasNoSeams) {
  const World whole = world_of({kWhole});
  for (const std::vector<Part>& cut : kCuts) {
    const World tiles = world_of(cut);
    EXPECT_NEAR((tiles.bounds().max - whole.bounds().max).head<2>().norm(), 0, 1e-5);
    RandomStream random(2);
    const Box box = whole.bounds();
    const Box over{{1e-3, 1e-3, 1500}, {box.max.x() - 1e-3, box.max.y() - 1e-3, 1600}};
    for (int n = 0; n < 2000; ++n) {
      Vec3 a = random.in(over);
      Vec3 b = random.in(over);
      if (n % 2 == 0) {  // short, across the seam, or ending near it
        a.x() = box.max.x() * (198 + random.uniform(0, 4)) / (kColumns - 1);
        b = a + Vec3(random.uniform(-100, 100), random.uniform(-1, 1), 0);
        b.y() = std::clamp(b.y(), 0.0, over.max.y());
      }
      EXPECT_TRUE(tiles.ground_below(a, b));
      EXPECT_NEAR(tiles.ground_gap(a, b), whole.ground_gap(a, b), 1e-3);
      EXPECT_NEAR(tiles.ground_gap_max(a, b), whole.ground_gap_max(a, b), 1e-3);
      EXPECT_NEAR(*tiles.ground(a.x(), a.y()), *whole.ground(a.x(), a.y()), 1e-3);
    }
  }
}

TEST_F(Tiles, FourTilesInAnyOrderLeaveNoHole) {
  const Part nw{0, 200, 170, 344};
  const Part ne{200, 403, 170, 344};
  const Part sw{0, 200, 0, 170};
  const Part se{200, 403, 0, 170};
  for (const std::vector<Part>& order :
       {std::vector{nw, ne, sw, se}, std::vector{se, sw, ne, nw}, std::vector{nw, se, ne, sw}}) {
    const World tiles = world_of(order);
    const Box box = tiles.bounds();
    RandomStream random(4);
    for (int n = 0; n < 500; ++n) {
      Vec3 a = random.in(Box{box.min + Vec3(1, 1, 0), box.max - Vec3(1, 1, 0)}.intersected(
          {{-kInfinity, -kInfinity, 1500}, {kInfinity, kInfinity, 1600}}));
      const Vec3 b = {box.min.x() + box.max.x() - a.x(), box.min.y() + box.max.y() - a.y(), 1500};
      EXPECT_TRUE(tiles.ground_below(a, b)) << "legs through the middle";
    }
  }
}

TEST_F(Tiles, RoutesAreThoseOfTheWhole) {
  for (const char* more : {"", ", moves: cells"}) {
    for (const double ground_clearance : {0.0, 100.0}) {
      const Route whole = planned(request_in(world_of({kWhole}), ground_clearance), more);
      for (const std::vector<Part>& cut : kCuts) {
        expect_same(planned(request_in(world_of(cut), ground_clearance), more), whole);
      }
    }
  }
}

TEST_F(Tiles, NoRouteLeavesTheGround) {
  // Only the western half, in a volume that goes on to the east: the goal has no ground below it.
  Request request = request_in(world_of({kCuts[0][0]}), 0);
  request.volume.max.x() = 30000;
  const double edge = request.world->bounds().max.x();
  EXPECT_FALSE(request.world->blocked({edge + 50, 9000, 900}, {edge + 5000, 9000, 200}, 20));
  const Vec3 a(edge - 500, 9000, 1200);
  const Vec3 b(edge + 500, 9000, 1200);
  const auto found = leg_violations(std::nullopt, a, b, request, 3);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].constraint, "ground");
  EXPECT_EQ(found[0].at, 3u);
  const double named = std::stod(found[0].message.substr(found[0].message.find('(') + 1));
  EXPECT_NEAR(named, edge, 0.01) << found[0].message;
  EXPECT_NE(point_problem(b, request).find("no ground"), std::string::npos);
  EXPECT_TRUE(leg_ok(std::nullopt, a, {edge, 9000, 1200}, request)) << "up to the edge";
  EXPECT_NE(testing::make_planner("astar", "{cell_m: [600, 600, 60]}")->plan(request).status,
            PlanStatus::solved);
  // A way around the west of a wall is found, none over the unknown in the east.
  request.goal.position = {edge - 1000, 20000, 1200};
  request.start.position = {edge - 1000, 9000, 1200};
  World walled = *request.world;
  walled = walled.with({"wall", "box",
                        testing::world_of({BoxShape{{{3000, 14000, 0}, {edge + 200, 14500, 1400}}}})
                            .layers()[0]
                            .environment});
  request.world = std::make_shared<const World>(std::move(walled));
  double farthest = edge;
  for (const Vec3& p : planned(request, "")) {
    farthest = std::min(farthest, p.x());
    EXPECT_LE(p.x(), edge);
  }
  EXPECT_LT(farthest, 3000);
}
}  // namespace
}  // namespace altiplan::terrain_tiles_test
