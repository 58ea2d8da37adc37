// SPDX-License-Identifier: Apache-2.0
// Lengths of astar compared with Dijkstra's algorithm, and metamorphic properties of lengths.
#include <gtest/gtest.h>

#include <string>

#include "altiplan/measures.hpp"
#include "astar_worlds_test.hpp"

namespace altiplan::astar_lengths_test {
namespace {

using testing::among;
using testing::Balls;
using testing::counter;
using testing::draw;
using testing::Drawn;
using testing::make_planner;
using testing::random_balls;
using testing::random_levels;
using testing::shortest;

/// True if every cell that the step's box (or only its ends) spans is free.
bool cells_free(const VoxelGrid& grid, const Cell& a, const Cell& b, bool box) {
  if (grid.blocked(a) || grid.blocked(b)) {
    return false;
  }
  for (int corner = 0; box && corner < 8; ++corner) {
    if (grid.blocked(corner & 1 ? a[0] : b[0], corner & 2 ? a[1] : b[1],
                     corner & 4 ? a[2] : b[2])) {
      return false;
    }
  }
  return true;
}

TEST(AStar, EqualsDijkstraOnRandomCells) {
  SplitMix64 random(1);
  int solved = 0;
  for (int world = 0; world < 400; ++world) {
    const bool level = world % 2 == 0;
    const double densities[] = {0.1, 0.3, 0.45, 0.6};
    const auto levels = level ? random_levels(random, 14, 11, 1, densities[world / 2 % 4])
                              : random_levels(random, 7, 8, 6, densities[world / 2 % 4]);
    Drawn drawn = draw(levels, 10);
    if (level) {
      drawn.request.level_m = drawn.request.start.position.z();
    }
    GridSpec spec = *drawn.world->native_grid();
    spec.rule = GridSpec::Rule::native;
    const auto grid = drawn.world->voxels(spec);
    for (const bool box : {false, true}) {
      for (const int neighbours : {6, 26}) {
        const double expected =
            shortest(spec.counts, spec.cell, spec.cell_of(drawn.request.start.position),
                     spec.cell_of(drawn.request.goal.position), neighbours,
                     [&](const Cell& a, const Cell& b) { return cells_free(*grid, a, b, box); });
        for (const char* heuristic : {"octile", "euclidean", "zero"}) {
          const auto planner =
              make_planner("astar", std::string("{corner: ") + (box ? "free_box" : "any") +
                                        ", neighbours: " + std::to_string(neighbours) +
                                        ", heuristic: " + heuristic + "}");
          const PlanResult result = planner->plan(drawn.request);
          if (expected == kInfinity) {
            EXPECT_EQ(result.status, PlanStatus::no_route) << result.message;
            EXPECT_TRUE(result.proved);
          } else {
            ++solved;
            ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
            EXPECT_NEAR(length(result.route), expected, 1e-9 * expected);
            EXPECT_TRUE(check(result.route, drawn.request).ok());
          }
        }
      }
    }
  }
  EXPECT_GT(solved, 1000);
}

TEST(AStar, ByCellsEqualsDijkstraWhereStepsAreRuledOut) {
  SplitMix64 random(8);
  int solved = 0;
  for (int world = 0; world < 60; ++world) {
    Drawn drawn = draw(random_levels(random, 9, 8, 7, 0.2), 10);
    if (world % 3 == 0) {
      drawn.request.limits.min_leg = 12;  // along one axis
    } else if (world % 3 == 1) {
      drawn.request.limits.max_leg = 15;  // along all three
    } else {
      drawn.request.limits.max_climb = radians(40);
    }
    const GridSpec spec = *drawn.world->native_grid();
    GridSpec native = spec;
    native.rule = GridSpec::Rule::native;
    const auto grid = drawn.world->voxels(native);
    const double expected = shortest(
        spec.counts, spec.cell, spec.cell_of(drawn.request.start.position),
        spec.cell_of(drawn.request.goal.position), 26, [&](const Cell& a, const Cell& b) {
          const double length = (spec.centre(b) - spec.centre(a)).norm();
          return cells_free(*grid, a, b, false) && length >= drawn.request.limits.min_leg &&
                 length <= drawn.request.limits.max_leg &&
                 climb_angle(spec.centre(b) - spec.centre(a)) <= drawn.request.limits.max_climb;
        });
    const PlanResult result = make_planner("astar")->plan(drawn.request);
    ASSERT_EQ(result.status == PlanStatus::solved, expected < kInfinity) << result.message;
    if (expected < kInfinity) {
      ++solved;
      EXPECT_NEAR(length(result.route), expected, 1e-6 * expected);
    }
  }
  EXPECT_GT(solved, 20);
}

TEST(AStar, ExactMovesEqualDijkstraUnderTheJudge) {
  SplitMix64 random(2);
  int solved = 0;
  for (int world = 0; world < 60; ++world) {
    Request request = among(random_balls(random, 4 + world % 20));
    request.limits.max_climb = world % 3 == 0 ? radians(35) : kPi / 2;
    const Cell counts = {10, 9, 9};  // centres at 0, 5 … 40 m of height
    const Vec3 cell(10, 10, 5);
    const auto at = [&](const Cell& c) { return Vec3(5 + 10 * c[0], 5 + 10 * c[1], 5.0 * c[2]); };
    const double expected = shortest(
        counts, cell, {0, 0, 1}, {9, 8, 7}, 26,
        [&](const Cell& a, const Cell& b) { return leg_ok(std::nullopt, at(a), at(b), request); });
    const auto planner = make_planner("astar", "{cell_m: [10, 10, 5]}");
    const PlanResult result = planner->plan(request);
    if (result.status == PlanStatus::invalid_problem) {
      continue;
    }
    ASSERT_EQ(result.status == PlanStatus::solved, expected < kInfinity) << result.message;
    if (expected < kInfinity) {
      ++solved;
      EXPECT_NEAR(length(result.route), expected, 1e-9 * expected);
      EXPECT_TRUE(check(result.route, request).ok());
    } else {
      EXPECT_TRUE(result.proved);
    }
    // Whole cells only: never shorter, and still valid.
    const PlanResult blocky =
        make_planner("astar", "{cell_m: [10, 10, 5], moves: cells}")->plan(request);
    if (blocky.status == PlanStatus::solved) {
      EXPECT_GE(length(blocky.route), length(result.route) - 1e-9);
      EXPECT_TRUE(check(blocky.route, request).ok());
    }
  }
  EXPECT_GT(solved, 30);
}

TEST(AStar, EmptyMapOfThePaper) {
  Request request = testing::request_in(World(), {25e3, 70e3, 2e3}, {55e3, 10e3, 2.8e3},
                                        {{0, 0, 1e3}, {100e3, 100e3, 4e3}});
  request.limits.max_climb = radians(15);
  request.limits.max_turn_horizontal = radians(55);
  for (const char* heuristic : {"octile", "euclidean", "zero"}) {
    const PlanResult result =
        make_planner("astar",
                     std::string("{cell_m: [1000, 1000, 200], heuristic: ") + heuristic + "}")
            ->plan(request);
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    EXPECT_NEAR(length(result.route), 72482.7, 1) << heuristic;
    EXPECT_TRUE(check(result.route, request).ok());
  }
  request.limits.max_turn_horizontal = kPi;
  const auto octile = make_planner("astar", "{cell_m: [1000, 1000, 200]}")->plan(request);
  EXPECT_EQ(counter(octile, "expanded"), 61);  // straight there: 60 steps, all free
}

TEST(AStar, LengthIsInvariantUnderSwapMirrorAndTranslation) {
  SplitMix64 random(4);
  const auto planner = make_planner("astar", "{cell_m: [10, 10, 5]}");
  for (int world = 0; world < 20; ++world) {
    const auto balls = random_balls(random, 12);
    const PlanResult plain = planner->plan(among(balls));
    Request swapped = among(balls);
    std::swap(swapped.start.position, swapped.goal.position);
    auto mirrored = std::make_shared<Balls>(*balls);
    auto moved = std::make_shared<Balls>(*balls);
    for (std::size_t i = 0; i < balls->centres.size(); ++i) {
      mirrored->centres[i].x() = 100 - balls->centres[i].x();
      moved->centres[i] += Vec3(1000, -500, 250);
    }
    Request mirror = among(mirrored);
    mirror.start.position.x() = 95;
    mirror.goal.position.x() = 5;
    Request shift = among(moved);
    shift.start.position += Vec3(1000, -500, 250);
    shift.goal.position += Vec3(1000, -500, 250);
    shift.volume = {{1000, -500, 250}, {1100, -410, 290}};
    auto more = std::make_shared<Balls>(*balls);
    more->centres.push_back({50, 45, 20});
    for (const Request& request : {swapped, mirror, shift}) {
      const PlanResult other = planner->plan(request);
      ASSERT_EQ(other.status, plain.status);
      EXPECT_NEAR(length(other.route), length(plain.route), 1e-9 * length(plain.route));
    }
    const PlanResult fuller = planner->plan(among(more));
    if (fuller.status == PlanStatus::solved) {
      EXPECT_GE(length(fuller.route), length(plain.route) - 1e-9);
    }
  }
}

/// Rows of a corridor one cell wide that fills a square in turns.
std::string serpentine(int edge) {
  std::string text;
  for (int row = 0; row < edge; ++row) {
    std::string line(std::size_t(edge), row % 2 == 0 ? '.' : '#');
    if (row % 2 == 1) {
      (row % 4 == 1 ? line.back() : line.front()) = '.';
    }
    text += line + "\n";
  }
  text.front() = 'S';
  text[text.size() - 2] = 'G';
  return text;
}

TEST(AStar, WaysFarLongerThanTheMapIsWide) {
  const int edge = 1001;
  const int corridor = (edge + 1) / 2 * edge + edge / 2;  // cells: too many for the finest costs
  Drawn drawn = draw({serpentine(edge)});
  drawn.request.level_m = 0.5;
  const PlanResult result = make_planner("astar", "{corner: free_box}")->plan(drawn.request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_NEAR(length(result.route), corridor - 1, 1e-6);
  EXPECT_EQ(counter(result, "expanded"), corridor);
}

TEST(AStar, IntegerCostsAreWithinTheirError) {
  SplitMix64 random(6);
  const std::string exact = "{neighbours: 26}";
  const std::string integer = "{neighbours: 26, costs: integer}";
  double worst = 0;
  for (int world = 0; world < 100; ++world) {
    Drawn drawn = draw(random_levels(random, 20, 20, world % 2 == 0 ? 1 : 12, 0.3));
    if (world % 2 == 0) {
      drawn.request.level_m = 0.5;
    }
    const PlanResult best = make_planner("astar", exact)->plan(drawn.request);
    const PlanResult near = make_planner("astar", integer)->plan(drawn.request);
    ASSERT_EQ(near.status, best.status);
    if (best.status == PlanStatus::solved) {
      EXPECT_TRUE(check(near.route, drawn.request).ok());
      const double error = length(near.route) / length(best.route) - 1;
      EXPECT_LE(error, world % 2 == 0 ? 1.2e-4 : 1e-3);
      worst = std::max(worst, error);
      EXPECT_NE(near.message.find("% off"), std::string::npos) << near.message;
    }
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_FALSE(make_planner("astar", integer)->traits().optimal);
}
}  // namespace
}  // namespace altiplan::astar_lengths_test
