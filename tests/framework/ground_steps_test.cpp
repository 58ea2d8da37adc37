// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/ground_steps.hpp"

#include <gtest/gtest.h>

#include "altiplan/check.hpp"
#include "altiplan/kit/lattice/move_rules.hpp"
#include "altiplan/kit/layers/obstacle_set.hpp"
#include "support/folders.hpp"
#include "support/support.hpp"

namespace altiplan::kit::ground_steps_test {
namespace {

struct Case {
  std::string layer;  ///< its plugin
  std::string parameters;
  double side_m = 0;
  double top_m = 0;
  Vec3 cell_m;
};

/// Steps at random over that ground, beside a zone, under limits that the seed chooses.
void expect_the_judges_answers(const Case& over, int seed) {
  const Box volume = {{0, 0, 0}, {over.side_m, over.side_m, over.top_m}};
  const World nothing;
  Site site;
  site.volume = volume;
  site.before = &nothing;
  const double side = over.side_m;
  World world = testing::world_of({Shape{Cylinder{0.45 * side, 0.4 * side, 0.1 * side, 0, 1e4}}});
  world = world.with(
      {"ground", over.layer, testing::make_environment(over.layer, over.parameters, site)});
  const double high = 0.88 * over.top_m;
  Request request = testing::request_in(std::move(world), {1e3, 1e3, high},
                                        {side - 1e3, side - 1e3, high}, volume);
  if (seed % 2 == 0) {
    request.limits.min_ground_clearance = 50;
  }
  if (seed % 3 == 0) {
    request.vehicle.radius_m = request.limits.min_clearance = 120;
  }
  if (seed % 5 == 0) {
    request.limits.altitude = {{AltitudeBand::Datum::ground, 20, 1500}};
  }
  const Lattice lattice(request, over.cell_m, Neighbourhood::all, {});
  MoveRules rules(request, lattice, MoveCheck::exact, CornerRule::any);
  SplitMix64 random{std::uint64_t(seed)};
  int kept = 0;
  int refused = 0;
  for (int n = 0; n < 4000; ++n) {
    Cell c{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      c[axis] = int(random.integer(0, lattice.spec().counts[axis] - 1));
    }
    const DirectionMask open = rules.out_of(c);
    const int d = int(random.integer(0, kDirections - 1));
    if ((open >> d & 1) == 0) {
      continue;
    }
    const Cell o = offset(d);
    const Cell to = {c[0] + o[0], c[1] + o[1], c[2] + o[2]};
    const bool is_free = rules.place_free(c, d);
    ASSERT_EQ(is_free, leg_ok(std::nullopt, lattice.position(c), lattice.position(to), request))
        << over.layer << ' ' << seed << ' ' << n << ": " << rules.refusals();
    (is_free ? kept : refused) += 1;
  }
  EXPECT_GT(kept, 300);
  EXPECT_GT(refused, 300);
}

TEST(GroundSteps, StepsOverHillsAreJudgedAsTheJudgeJudgesThem) {
  for (int seed = 0; seed < 12; ++seed) {
    const std::string draw = "{count: 16, extent_m: 20000, seed: " + std::to_string(seed) + "}";
    expect_the_judges_answers({"hills", draw, 20e3, 5e3, {500, 500, 100}}, seed);
  }
}

TEST(GroundSteps, StepsOverAnElevationModelAreJudgedAsTheJudgeJudgesThem) {
  const std::string file =
      "{file: " + altiplan::folders::source().string() + "/configs/data/jacksboro_fault.tif}";
  for (int seed = 0; seed < 6; ++seed) {
    expect_the_judges_answers({"terrain", file, 29.6e3, 1200, {300, 300, 20}}, seed);
  }
}

TEST(GroundSteps, WhatIsPermittedAllAroundIsPermittedStepByStep) {
  const std::string file =
      "{file: " + altiplan::folders::source().string() + "/configs/data/jacksboro_fault.tif}";
  const Box volume = {{0, 0, 0}, {29.6e3, 29.6e3, 1200}};
  const World nothing;
  Site site;
  site.volume = volume;
  site.before = &nothing;
  World world =
      World().with({"ground", "terrain", testing::make_environment("terrain", file, site)});
  world = world.with({"tower", "shape",
                      std::make_shared<kit::ShapeLayer>(
                          std::vector<Shape>{Shape{Cylinder{12e3, 12e3, 800, 0, 1e4}}})});
  Request request =
      testing::request_in(std::move(world), {1e3, 1e3, 1100}, {20e3, 20e3, 1100}, volume);
  request.limits.min_ground_clearance = 50;
  request.vehicle.radius_m = request.limits.min_clearance = 10;
  const Lattice lattice(request, {200, 200, 20}, Neighbourhood::all, {});
  MoveRules rules(request, lattice, MoveCheck::exact, CornerRule::any);
  SplitMix64 random{7};
  int around = 0;
  for (int n = 0; n < 3000; ++n) {
    Cell c{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      c[axis] = int(random.integer(0, lattice.spec().counts[axis] - 1));
    }
    if (!rules.all_free_around(c)) {
      continue;
    }
    ++around;
    for (int at = 0; at < kDirections; ++at) {
      const Cell o = offset(at);  // kHere included
      if ((lattice.inside(c) >> at & 1) == 0) {
        continue;
      }
      const Cell from = {c[0] + o[0], c[1] + o[1], c[2] + o[2]};
      const DirectionMask within = directions_where([&](const Cell& step) {
        return std::abs(o[0] + step[0]) <= 1 && std::abs(o[1] + step[1]) <= 1 &&
               std::abs(o[2] + step[2]) <= 1;
      });
      const DirectionMask inside = rules.out_of(from) & within;
      ASSERT_EQ(rules.places_free(from, inside), inside) << n;
    }
  }
  EXPECT_GT(around, 500);
  EXPECT_LT(around, 2500);
}
}  // namespace
}  // namespace altiplan::kit::ground_steps_test
