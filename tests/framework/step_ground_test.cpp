// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/step_ground.hpp"

#include <gtest/gtest.h>

#include "altiplan/check.hpp"
#include "altiplan/kit/lattice/move_rules.hpp"
#include "support/folders.hpp"
#include "support/support.hpp"

namespace altiplan::kit {
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
  std::vector<MoveRules::KnownClearance> known(lattice.size());
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
    const bool is_free = rules.place_free(c, d, lattice.position(c), lattice.position(to),
                                          known[lattice.index(c)], known[lattice.index(to)]);
    ASSERT_EQ(is_free, leg_ok(std::nullopt, lattice.position(c), lattice.position(to), request))
        << over.layer << ' ' << seed << ' ' << n << ": " << rules.refusals();
    (is_free ? kept : refused) += 1;
  }
  EXPECT_GT(kept, 300);
  EXPECT_GT(refused, 300);
}

TEST(StepGround, StepsOverHillsAreJudgedAsTheJudgeJudgesThem) {
  for (int seed = 0; seed < 12; ++seed) {
    const std::string draw = "{count: 16, extent_m: 20000, seed: " + std::to_string(seed) + "}";
    expect_the_judges_answers({"hills", draw, 20e3, 5e3, {500, 500, 100}}, seed);
  }
}

TEST(StepGround, StepsOverAnElevationModelAreJudgedAsTheJudgeJudgesThem) {
  const std::string file =
      "{file: " + altiplan::folders::source().string() + "/configs/data/jacksboro_fault.tif}";
  for (int seed = 0; seed < 6; ++seed) {
    expect_the_judges_answers({"terrain", file, 29.6e3, 1200, {300, 300, 20}}, seed);
  }
}

TEST(StepGround, BoundsHoldWhatLegsHaveShown) {
  StepGround::Top top;
  StepGround::learn(top, 1000, 1200, 300, false);
  EXPECT_NEAR(top.most, 900, 1e-3);
  StepGround::learn(top, 700, 700, 20, true);
  EXPECT_NEAR(top.most, 680, 1e-3);
  EXPECT_NEAR(top.least, 680, 1e-3);
  EXPECT_GE(top.most, 680);
  EXPECT_LE(top.least, 680);
  StepGround::learn(top, 700, 700, -kInfinity, true);
  EXPECT_EQ(top.least, StepGround::kNone);
}
}  // namespace
}  // namespace altiplan::kit
