// SPDX-License-Identifier: Apache-2.0
// Layers of cells against a plain reference: every cell by itself, and sampling.
#include "altiplan/kit/layers/cell_layer.hpp"

#include <gtest/gtest.h>

#include "altiplan/error.hpp"
#include "altiplan/random.hpp"

namespace altiplan::kit::cell_layer_test {
namespace {

VoxelGrid random_cells(RandomStream& random, double density) {
  GridSpec spec;
  spec.origin = {-4, 10, 1};
  spec.cell = {2, 3, 1.5};
  spec.counts = {7, 6, 5};
  spec.rule = GridSpec::Rule::native;
  VoxelGrid cells(spec);
  for (int k = 0; k < spec.counts[2]; ++k) {
    for (int j = 0; j < spec.counts[1]; ++j) {
      for (int i = 0; i < spec.counts[0]; ++i) {
        cells.set({i, j, k}, random.uniform(0, 1) < density);
      }
    }
  }
  return cells;
}

/// Distance to the nearest blocked cell, or minus that to the nearest free place.
double reference_clearance(const VoxelGrid& cells, const Vec3& p) {
  const GridSpec& spec = cells.spec();
  double to_blocked = kInfinity;
  double to_free = kInfinity;
  for (int k = -1; k <= spec.counts[2]; ++k) {
    for (int j = -1; j <= spec.counts[1]; ++j) {
      for (int i = -1; i <= spec.counts[0]; ++i) {
        const Box box = spec.cell_box({i, j, k});
        const double off = (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).norm();
        const bool blocked = spec.holds({i, j, k}) && cells.blocked(i, j, k);
        (blocked ? to_blocked : to_free) = std::min(blocked ? to_blocked : to_free, off);
      }
    }
  }
  return to_blocked > 0 ? to_blocked : -to_free;
}

Vec3 place(RandomStream& random, const GridSpec& spec) {
  const Box around = spec.box();
  Vec3 p;
  for (int axis = 0; axis < 3; ++axis) {
    const double edge = spec.cell[axis];
    p[axis] = random.uniform(around.min[axis] - edge / 2, around.max[axis] + edge / 2);
    if (random.uniform(0, 1) < 0.3) {  // on a face
      p[axis] = spec.origin[axis] + edge * std::round((p[axis] - spec.origin[axis]) / edge);
    }
    p[axis] = std::clamp(p[axis], around.min[axis] - edge / 2, around.max[axis] + edge / 2);
  }
  return p;
}

TEST(CellLayer, ClearanceIsThatOfTheUnion) {
  RandomStream random(1);
  for (const double density : {0.05, 0.1, 0.5, 0.9, 1.0}) {
    const CellLayer layer(random_cells(random, density));
    for (int n = 0; n < 500; ++n) {
      const Vec3 p = place(random, layer.cells().spec());
      EXPECT_NEAR(layer.clearance(p), reference_clearance(layer.cells(), p), 1e-9) << p.transpose();
    }
  }
}

TEST(CellLayer, LegsAreBlockedWhereTheUnionIsEntered) {
  RandomStream random(2);
  int blocked_legs = 0;
  for (const double density : {0.1, 0.5, 0.9}) {
    const CellLayer layer(random_cells(random, density));
    for (int n = 0; n < 250; ++n) {
      const Vec3 a = place(random, layer.cells().spec());
      Vec3 b = place(random, layer.cells().spec());
      if (n % 3 == 0) {  // along an axis, often in a face
        const int axis = n / 3 % 3;
        const double to = b[axis];
        b = a;
        b[axis] = to;
      }
      const double r = n % 2 == 0 ? 0 : random.uniform(0, 2);
      double least = kInfinity;
      for (int i = 0; i <= 100; ++i) {
        least = std::min(least, reference_clearance(layer.cells(), a + (b - a) * (i / 100.0)));
      }
      const bool blocked = layer.blocked(a, b, r);
      blocked_legs += blocked;
      EXPECT_EQ(blocked, layer.blocked(b, a, r));
      if (least < r - 1e-5) {
        EXPECT_TRUE(blocked) << a.transpose() << " to " << b.transpose() << " at " << r;
      }
      // Between samples the leg comes nearer by half their distance at most.
      if (least > r + (b - a).norm() / 200) {
        EXPECT_FALSE(blocked) << a.transpose() << " to " << b.transpose() << " at " << r;
      }
    }
  }
  EXPECT_GT(blocked_legs, 400);
}

TEST(CellLayer, ALegInTheFaceBetweenTwoBlockedCellsIsInsideOfThem) {
  GridSpec spec;
  spec.counts = {4, 2, 1};
  spec.rule = GridSpec::Rule::native;
  VoxelGrid cells(spec);
  cells.set({1, 0, 0}, true);
  cells.set({2, 1, 0}, true);
  EXPECT_FALSE(CellLayer(cells).blocked({0, 1, 0.5}, {4, 1, 0.5}, 0));  // touches two corners
  cells.set({1, 1, 0}, true);
  EXPECT_TRUE(CellLayer(cells).blocked({0, 1, 0.5}, {4, 1, 0.5}, 0));
  EXPECT_FALSE(CellLayer(cells).blocked({0, 1, 1}, {4, 1, 1}, 0));  // along the roof
}

TEST(CellLayer, ItsOwnGridComesBackAsItIs) {
  RandomStream random(3);
  const CellLayer layer(random_cells(random, 0.4));
  VoxelGrid grid(layer.cells().spec());
  layer.rasterize(grid);
  EXPECT_TRUE(VoxelGrid::diff(grid, layer.cells()).empty());
  EXPECT_EQ(layer.cell_centre({0, 0, 0}), Vec3(-3, 11.5, 1.75));
  const CellLayer empty(random_cells(random, 0));
  EXPECT_EQ(empty.clearance({0, 0, 0}), kInfinity);
  EXPECT_FALSE(empty.blocked({-9, 0, 0}, {9, 20, 5}, 3));
  EXPECT_THROW(CellLayer{VoxelGrid(GridSpec{})}, Error);
}
}  // namespace
}  // namespace altiplan::kit::cell_layer_test
