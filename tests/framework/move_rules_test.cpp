// SPDX-License-Identifier: Apache-2.0
#include "altiplan/kit/lattice/move_rules.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "altiplan/check.hpp"
#include "altiplan/kit/lattice/line_of_sight.hpp"
#include "reference/random_problem.hpp"

namespace altiplan::kit::move_rules_test {
namespace {

/// How often a test saw each kind of answer: one that saw a kind never has shown nothing.
struct Seen {
  int kept = 0;
  int refused = 0;  ///< by the judge, over free cells
  int blocked = 0;
};

/// Holds `sees` to its definition on random pairs of cells, half of them near each other.
void compare(const Request& request, const Lattice& lattice, MoveCheck check, int pairs,
             oracle::Draw& draw, Seen& seen) {
  MoveRules rules(request, lattice, check, CornerRule::free_box);
  const Cell& counts = lattice.spec().counts;
  const auto cell = [&] {
    return Cell{draw.below(counts[0]), draw.below(counts[1]), draw.below(counts[2])};
  };
  for (int n = 0; n < pairs; ++n) {
    const Cell a = cell();
    Cell b = cell();
    for (std::size_t axis = 0; axis < 3 && n % 2 == 0; ++axis) {
      b[axis] = std::clamp(a[axis] + draw.below(5) - 2, 0, counts[axis] - 1);
    }
    const auto before = n % 3 == 0 ? std::nullopt : std::optional(lattice.position(cell()));
    const bool free = check == MoveCheck::exact || line_of_sight(*rules.grid(), a, b);
    const bool kept = leg_ok(before, lattice.position(a), lattice.position(b), request);
    ASSERT_EQ(rules.sees(before, a, b), free && kept) << rules.refusals();
    (!free ? seen.blocked : kept ? seen.kept : seen.refused) += 1;
  }
  EXPECT_EQ(rules.moves_checked(), pairs);
}

/// Admits legs to the east, and as a first leg also one that leads neither east nor west.
class Eastward final : public Constraint {
  bool do_admits(const Motion& leg) const override {
    const double east = leg.to.x() - leg.from.x();
    return east > 0 || (east == 0 && !leg.before);
  }
};

void draw_turn_limits(oracle::Draw& draw, const Vec3& cell, Limits& limits) {
  if (draw.below(3) == 0) {
    limits.max_turn_horizontal = radians(draw(20, 170));
  }
  if (draw.below(3) == 0) {
    limits.max_turn_space = radians(draw(20, 170));
  }
  if (draw.below(3) == 0) {
    limits.min_turn_radius = cell.norm() * draw(0.2, 2);
  }
}

TEST(Sees, IsTheJudgesAnswerOverFreeCells) {
  Seen by_cells;
  Seen exact;
  int with_ground = 0;
  int without_limits = 0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    const auto problem = reference::random_problem(seed, {.max_cells = 12});
    Request& request = problem->request;
    if (!point_problem(request.start.position, request).empty()) {
      continue;  // no planner is asked, and the lattice may have no cell
    }
    oracle::Draw draw(seed + 1000);
    draw_turn_limits(draw, problem->lattice.cell, request.limits);
    if (draw.below(6) == 0) {
      request.constraints.push_back({"eastward", std::make_shared<Eastward>()});
    }
    const Lattice lattice(request, problem->lattice.cell, Neighbourhood::all, {});
    compare(request, lattice, MoveCheck::cells, 200, draw, by_cells);
    compare(request, lattice, MoveCheck::exact, 50, draw, exact);
    with_ground += problem->scene.ground.has_value();
    without_limits += MoveRules::cells_decide(request);
  }
  for (const Seen& seen : {by_cells, exact}) {
    EXPECT_GT(seen.kept, 1000);
    EXPECT_GT(seen.refused, 1000);
  }
  EXPECT_GT(by_cells.blocked, 1000);
  EXPECT_GT(with_ground, 50);
  EXPECT_GT(without_limits, 20);
}

/// The kit compares cosines where the judge compares angles.
TEST(KeepsLimits, IsTheJudgesAnswerNearTheLimits) {
  oracle::Draw draw(5);
  const Box everywhere{Vec3::Constant(-1e9), Vec3::Constant(1e9)};
  const Lattice lattice(
      testing::request_in(World(), {0, 0, 0}, {1, 1, 1}, {{-5, -5, -5}, {5, 5, 5}}), {1, 1, 1},
      Neighbourhood::all, {});
  const double offs[] = {0, 1e-12, 1e-9, 0.99999e-8, 1e-8, 1.00001e-8, 1e-7, 1e-4};
  const auto off = [&] {
    const double by = offs[draw.below(8)];
    return draw.below(2) == 0 ? by : -by;
  };
  int kept = 0;
  for (int n = 0; n < 30'000; ++n) {
    const double scale = std::pow(10, draw(-3, 5));
    const Vec3 a = Vec3(draw.below(2) * 5e6, draw.below(2) * 1e6, 100) + draw.point(scale);
    Vec3 in = draw.point(scale);
    Vec3 out = draw.point(scale);
    const int kind = draw.below(6);
    if (kind == 0) {  // nearly upright
      in.head<2>() *= std::pow(10, draw(-9, 0));
      out.head<2>() *= std::pow(10, draw(-9, 0));
    } else if (kind == 1) {
      in.z() = out.z() = 0;
    } else if (kind == 2) {  // straight on
      out = in * draw(0.1, 2);
    }
    const Vec3 before = a - in;
    const Vec3 b = a + out;
    in = a - before;
    out = b - a;
    Request request = testing::request_in(World(), a, b, everywhere);
    Limits& limits = request.limits;
    const int which = draw.below(16);
    const double radius = fillet_radius(in, out);
    if ((which & 1) != 0) {
      limits.max_turn_horizontal = std::clamp(turn_angle_horizontal(in, out) + off(), 0.0, kPi);
    }
    if ((which & 2) != 0) {
      limits.max_turn_space = std::clamp(turn_angle_in_space(in, out) + off(), 0.0, kPi);
    }
    if ((which & 4) != 0) {
      limits.max_climb = std::clamp(climb_angle(out) + off(), 0.0, kPi / 2);
    }
    if (which > 12 && radius < 1e6) {
      limits.min_turn_radius = std::max(0.0, radius + 1000 * off());
    }
    MoveRules rules(request, lattice, MoveCheck::exact, CornerRule::any);
    ASSERT_EQ(rules.keeps_limits(before, a, b), leg_ok(before, a, b, request))
        << n << ": in " << in.transpose() << ", out " << out.transpose();
    kept += leg_ok(before, a, b, request);
  }
  EXPECT_GT(kept, 10'000);
  EXPECT_LT(kept, 25'000);
}

TEST(Sees, OverALayersOwnCells) {
  oracle::Draw draw(4);
  Seen seen;
  for (int world = 0; world < 60; ++world) {
    std::vector<std::string> levels(std::size_t(1 + draw.below(6)));
    for (std::string& level : levels) {
      for (int j = 0; j < 7; ++j) {
        for (int i = 0; i < 9; ++i) {
          level += draw.below(6) == 0 ? '#' : '.';
        }
        level += '\n';
      }
    }
    levels[0][0] = 'S';
    levels[0][1] = 'G';
    Request request = testing::draw(levels, 3).request;
    request.limits.max_climb = world % 3 == 0 ? radians(40) : request.limits.max_climb;
    request.limits.max_leg = world % 4 == 0 ? 10 : kInfinity;
    const Lattice lattice(request, {1, 1, 1}, Neighbourhood::all, {});
    compare(request, lattice, MoveCheck::cells, 300, draw, seen);
  }
  EXPECT_GT(seen.kept, 1000);
  EXPECT_GT(seen.refused, 500);
  EXPECT_GT(seen.blocked, 1000);
}

/// Cells of 10 m: 10 × 10 × 2 of them.
Request open_request() {
  return testing::request_in(World(), {5, 5, 5}, {95, 95, 5}, {{0, 0, 0}, {100, 100, 20}});
}

TEST(Sees, CountsByRuleWhatItRefuses) {
  Request request = open_request();
  request.world =
      std::make_shared<World>(testing::world_of({BoxShape{{{41, 41, 1}, {49, 49, 19}}}}));
  request.limits.max_leg = 60;
  request.limits.max_climb = radians(30);
  request.limits.max_turn_horizontal = radians(45);
  const Lattice lattice(request, {10, 10, 10}, Neighbourhood::all, {});
  MoveRules rules(request, lattice, MoveCheck::cells, CornerRule::free_box);
  const auto at = [&](const Cell& c) { return lattice.position(c); };
  EXPECT_TRUE(rules.sees(std::nullopt, {0, 0, 0}, {6, 0, 0}));
  const std::string climb =
      "climb_angle rules out 18 of 26 directions (with cells at most 5.77 m high 2)";
  EXPECT_EQ(rules.refusals(), climb);
  EXPECT_FALSE(rules.sees(std::nullopt, {0, 0, 0}, {7, 0, 0}));
  EXPECT_FALSE(rules.sees(std::nullopt, {3, 4, 0}, {5, 4, 0}));
  EXPECT_FALSE(rules.sees(std::nullopt, {3, 4, 0}, {5, 4, 1}));
  EXPECT_FALSE(rules.sees(std::nullopt, {0, 0, 0}, {0, 1, 1}));
  EXPECT_FALSE(rules.parent_mattered());
  EXPECT_EQ(rules.refusals(), "blocked cells (2), leg_length (1), climb_angle (1); " + climb);
  EXPECT_TRUE(rules.sees(at({0, 0, 0}), {1, 0, 0}, {2, 1, 0}));
  EXPECT_FALSE(rules.sees(at({0, 0, 0}), {1, 0, 0}, {1, 1, 0}));
  EXPECT_TRUE(rules.parent_mattered());
  EXPECT_EQ(rules.moves_checked(), 7);
}

TEST(MaxTurnRadius, IsThatOfTheFilletBetweenAStraightAndADiagonalStep) {
  Request request = open_request();
  request.level_m = 5;
  const Lattice squares(request, {10, 10, 10}, Neighbourhood::all, {});
  EXPECT_NEAR(max_turn_radius(squares, squares.steps()), 5 / std::tan(kPi / 8), 1e-9);
  const Lattice faces(request, {10, 10, 10}, Neighbourhood::faces, {});
  EXPECT_NEAR(max_turn_radius(faces, faces.steps()), 5, 1e-9);
  EXPECT_EQ(max_turn_radius(faces, 0), 0);
  request.level_m.reset();
  // Steeper steps are longer, and turn by less: (1, 0, 1) into (1, 1, 1).
  const Lattice cubes(request, {10, 10, 10}, Neighbourhood::all, {});
  const double turn = std::acos(2 / std::sqrt(6.0));
  EXPECT_NEAR(max_turn_radius(cubes, cubes.steps()), std::sqrt(50.0) / std::tan(turn / 2), 1e-9);
  EXPECT_NEAR(max_turn_radius(cubes, kLevelDirections), 5 / std::tan(kPi / 8), 1e-9);
}

TEST(Sees, SaysWhetherAConstraintLookedAtTheLegBefore) {
  Request request = open_request();
  request.constraints.push_back({"eastward", std::make_shared<Eastward>()});
  const Lattice lattice(request, {10, 10, 10}, Neighbourhood::all, {});
  MoveRules rules(request, lattice, MoveCheck::cells, CornerRule::free_box);
  const std::optional<Vec3> south = lattice.position({4, 3, 0});
  EXPECT_TRUE(rules.sees(south, {4, 4, 0}, {5, 4, 0}));
  EXPECT_TRUE(rules.sees(std::nullopt, {4, 4, 0}, {4, 5, 0}));
  EXPECT_FALSE(rules.sees(std::nullopt, {4, 4, 0}, {3, 4, 0}));
  EXPECT_FALSE(rules.parent_mattered());
  EXPECT_FALSE(rules.sees(south, {4, 4, 0}, {4, 5, 0}));
  EXPECT_TRUE(rules.parent_mattered());
  EXPECT_EQ(rules.refusals(), "eastward (2)");
}

TEST(Sees, AsksTheWorldForNoObstacle) {
  /// Blocks everything, but no cell.
  class Untouchable final : public Environment {
    Box do_bounds() const override { return {}; }
    double do_clearance(const Vec3&) const override { return -kInfinity; }
    bool do_blocked(const Vec3&, const Vec3&, double) const override { return true; }
    void do_rasterize(VoxelGrid&) const override {}
  };
  Request request = open_request();
  request.world = std::make_shared<World>(testing::world_of(std::make_shared<Untouchable>()));
  const Lattice lattice(request, {10, 10, 10}, Neighbourhood::all, {});
  MoveRules by_cells(request, lattice, MoveCheck::cells, CornerRule::free_box);
  EXPECT_TRUE(by_cells.sees(std::nullopt, {0, 0, 0}, {9, 7, 1}));
  MoveRules exact(request, lattice, MoveCheck::exact, CornerRule::free_box);
  EXPECT_FALSE(exact.sees(std::nullopt, {0, 0, 0}, {9, 7, 1}));
}

TEST(AnyLeg, IsWorkedOutOnceWhereItIsRefused) {
  /// Blocks everything, and counts how often it is asked anything.
  class Counting final : public Environment {
   public:
    mutable int asked = 0;

   private:
    Box do_bounds() const override { return {}; }
    double do_clearance(const Vec3&) const override {
      ++asked;
      return -kInfinity;
    }
    bool do_blocked(const Vec3&, const Vec3&, double) const override {
      ++asked;
      return true;
    }
  };
  Request request = open_request();
  const auto layer = std::make_shared<Counting>();
  request.world = std::make_shared<World>(testing::world_of(layer));
  const Lattice lattice(request, {10, 10, 10}, Neighbourhood::all, {});
  const Vec3 a = lattice.position({0, 0, 0});
  const Vec3 b = lattice.position({7, 3, 1});
  EXPECT_FALSE(leg_ok(std::nullopt, a, b, request));
  const int once = std::exchange(layer->asked, 0);
  MoveRules rules(request, lattice, MoveCheck::exact, CornerRule::free_box);
  EXPECT_FALSE(rules.any_leg_ok(std::nullopt, a, b));
  EXPECT_EQ(layer->asked, once);
  EXPECT_EQ(rules.refusals(), "clearance on legs that are no step of the lattice (1)");
}
}  // namespace
}  // namespace altiplan::kit::move_rules_test
