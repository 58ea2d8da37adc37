// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/lattice.hpp"

#include <gtest/gtest.h>

#include <queue>

#include "altiplan/error.hpp"
#include "altiplan/kit/lattice/move_rules.hpp"
#include "support/support.hpp"

namespace altiplan::kit::lattice_test {
namespace {

Request empty_request() {
  return testing::request_in(World(), {25e3, 70e3, 2e3}, {55e3, 10e3, 2800},
                             {{0, 0, 0}, {100e3, 100e3, 5e3}});
}

TEST(Lattice, StartIsACentreAndCentresLieInVolumeAndBand) {
  Request request = empty_request();
  request.limits.altitude = {{AltitudeBand::Datum::sea, 1e3, 4e3}};
  const Lattice lattice(request, {1000, 1000, 200}, Neighbourhood::all, {});
  EXPECT_EQ(lattice.spec().counts, (Cell{101, 101, 16}));
  EXPECT_EQ(lattice.position({25, 70, 5}), request.start.position);
  EXPECT_EQ(lattice.position({0, 0, 0}), Vec3(0, 0, 1000));
  EXPECT_EQ(lattice.position({100, 100, 15}), Vec3(100e3, 100e3, 4000));
  for (const std::uint32_t index : {0U, 100U, 101U, 101U * 101U, 163215U}) {
    EXPECT_EQ(lattice.index(lattice.cell(index)), index);
  }
}

TEST(Lattice, LevelFlightHasOneLayerAtItsLevel) {
  Request request = empty_request();
  request.level_m = request.start.position.z() = request.goal.position.z() = 1234;
  const Lattice lattice(request, {1000, 500, 200}, Neighbourhood::all, {});
  EXPECT_EQ(lattice.spec().counts, (Cell{101, 201, 1}));
  EXPECT_EQ(lattice.position({3, 4, 0}).z(), 1234);
  EXPECT_EQ(__builtin_popcount(lattice.steps()), 8);
  const Lattice cross(request, {1000, 500, 200}, Neighbourhood::faces, {});
  EXPECT_EQ(__builtin_popcount(cross.steps()), 4);
}

TEST(Lattice, NativeCellsSetCellAndOrigin) {
  const testing::Drawn drawn = testing::draw({"S..\n.#G", "...\n..."}, 7);
  const Lattice lattice(drawn.request, {100, 100, 100}, Neighbourhood::all, {});
  EXPECT_EQ(lattice.spec().cell, Vec3(7, 7, 7));
  EXPECT_EQ(lattice.spec().counts, (Cell{3, 2, 2}));
  EXPECT_EQ(lattice.spec().origin, drawn.world->native_grid()->origin);
}

TEST(Lattice, TooManyCellsAreRefusedWithBothFigures) {
  for (const auto& [bytes, said] :
       {std::pair(1 << 20, "allowed are 1 MB"), std::pair(1 << 19, "allowed are less than 1 MB")}) {
    try {
      const Lattice lattice(empty_request(), {1, 1, 1}, Neighbourhood::all,
                            {std::size_t(bytes), 16});
      FAIL();
    } catch (const ParameterError& error) {
      EXPECT_EQ(error.key(), "cell_m");
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
  }
}

TEST(Lattice, TooManyCellsForAnyMemoryAreRefusedByCount) {
  try {
    const Lattice lattice(empty_request(), {0.001, 0.001, 0.001}, Neighbourhood::all, {});
    FAIL();
  } catch (const ParameterError& error) {
    EXPECT_NE(std::string(error.what()).find(" MB; allowed are 4e9 cells: "), std::string::npos)
        << error.what();
  }
}

TEST(Lattice, TooManyCellsAlongAnAxisAreRefused) {
  const Request request =
      testing::request_in(World(), {0, 0, 0}, {1, 0, 0}, {{0, 0, 0}, {3e9, 0.5, 0.5}});
  try {
    const Lattice lattice(request, {1, 1, 1}, Neighbourhood::all, {});
    FAIL() << lattice.size() << " cells";
  } catch (const ParameterError& error) {
    EXPECT_STREQ(error.what(),
                 "the lattice would have 3000000001 x 1 x 1 cells; allowed are 1e9 along an axis: "
                 "choose larger cells or a smaller volume");
  }
}

TEST(Lattice, DistanceIsTheShortestWayOnAnEmptyLattice) {
  Request request = testing::request_in(World(), {0, 0, 0}, {1, 1, 1}, {{0, 0, 0}, {50, 50, 50}});
  for (const Vec3& cell : {Vec3(5, 5, 5), Vec3(7, 3, 5), Vec3(10, 9, 1)}) {
    for (const Neighbourhood neighbourhood : {Neighbourhood::faces, Neighbourhood::all}) {
      const Lattice lattice(request, cell, neighbourhood, {});
      const Cell from = {1, 2, 3};
      std::vector<double> best(lattice.size(), kInfinity);
      std::priority_queue<std::pair<double, std::uint32_t>,
                          std::vector<std::pair<double, std::uint32_t>>, std::greater<>>
          queue;
      queue.push({0, lattice.index(from)});
      best[lattice.index(from)] = 0;
      while (!queue.empty()) {
        const auto [g, index] = queue.top();
        queue.pop();
        const DirectionMask open = lattice.steps() & lattice.inside(lattice.cell(index));
        for (int d = 0; d < kDirections; ++d) {
          const auto next = std::uint32_t(std::int64_t(index) + lattice.stride(d));
          if ((open >> d & 1) != 0 && g + lattice.step_length(d) < best[next]) {
            best[next] = g + lattice.step_length(d);
            queue.push({best[next], next});
          }
        }
      }
      for (std::uint32_t index = 0; index < lattice.size(); ++index) {
        ASSERT_NEAR(lattice.distance(from, lattice.cell(index)), best[index], 1e-9);
      }
    }
  }
}

TEST(Lattice, LinksAreTheCellsAtMostOneEdgeAway) {
  const Lattice lattice(
      testing::request_in(World(), {0, 0, 0}, {1, 1, 1}, {{0, 0, 0}, {50, 50, 50}}), {10, 10, 5},
      Neighbourhood::all, {});
  EXPECT_EQ(lattice.links({20, 30, 15}).size(), 1u);
  EXPECT_EQ(lattice.links({20, 30, 15}).front().length, 0);
  EXPECT_EQ(lattice.links({21, 33, 16}).size(), 8u);
  EXPECT_EQ(lattice.links({20, 30, 16}).size(), 18u);  // above, below, and around both
  EXPECT_EQ(lattice.links({50, 50, 49}).size(), 8u);   // at the edge
}

TEST(Lattice, NearestIsTheCellOfTheNearestCentre) {
  for (const bool level : {false, true}) {
    Request request = testing::request_in(World(), {1, 2, 3}, {1, 1, 3}, {{0, 0, 0}, {50, 33, 21}});
    if (level) {
      request.level_m = 3;
    }
    const Lattice lattice(request, {10, 7, 5}, Neighbourhood::all, {});
    RandomStream random(8);
    for (int n = 0; n < 3000; ++n) {
      Vec3 p = random.in({{-30, -30, -30}, {90, 90, 60}});
      p.z() = level ? 3 : p.z();
      double least = kInfinity;
      for (std::uint32_t index = 0; index < lattice.size(); ++index) {
        least = std::min(least, (lattice.position(lattice.cell(index)) - p).norm());
      }
      const Lattice::Link nearest = lattice.nearest(p);
      ASSERT_TRUE(lattice.spec().holds(nearest.cell));
      ASSERT_NEAR((lattice.position(nearest.cell) - p).norm(), least, 1e-12);
      ASSERT_EQ(nearest.length, (lattice.position(nearest.cell) - p).norm());
    }
    for (std::uint32_t index = 0; index < lattice.size(); ++index) {
      const Cell c = lattice.cell(index);
      const Lattice::Link own = lattice.nearest(lattice.position(c) + Vec3(4e-7, -4e-7, 4e-7));
      ASSERT_EQ(own.cell, c);
      ASSERT_EQ(own.length, 0);
      ASSERT_GT(lattice.nearest(lattice.position(c) + Vec3(6e-7, 0, 0)).length, 0);
    }
    EXPECT_EQ(lattice.nearest({1e300, -1e300, 3}).cell[0], lattice.spec().counts[0] - 1);
    EXPECT_EQ(lattice.nearest({1e300, -1e300, 3}).cell[1], 0);
  }
}

TEST(Lattice, ACentreJustBeyondTheVolumeIsNoCell) {
  for (const double edge : {10.0, 4000.0}) {
    for (const double beyond : {3e-7, 9e-7, 3e-6}) {
      const Vec3 last(5 * edge - beyond, 50, 50);
      const Request request =
          testing::request_in(World(), {0, 0, 0}, last, {{0, 0, 0}, {last.x(), 100, 100}});
      const Lattice lattice(request, {edge, 50, 50}, Neighbourhood::all, {});
      // The judge lets a centre pass that is less than a micrometre outside.
      const int inside = edge == 4000 && beyond == 3e-7 ? 6 : 5;
      ASSERT_EQ(lattice.spec().counts[0], inside) << edge << " " << beyond;
      ASSERT_TRUE(request.volume.contains(lattice.position({inside - 1, 0, 0}), kLengthTolerance));
      EXPECT_EQ(lattice.nearest(last).cell, (Cell{inside - 1, 1, 1}));
      EXPECT_EQ(lattice.nearest(last).length == 0, inside == 6);
      // The goal joins the lattice all the same, by the cells one edge away.
      EXPECT_EQ(lattice.links(last).size(), inside == 6 ? 1u : 9u);
    }
  }
}

TEST(Lattice, BlockedAroundAndFreeStepsEqualTheirDefinition) {
  SplitMix64 random(7);
  GridSpec spec;
  spec.counts = {150, 5, 4};
  VoxelGrid grid(spec);
  for (int k = 0; k < 4; ++k) {
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 150; ++i) {
        grid.set({i, j, k}, random.uniform() < 0.15);
      }
    }
  }
  for (int k = 0; k < 4; ++k) {
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 150; ++i) {
        const DirectionMask blocked = blocked_around(grid, {i, j, k});
        const DirectionMask any = free_steps(blocked, CornerRule::any);
        const DirectionMask box = free_steps(blocked, CornerRule::free_box);
        for (int d = 0; d < kDirections; ++d) {
          const Cell o = offset(d);
          ASSERT_EQ(blocked >> d & 1, unsigned(grid.blocked(i + o[0], j + o[1], k + o[2])));
          bool clear = true;
          for (int corner = 0; corner < 8; ++corner) {
            clear = clear && !grid.blocked(i + (corner & 1 ? o[0] : 0), j + (corner & 2 ? o[1] : 0),
                                           k + (corner & 4 ? o[2] : 0));
          }
          const bool ends = !grid.blocked(i, j, k) && !grid.blocked(i + o[0], j + o[1], k + o[2]);
          ASSERT_EQ(any >> d & 1, unsigned(ends && d != kHere));
          ASSERT_EQ(box >> d & 1, unsigned(clear && d != kHere));
        }
      }
    }
  }
}

