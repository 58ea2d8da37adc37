// SPDX-License-Identifier: Apache-2.0
// Sessions of dstar_lite: a repaired plan is as long as a new one.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "dstar_worlds_test.hpp"

namespace altiplan::dstar_session_test {
namespace {

using testing::expanded;
using testing::Flown;
using testing::make_planner;
using testing::random_cell;
using testing::random_cells;
using testing::spec_of;

/// Random parameters of a sequence of edits.
struct Setting {
  Cell counts{12, 10, 6};
  Vec3 cell{10, 10, 10};
  bool level = false;
  const char* with = "{moves: cells}";
  double max_turn = kPi;  ///< in 3-D
  const char* afresh = "{moves: cells}";
};

/// Expects the repaired plan to be as good as astar's, or both to find none.
void expect_as_afresh(Flown& flown, const Planner& afresh, const std::string& what) {
  const PlanResult& repaired = flown.result();
  const PlanResult fresh = afresh.plan(flown.request());
  ASSERT_EQ(repaired.status, fresh.status)
      << what << ": " << repaired.message << "; afresh: " << fresh.message;
  if (fresh.status == PlanStatus::solved) {
    // Links off the centres are rounded to integers of small lengths.
    const double edge = flown.cells().spec().cell.minCoeff();
    ASSERT_NEAR(length(repaired.route), length(fresh.route), 2e-5 * edge) << what;
    ASSERT_TRUE(check(repaired.route, flown.request()).ok()) << what;
  } else if (fresh.status == PlanStatus::no_route) {
    ASSERT_TRUE(repaired.proved) << what;
  }
}

void run_sequence(const Setting& setting, std::uint64_t seed) {
  SplitMix64 random(seed);
  const GridSpec spec = spec_of(setting.counts, setting.cell);
  const double densities[] = {0.05, 0.2, 0.35, 0.45};
  VoxelGrid cells = random_cells(spec, densities[seed % 4], random);
  const Cell start = random_cell(spec, random);
  Cell goal = random_cell(spec, random);
  goal[2] = setting.level ? start[2] : goal[2];
  if (start == goal) {
    return;
  }
  cells.set(start, false);
  cells.set(goal, false);
  const bool turns = setting.max_turn < kPi;
  const auto afresh = make_planner("astar", turns ? setting.afresh : setting.with);
  Flown flown(setting.with, cells, start, goal, setting.level);
  flown.request().limits.max_turn_space = setting.max_turn;
  flown.begin();
  ASSERT_NO_FATAL_FAILURE(
      expect_as_afresh(flown, *afresh, "first plan of " + std::to_string(seed)));
  for (int round = 0; round < 8; ++round) {
    if (random.uniform() < 0.4) {
      flown.move_on(0.5 * random.uniform());
      const Route& route = flown.result().route;
      if (turns && route.size() >= 2) {  // it can no longer turn at once
        flown.request().start.velocity = (route[1] - route[0]).normalized();
      }
    }
    const int edits = random.uniform() < 0.2 ? 0 : random.integer(1, 20);
    for (int n = 0; n < edits; ++n) {
      const Cell c = random_cell(spec, random);
      const Cell here = spec.cell_of(flown.request().start.position);
      if (c != here && c != goal) {
        flown.flip(c);
      }
    }
    flown.update();
    ASSERT_NO_FATAL_FAILURE(expect_as_afresh(
        flown, *afresh, "seed " + std::to_string(seed) + ", round " + std::to_string(round)));
  }
}

void run_random_edits(std::uint64_t from, std::uint64_t to) {
  const Setting settings[] = {
      {},
      {.with = "{moves: cells, corner: free_box}"},
      {.with = "{moves: cells, neighbours: 6}"},
      {.cell = {30, 20, 7}},
      {.counts = {20, 18, 1}, .cell = {10, 10, 10}, .level = true},
      {.counts = {20, 18, 1},
       .cell = {10, 25, 4},
       .level = true,
       .with = "{moves: cells, corner: free_box}"},
      {.with = "{moves: exact}"},
  };
  for (std::uint64_t seed = from; seed < to; ++seed) {
    ASSERT_NO_FATAL_FAILURE(run_sequence(settings[seed % std::size(settings)], seed)) << seed;
  }
}

TEST(DStarLiteSession, EqualsPlanningAfreshAfterRandomEdits) { run_random_edits(0, 200); }
TEST(NightlyDStarLiteSession, EqualsPlanningAfreshAfterRandomEdits) { run_random_edits(200, 1000); }

/// Nearly all that is known relies on the cells before the goal.
TEST(DStarLiteSession, PlansAfreshWhereARepairTakesLongerAndGoesOnWithItLater) {
  const Cell counts = {60, 60, 30};
  VoxelGrid cells(spec_of(counts, {10, 10, 10}));
  for (int k = 0; k < counts[2] - 1; ++k) {  // a wall that leads over
    cells.block_run(30, 31, 0, k);
    for (int j = 1; j < counts[1]; ++j) {
      cells.block_run(30, 31, j, k);
    }
  }
  const Cell goal = {50, 30, 15};
  Flown flown("{moves: cells}", cells, {5, 30, 5}, goal);
  flown.begin();
  const auto astar = make_planner("astar", "{moves: cells}");
  const std::int64_t first = expanded(flown.result());
  const auto is_afresh = [&] {
    return flown.result().message.find("planned afresh by A*") != std::string::npos;
  };
  for (int j = 26; j <= 34; ++j) {
    for (int k = 11; k <= 19; ++k) {
      flown.flip({46, j, k});
    }
  }
  flown.update();
  ASSERT_TRUE(is_afresh()) << flown.result().message;
  ASSERT_NO_FATAL_FAILURE(expect_as_afresh(flown, *astar, "at once"));
  EXPECT_LE(expanded(flown.result()), expanded(astar->plan(flown.request())) + first / 32 + 64);
  int updates = 0;
  for (; is_afresh() && updates < 200; ++updates) {
    flown.update();
    ASSERT_NO_FATAL_FAILURE(expect_as_afresh(flown, *astar, "later"));
  }
  EXPECT_GT(updates, 1);
  EXPECT_LT(updates, 200);
  flown.update();
  EXPECT_EQ(expanded(flown.result()), 0);
}

void run_edits_under_limits_on_turns(std::uint64_t from, std::uint64_t to) {
  const char* by_heading = "{moves: cells, state: cell_and_heading}";
  const Setting settings[] = {
      {.counts = {9, 8, 5}, .max_turn = 0.9, .afresh = by_heading},
      {.counts = {9, 8, 5}, .with = by_heading, .max_turn = 0.7, .afresh = by_heading},
      {.counts = {14, 14, 1}, .level = true, .max_turn = 0.8, .afresh = by_heading},
      {.counts = {9, 8, 5},
       .cell = {30, 20, 12},
       .with = "{moves: exact}",
       .max_turn = 1.0,
       .afresh = "{moves: exact, state: cell_and_heading}"},
  };
  for (std::uint64_t seed = from; seed < to; ++seed) {
    ASSERT_NO_FATAL_FAILURE(run_sequence(settings[seed % std::size(settings)], seed)) << seed;
  }
}

TEST(DStarLiteSession, EqualsPlanningAfreshUnderLimitsOnTurns) {
  run_edits_under_limits_on_turns(0, 40);
}
TEST(NightlyDStarLiteSession, EqualsPlanningAfreshUnderLimitsOnTurns) {
  run_edits_under_limits_on_turns(40, 200);
}

TEST(DStarLiteSession, NoChangeExpandsNothing) {
  SplitMix64 random(1);
  const GridSpec spec = spec_of({30, 30, 20}, Vec3::Constant(5));
  for (const char* with : {"{moves: cells}", "{moves: exact}"}) {
    VoxelGrid cells = random_cells(spec, 0.2, random);
    cells.set({1, 1, 1}, false);
    cells.set({28, 27, 18}, false);
    Flown flown(with, cells, {1, 1, 1}, {28, 27, 18});
    flown.begin();
    const Route route = flown.result().route;
    ASSERT_GT(expanded(flown.result()), 20);
    EXPECT_EQ(expanded(flown.update()), 0);
    EXPECT_EQ(flown.result().route, route);
  }
}

TEST(DStarLiteSession, OneFarOffCellCostsLessThanAHundredthOfTheFirstPlan) {
  for (int seed = 0; seed < 5; ++seed) {
    const Request request = testing::city_request("complex", seed);
    GridSpec spec = *request.world->native_grid();
    spec.rule = GridSpec::Rule::native;
    Flown flown("{moves: cells}", *request.world->voxels(spec), {1, 2, 4}, {67, 64, 4});
    flown.begin();
    ASSERT_EQ(flown.result().status, PlanStatus::solved);
    const std::int64_t first = expanded(flown.result());
    flown.flip({75, 5, 90});
    EXPECT_LT(double(expanded(flown.update())), 0.01 * double(first)) << seed;
  }
}

TEST(DStarLiteSession, ABudgetThatEndsInARepairIsMadeUpForByTheNext) {
  SplitMix64 random(7);
  const auto afresh = make_planner("astar", "{moves: cells}");
  int cut_short = 0;
  for (int n = 0; n < 40; ++n) {
    const GridSpec spec = spec_of({16, 14, 8}, Vec3::Constant(10));
    VoxelGrid cells = random_cells(spec, 0.3, random);
    cells.set({0, 0, 0}, false);
    cells.set({15, 13, 7}, false);
    Flown flown("{moves: cells}", cells, {0, 0, 0}, {15, 13, 7});
    flown.request().budget.max_iterations = std::uint64_t(random.integer(0, 100));
    flown.begin();
    for (int round = 0; round < 6; ++round) {
      for (int edit = 0; edit < 30; ++edit) {
        const Cell c = random_cell(spec, random);
        if (c != Cell{0, 0, 0} && c != Cell{15, 13, 7}) {
          flown.flip(c);
        }
      }
      const std::uint64_t maximum = std::uint64_t(random.integer(0, 60));
      flown.request().budget.max_iterations = maximum;
      const PlanResult& cut = flown.update();
      ASSERT_LE(std::uint64_t(expanded(cut)), maximum);
      cut_short += cut.status == PlanStatus::timed_out && cut.budget_hit;
    }
    flown.request().budget = {};
    flown.update();
    ASSERT_NO_FATAL_FAILURE(expect_as_afresh(flown, *afresh, std::to_string(n)));
  }
  EXPECT_GT(cut_short, 20);
}

TEST(DStarLiteSession, GoesOnForAsLongAsOneLikes) {
  // Many moves, after which keys have to restart low; many edits, with little memory for lists.
  SplitMix64 random(11);
  const GridSpec spec = spec_of({12, 10, 6}, Vec3::Constant(10));
  const auto afresh = make_planner("astar", "{moves: cells}");
  Flown flown("{moves: cells, max_memory_mb: 1}", random_cells(spec, 0, random), {0, 0, 0},
              {6, 9, 5});
  flown.begin();
  for (int n = 0; n < 6000; ++n) {
    const Cell at = n % 2 == 0 ? Cell{11, 0, 0} : Cell{0, 0, 0};
    flown.request().start.position = spec.centre(at);
    for (int edit = 0; edit < (n % 10 == 0 ? 20 : 0); ++edit) {
      const Cell c = random_cell(spec, random);
      if (c[0] != 0 && c[0] != 11 && c != Cell{6, 9, 5}) {
        flown.flip(c);
      }
    }
    flown.update();
    if (n % 100 == 0) {
      ASSERT_NO_FATAL_FAILURE(expect_as_afresh(flown, *afresh, std::to_string(n)));
    }
  }
}

TEST(DStarLiteSession, AWayThatCloses) {
  // A wall with one gap, which is closed and opened again.
  const GridSpec spec = spec_of({15, 9, 5}, Vec3::Constant(10));
  VoxelGrid cells(spec);
  for (int k = 0; k < 5; ++k) {
    for (int j = 0; j < 9; ++j) {
      cells.set({7, j, k}, !(j == 6 && k == 3));
    }
  }
  Flown flown("{moves: cells}", cells, {1, 1, 1}, {13, 1, 1});
  flown.begin();
  const double way = length(flown.result().route);
  for (int n = 0; n < 3; ++n) {
    flown.flip({7, 6, 3});
    flown.update();
    EXPECT_EQ(flown.result().status, PlanStatus::no_route);
    EXPECT_TRUE(flown.result().proved);
    flown.flip({7, 6, 3});
    flown.update();
    ASSERT_EQ(flown.result().status, PlanStatus::solved) << flown.result().message;
    EXPECT_NEAR(length(flown.result().route), way, 1e-6);
  }
}

TEST(DStarLiteSession, FromAnotherPlaceALegMayLeadToTheGoalItself) {
  testing::Drawn drawn = testing::draw({"S#..G"});
  Request& request = drawn.request;
  request.level_m = 0.5;
  request.goal.position += Vec3(0.3, 0, 0);
  request.goal.tolerance_m = 0.2;  // contains no cell's centre
  const auto planner = testing::make_planner("dstar_lite");
  const auto session = planner->begin(request);
  EXPECT_EQ(session->result().status, PlanStatus::no_route);
  EXPECT_TRUE(session->result().proved);
  request.start.position = {2.5, 0.5, 0.5};
  const PlanResult& result =
      session->update(request.start, request.goal, request.world, {}, request.budget);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_EQ(result.route.back(), request.goal.position);
}

TEST(DStarLiteSession, AnotherGoalOrLatticeIsPlannedAfresh) {
  const GridSpec spec = spec_of({15, 9, 5}, Vec3::Constant(10));
  Flown flown("{moves: cells}", VoxelGrid(spec), {1, 1, 1}, {13, 1, 1});
  flown.begin();
  flown.request().goal.position = spec.centre({13, 7, 4});
  EXPECT_EQ(flown.update().status, PlanStatus::solved);
  EXPECT_EQ(flown.result().route.back(), spec.centre({13, 7, 4}));
  const Request before = flown.request();
  const auto planner = make_planner("dstar_lite", "{moves: cells, cell_m: [10, 10, 10]}");
  const auto session = planner->begin(before);
  const auto empty = std::make_shared<const World>(before.world->without("cells"));
  const Change gone{Change::Kind::remove, "cells", spec.box()};
  const PlanResult result = session->update(before.start, before.goal, empty, {&gone, 1}, {});
  EXPECT_EQ(result.status, PlanStatus::solved) << result.message;
}
}  // namespace
}  // namespace altiplan::dstar_session_test
