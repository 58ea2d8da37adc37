// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/sampling/leg_rules.hpp"

#include <gtest/gtest.h>

#include "altiplan/kit/layers/cell_layer.hpp"
#include "support/support.hpp"

namespace altiplan::kit::leg_rules_test {
namespace {

Request among_cells(RandomStream& random, double cell, int layers) {
  World world;
  for (int layer = 0; layer < layers; ++layer) {
    GridSpec spec;
    spec.origin = {-7.3, 4, 12};
    spec.cell = Vec3::Constant(cell);
    spec.counts = {14, 11, 9};
    spec.rule = GridSpec::Rule::native;
    VoxelGrid grid(spec);
    for (int n = 0; n < 300; ++n) {
      const int i = int(random.integer(0, 13));
      const int j = int(random.integer(0, 10));
      grid.block_run(i, i, j, int(random.integer(0, 8)));
    }
    const auto id = "cells" + std::to_string(layer);
    world = world.with({id, id, std::make_shared<CellLayer>(std::move(grid)), true});
  }
  Request request = testing::request_in(world, {0, 0, 0}, {0, 0, 0}, world.bounds().grown(cell));
  return request;
}

/// Anywhere, or on faces, edges and corners of cells.
Vec3 place(RandomStream& random, const Request& request, double cell) {
  Vec3 p = random.in(request.volume);
  for (int axis = 0; axis < 3; ++axis) {
    if (random.integer(0, 2) == 0) {
      const double origin = request.volume.min[axis];
      p[axis] = origin + std::round((p[axis] - origin) / cell) * cell;
    }
  }
  return p;
}

TEST(LegRules, SayOfCellsWhatTheJudgeSays) {
  RandomStream random(3);
  int free = 0;
  for (int n = 0; n < 40; ++n) {
    const double cell = n % 2 == 0 ? 1 : 12.5;
    Request request = among_cells(random, cell, 1 + n % 3);
    request.limits.min_clearance = request.vehicle.radius_m = n % 5 == 0 ? 0.2 : 0.0;
    if (n % 4 == 1) {
      request.limits.max_climb = radians(40);
      request.limits.max_turn_horizontal = radians(80);
      request.limits.max_leg = 6 * cell;
    }
    LegRules rules(request);
    Vec3 before = place(random, request, cell);
    Vec3 a = place(random, request, cell);
    for (int m = 0; m < 1000; ++m) {
      const Vec3 b = m % 2 == 0 ? place(random, request, cell)
                                : Vec3(a + (place(random, request, cell) - a) * 0.3);
      const bool ok = leg_ok(before, a, b, request);
      ASSERT_EQ(rules.ok(before, a, b), ok) << n << ' ' << m;
      if (ok) {
        ASSERT_TRUE(rules.follows(before, a, b) && rules.point_ok(a) && rules.point_ok(b));
        ++free;
      }
      before = a;
      a = b;
    }
    EXPECT_EQ(rules.checked(), 1000);
    EXPECT_NE(rules.refusals().find(" ("), std::string::npos);
  }
  EXPECT_GT(free, 2000);
}

class OnlyNorth final : public Constraint {
  bool do_admits(const Motion& leg) const override {
    return !leg.before || leg.to.y() >= leg.before->y();
  }
};

TEST(LegRules, AskWhatLooksAtTheLegBefore) {
  Request request =
      testing::request_in(World(), {0, 0, 0}, {9, 9, 0}, {{-20, -20, -20}, {20, 20, 20}});
  request.limits.max_turn_space = radians(50);
  LegRules rules(request);
  EXPECT_TRUE(rules.follows(Vec3{-1, 0, 0}, {0, 0, 0}, {1, 1, 0}));
  EXPECT_FALSE(rules.follows(Vec3{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}));
  EXPECT_EQ(rules.refusals(), "turn_angle (1)");
  request.limits.max_turn_space = kPi;
  request.constraints.push_back({"north", std::make_shared<OnlyNorth>()});
  LegRules north(request);
  EXPECT_TRUE(north.follows(Vec3{-1, 0, 0}, {0, 0, 0}, {1, 1, 0}));
  EXPECT_FALSE(north.follows(Vec3{-1, 0, 0}, {0, 0, 0}, {1, -1, 0}));
  EXPECT_FALSE(north.ok(Vec3(-1, 0, 0), {0, 0, 0}, {1, -1, 0}));
  EXPECT_EQ(north.refusals(), "north (2)");
}
}  // namespace
}  // namespace altiplan::kit::leg_rules_test