TEST(MoveRules, AgreeWithTheJudgeOnEveryPairOfSteps) {
  Request request = empty_request();
  request.limits.max_climb = radians(15);
  request.limits.max_turn_horizontal = radians(55);
  request.limits.max_turn_space = radians(50);
  request.limits.min_turn_radius = 900;
  request.limits.max_leg = 1420;
  const Lattice lattice(request, {1000, 1000, 200}, Neighbourhood::all, {});
  MoveRules rules(request, lattice, MoveCheck::exact, CornerRule::any);
  const Cell c = {40, 40, 10};
  const Vec3 here = lattice.position(c);
  int kept = 0;
  for (int in = 0; in < kDirections; ++in) {
    const auto before = in == kHere ? std::nullopt : std::optional<Vec3>(here - lattice.step(in));
    const DirectionMask open = rules.candidates(c, in);
    for (int d = 0; d < kDirections; ++d) {
      const bool expected = d != kHere && leg_ok(before, here, here + lattice.step(d), request);
      ASSERT_EQ((open >> d & 1) != 0, expected) << in << " " << d;
      kept += expected;
    }
  }
  EXPECT_GT(kept, 20);
}

TEST(Lattice, CellUndoesIndex) {
  for (const Cell& counts : {Cell{1, 1, 1}, {1, 7, 3}, {64, 1, 5}, {3, 5, 1}, {1000, 999, 998}}) {
    const Vec3 size(counts[0], counts[1], counts[2]);
    const Lattice lattice(
        testing::request_in(World(), {0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, {{0, 0, 0}, size}),
        {1, 1, 1}, Neighbourhood::all, {});
    SplitMix64 random(2);
    for (int n = 0; n < 2000; ++n) {
      Cell c{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        c[axis] = int(random.integer(0, counts[axis] - 1));
      }
      ASSERT_EQ(lattice.cell(lattice.index(c)), c);
    }
    const Cell last = {counts[0] - 1, counts[1] - 1, counts[2] - 1};
    EXPECT_EQ(lattice.cell(std::uint32_t(lattice.size() - 1)), last);
  }
}
}  // namespace
}  // namespace altiplan::kit::lattice_test
