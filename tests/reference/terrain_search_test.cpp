// SPDX-License-Identifier: Apache-2.0
// A* over ground under limits against a plain search: equal lengths, and a route where there is
// one, in random parts of elevation models, with random cells, limits and obstacles.
#include <gtest/gtest.h>

#include <cstdio>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "altiplan/measures.hpp"
#include "framework/shape_oracle.hpp"
#include "reference/plain_lattice_search.hpp"
#include "support/folders.hpp"
#include "support/support.hpp"

namespace altiplan::terrain_search_test {
namespace {

struct Ground {
  std::shared_ptr<const Environment> layer;
  Box box;
};

Ground ground_of(const std::string& plugin, const std::string& parameters, const Box& volume) {
  const World nothing;
  Site site;
  site.volume = volume;
  site.before = &nothing;
  Ground ground{testing::make_environment(plugin, parameters, site), volume};
  if (plugin == "terrain") {
    ground.box = ground.layer->bounds();
  }
  return ground;
}

std::vector<Ground> grounds() {
  const std::string model =
      "{file: " + folders::source().string() + "/configs/data/jacksboro_fault.tif}";
  return {
      ground_of("terrain", model, {}),
      ground_of("hills", "{count: 30, extent_m: 20000, seed: 4}", {{0, 0, 0}, {2e4, 2e4, 5e3}})};
}

std::string yaml(const Vec3& cell, const char* state) {
  char text[160];
  std::snprintf(text, sizeof text, "{cell_m: [%.17g, %.17g, %.17g], moves: exact, state: %s}",
                cell.x(), cell.y(), cell.z(), state);
  return text;
}

struct Problem {
  Request request;
  Vec3 cell;
};

void draw_limits(oracle::Draw& draw, double height, Request& request) {
  Limits& limits = request.limits;
  if (draw.below(2) == 0) {
    limits.min_ground_clearance = draw(0, height / 4);
  }
  if (draw.below(3) == 0) {
    const double low = draw(0, height / 4);
    limits.altitude = {{AltitudeBand::Datum::ground, low, low + draw(height / 5, height)}};
  }
  if (draw.below(3) == 0) {
    request.vehicle.radius_m = limits.min_clearance = draw(1, height / 6);
  }
  if (draw.below(3) == 0) {
    limits.max_climb = radians(draw(10, 60));
  }
  if (draw.below(3) == 0) {
    limits.max_turn_horizontal = radians(draw(40, 100));
    limits.max_climb = std::min(limits.max_climb, radians(80));  // a vertical step has no heading
  }
}

/// A part of a ground, `cells` wide, with up to four solids; the ends are off the cells' centres at
/// random.
Problem draw_problem(const Ground& ground, std::uint64_t seed, int cells) {
  oracle::Draw draw(seed);
  Problem problem;
  problem.cell = {draw(40, 300), draw(40, 300), draw(10, 80)};
  const Vec3 size = problem.cell.cwiseProduct(
      Vec3{draw(3, cells), draw(3, cells), draw.below(4) == 0 ? 1 : draw(2, cells)});
  Vec3 low = draw.within(ground.box.min, ground.box.max - size);
  const auto height =
      ground.layer->ground()->height(low.x() + size.x() / 2, low.y() + size.y() / 2);
  low.z() = height.value_or(300) - draw(0, size.z() / 2);
  const Box volume{low, low + size};
  std::vector<Shape> solids;
  for (std::size_t n = draw.below(5); n > 0; --n) {
    const Vec3 at = draw.within(volume.min, volume.max);
    solids.push_back({Cylinder{at.x(), at.y(), draw(0.3, 1.5) * problem.cell.x(), low.z() - 10,
                               at.z() + size.z() / 3}});
  }
  World world = World().with({"ground", "ground", ground.layer});
  if (!solids.empty()) {
    world = world.with({"solids", "solids", std::make_shared<kit::ShapeLayer>(std::move(solids))});
  }
  Request& request = problem.request;
  request = testing::request_in(std::move(world), draw.within(volume.min, volume.max),
                                draw.within(volume.min, volume.max), volume);
  if (size.z() == problem.cell.z()) {
    request.level_m = request.start.position.z();
    request.goal.position.z() = *request.level_m;
  }
  draw_limits(draw, size.z(), request);
  return problem;
}

void hold(std::uint64_t first, int count, int cells) {
  const std::vector<Ground> all = grounds();
  int solved = 0;
  int none = 0;
  for (int n = 0; n < count; ++n) {
    const std::uint64_t seed = first + std::uint64_t(n);
    const Problem problem = draw_problem(all[seed % all.size()], seed, cells);
    const Request& request = problem.request;
    if (!start_problem(request).empty() || !goal_problem(request).empty()) {
      continue;
    }
    const kit::Lattice lattice(request, problem.cell, kit::Neighbourhood::all, {});
    const double shortest = reference::PlainLatticeSearch(request, lattice).length();
    const PlanResult result =
        testing::make_planner("astar", yaml(problem.cell, "auto"))->plan(request);
    const bool is_solved = result.status == PlanStatus::solved;
    (is_solved ? solved : none) += 1;
    const bool turns = request.limits.turns();  // refuse legs to the goal: longer ones are tried
    ASSERT_TRUE(is_solved == (shortest < kInfinity) || (is_solved && turns))
        << seed << ": " << shortest << " m; " << result.message;
    if (!is_solved) {
      continue;
    }
    ASSERT_TRUE(check(result.route, request).ok()) << seed;
    const double found = length(result.route);
    if (turns) {  // one parent a cell may miss the shortest route, not all
      const double widest = reference::PlainLatticeSearch(request, lattice, 3).length();
      ASSERT_GE(found, std::min(shortest, widest) * (1 - 1e-9)) << seed;
      if (shortest == kInfinity) {
        continue;
      }
      const PlanResult by_heading =
          testing::make_planner("astar", yaml(problem.cell, "cell_and_heading"))->plan(request);
      ASSERT_NEAR(length(by_heading.route), shortest, shortest * 1e-9) << seed;
    } else {
      ASSERT_NEAR(found, shortest, shortest * 1e-6) << seed;
    }
  }
  EXPECT_GT(solved, count / 20);
  EXPECT_GE(none, count / 100);
}

TEST(TerrainSearch, LengthsAndVerdictsAreThoseOfAPlainSearch) { hold(0, 1500, 9); }
TEST(TerrainSearch, InLargerVolumes) { hold(50'000, 40, 30); }

TEST(TerrainSearch, TurnsIntoTheGoalSeldomNeedASearchByHeading) {
  const Ground ground = grounds().front();
  World world = World().with({"ground", "ground", ground.layer});
  Request request = testing::request_in(std::move(world), {4000, 5000, 780}, {}, ground.box);
  request.volume.min.z() = 0;
  request.volume.max.z() = 1800;
  request.limits.min_ground_clearance = 150;
  request.limits.max_climb = radians(15);
  request.limits.max_turn_horizontal = radians(60);
  oracle::Draw draw(3);
  int by_heading = 0;
  for (int n = 0; n < 60; ++n) {
    const double x = draw(15'000, 25'000);
    const double y = draw(15'000, 25'000);
    request.goal.position = {x, y, *ground.layer->ground()->height(x, y) + draw(200, 300)};
    const PlanResult result =
        testing::make_planner("astar", yaml({250, 250, 50}, "auto"))->plan(request);
    ASSERT_EQ(result.status, PlanStatus::solved) << n << ": " << result.message;
    EXPECT_TRUE(check(result.route, request).ok()) << n;
    by_heading += result.message.find("one parent per cell found no route") != std::string::npos;
  }
  EXPECT_LE(by_heading, 1);
}

TEST(TerrainSearch, NamesWhatShutsTheGoalIn) {
  const Box volume{{0, 0, 0}, {2e4, 2e4, 3e3}};
  const Ground ground = ground_of("hills", "{count: 30, extent_m: 20000, seed: 4}", volume);
  std::vector<Shape> walls;
  for (const auto& [min, max] :
       std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>{{{12e3, 12e3}, {16e3, 12.5e3}},
                                                                {{12e3, 15.5e3}, {16e3, 16e3}},
                                                                {{12e3, 12e3}, {12.5e3, 16e3}},
                                                                {{15.5e3, 12e3}, {16e3, 16e3}}}) {
    walls.emplace_back(BoxShape{{{min.x(), min.y(), 0}, {max.x(), max.y(), 4e3}}});
  }
  World world = World().with({"ground", "ground", ground.layer});
  world = world.with({"ring", "solids", std::make_shared<kit::ShapeLayer>(std::move(walls))});
  Request request =
      testing::request_in(std::move(world), {2e3, 2e3, 2500}, {14e3, 14e3, 2500}, volume);
  request.limits.min_turn_radius = 50;
  const PlanResult result =
      testing::make_planner("astar", yaml({200, 200, 50}, "auto"))->plan(request);
  EXPECT_EQ(result.status, PlanStatus::no_route);
  EXPECT_TRUE(result.proved);
  EXPECT_TRUE(result.message.starts_with("no route: the goal is shut in: it can be reached from "))
      << result.message;
  EXPECT_NE(result.message.find("around which are refused clearance to 'ring'"), std::string::npos)
      << result.message;
}

TEST(NightlyTerrainSearch, LengthsAndVerdictsAreThoseOfAPlainSearch) {
  hold(1'000'000, 1'000'000, 7);
}
}  // namespace
}  // namespace altiplan::terrain_search_test
