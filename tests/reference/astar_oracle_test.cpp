// SPDX-License-Identifier: Apache-2.0
// astar and bidirectional_astar against Dijkstra's algorithm on the lattice that their READMEs
// describe.
#include <gtest/gtest.h>

#include "reference/random_problem.hpp"

namespace altiplan::reference::astar_oracle_test {
namespace {

std::int64_t expanded(const PlanResult& result) {
  for (const Counter& counter : result.counters) {
    if (counter.name == "expanded") {
      return counter.value;
    }
  }
  return -1;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

constexpr const char* kPlanners[] = {"astar", "bidirectional_astar"};

/// The parameters of one search, as YAML.
struct Setting {
  std::string heuristic = "octile";
  double weight_g = 0.5;
  double weight_h = 0.5;
  std::string state = "auto";

  std::string yaml(const LatticeOptions& lattice) const {
    const Vec3& c = lattice.cell;
    return "{cell_m: [" + number(c.x()) + ", " + number(c.y()) + ", " + number(c.z()) +
           "], neighbours: " + std::to_string(lattice.neighbours) +
           ", corner: " + (lattice.free_box ? "free_box" : "any") +
           ", moves: " + (lattice.cells ? "cells" : "exact") + ", heuristic: " + heuristic +
           ", weight_g: " + number(weight_g) + ", weight_h: " + number(weight_h) +
           ", state: " + state + "}";
  }
  /// A route is at most this often the shortest (Pohl); 1: the shortest.
  double bound(int neighbours) const {
    const double stretch = heuristic == "zero"                            ? 0
                           : heuristic == "manhattan" && neighbours == 26 ? std::sqrt(3.0)
                                                                          : 1;
    return std::max(1.0, stretch * weight_h / weight_g);
  }
};

const std::vector<Setting> kSettings = {
    {"octile", 0.5, 0.5},    {"octile", 1, 0.3},      {"euclidean", 0.5, 0.5}, {"zero", 0.5, 0.5},
    {"manhattan", 0.9, 0.5}, {"manhattan", 0.5, 0.5}, {"octile", 0.3, 0.7},    {"zero", 1, 0},
};

struct Tally {
  int solved = 0;
  int unreachable = 0;
  int invalid = 0;
  int near_goal = 0;  ///< routes that end within the tolerance only
};

/// Holds one plan to the oracle. `best`: lengths by Dijkstra's algorithm. From both ends an
/// inflated heuristic has no bound.
void hold(const PlanResult& result, const LatticeOracle& oracle, const std::vector<double>& best,
          const Setting& setting, bool one_way, const Request& request, Tally& tally) {
  const double expected = oracle.shortest(best);
  const double of_setting = setting.bound(oracle.options.neighbours);
  const double bound = of_setting > 1 && !one_way ? kInfinity : of_setting;
  const bool limited = request.limits.max_route_length < kInfinity;
  if (expected == kInfinity) {
    ++tally.unreachable;
    ASSERT_EQ(result.status, PlanStatus::no_route) << result.message;
    EXPECT_TRUE(result.proved || bound > 1 || setting.heuristic == "manhattan") << result.message;
    return;
  }
  if (result.status == PlanStatus::no_route && limited && bound > 1) {
    EXPECT_FALSE(result.proved);  // a longer way than the shortest met the limit on length
    return;
  }
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  ++tally.solved;
  const CheckResult judged = check(result.route, request);
  EXPECT_TRUE(judged.ok()) << judged.violations.front().message;
  const double found = length(result.route);
  EXPECT_GE(found, expected * (1 - 1e-9) - 1e-6);
  if (result.route.back() != request.goal.position) {
    ++tally.near_goal;
    const double longest = request.limits.max_route_length + 1e-6;
    EXPECT_TRUE(best[oracle.goal] == kInfinity || best[oracle.goal] > longest || bound > 1);
    EXPECT_TRUE(found <= expected * (1 + 1e-9) + 1e-6 || bound > 1) << found << ' ' << expected;
    return;
  }
  EXPECT_LE(found, bound * expected * (1 + 1e-9) + 1e-6) << expected;
  if (bound == 1 && one_way) {
    std::int64_t within = 0;  // ties with the goal's cost included
    for (std::size_t c = 0; c < oracle.cells; ++c) {
      within += best[c] <= expected * (1 + 1e-9) + 1e-9;
    }
    EXPECT_LE(expanded(result), within);
  }
}

/// Every setting on one problem.
void compare(const Problem& problem, std::uint64_t seed, Tally& tally) {
  const Request& request = problem.request;
  const LatticeOracle oracle(request, problem.scene, problem.lattice);
  const bool start_free = oracle.rules.point_free(request.start.position);
  const bool goal_free = oracle.rules.point_free(request.goal.position);
  if (oracle.rules.in_doubt() || request.goal.reached_at(request.start.position)) {
    return;
  }
  const auto best = dijkstra(oracle.graph, oracle.start);
  for (const std::string planner : kPlanners) {
    for (const Setting& setting : kSettings) {
      const std::string yaml = setting.yaml(problem.lattice);
      SCOPED_TRACE("seed " + std::to_string(seed) + " " + planner + " " + yaml);
      const PlanResult result = testing::make_planner(planner, yaml)->plan(request);
      ASSERT_EQ(result.status == PlanStatus::invalid_problem, !start_free || !goal_free)
          << result.message;
      if (result.status == PlanStatus::invalid_problem) {
        ++tally.invalid;
        return;
      }
      hold(result, oracle, best, setting, planner == "astar", request, tally);
      if (::testing::Test::HasFailure()) {
        return;
      }
    }
  }
}

void compare(std::uint64_t seed, bool cells, Tally& tally) {
  Mix mix;
  mix.prisms = mix.ground = !cells;
  mix.max_cells = seed % 20 == 5 ? 12 : 6;
  const auto problem = random_problem(seed, mix);
  problem->lattice.cells = cells;
  problem->lattice.free_box = seed % 4 >= 2;
  problem->lattice.neighbours = seed % 2 == 0 ? 26 : 6;
  compare(*problem, seed, tally);
}

/// A layer that has cells of its own: start and goal need not be centres of them.
void compare_own_cells(std::uint64_t seed, Tally& tally) {
  oracle::Draw draw(seed);
  const Cell counts = {4 + draw.below(5), 4 + draw.below(5), 1 + draw.below(4)};
  const double share = draw(0.1, 0.5);
  Problem problem;
  std::vector<std::string> levels;
  for (int k = 0; k < counts[2]; ++k) {
    std::string& level = levels.emplace_back();
    for (int j = counts[1] - 1; j >= 0; --j) {
      for (int i = 0; i < counts[0]; ++i) {
        const bool solid = draw(0, 1) < share;
        level += solid ? '#' : '.';
        if (solid) {
          problem.scene.solids.push_back(
              {BoxShape{{Vec3(i, j, k), Vec3(i + 1, j + 1, k + 1)}}, {}});
        }
      }
      level += '\n';
    }
  }
  const testing::Drawn drawn = testing::draw(levels);
  problem.request = drawn.request;
  Request& request = problem.request;
  for (Vec3* end : {&request.start.position, &request.goal.position}) {
    const int k = draw.below(counts[2]);
    const int j = draw.below(counts[1]);
    const Vec3 low(draw.below(counts[0]), j, k);
    const bool centre = draw.below(2) == 0;
    *end =
        low + (centre ? Vec3(0.5, 0.5, 0.5) : draw.within({0.05, 0.05, 0.05}, {0.95, 0.95, 0.95}));
  }
  LatticeOptions& lattice = problem.lattice;
  lattice.cells = draw.below(3) != 0;
  lattice.free_box = lattice.cells && draw.below(2) == 0;
  lattice.neighbours = draw.below(2) == 0 ? 6 : 26;
  lattice.anchor = Vec3(0.5, 0.5, 0.5);
  lattice.closed = [&](const Vec3& centre) {
    return std::any_of(
        problem.scene.solids.begin(), problem.scene.solids.end(),
        [&](const auto& solid) { return oracle::signed_distance(solid, centre) < 0; });
  };
  if (!lattice.cells) {
    request.vehicle.radius_m = draw(0.02, 0.6);
  }
  if (draw.below(3) == 0) {
    request.goal.tolerance_m = draw(0.1, 2);
  }
  compare(problem, seed, tally);
}

void compare_many(std::uint64_t from, std::uint64_t to, bool cells) {
  Tally tally;
  for (std::uint64_t seed = from; seed < to && !::testing::Test::HasFailure(); ++seed) {
    compare(seed, cells, tally);
  }
  const int worlds = int(to - from);
  EXPECT_GT(tally.solved, worlds);
  EXPECT_GT(tally.unreachable, worlds / 10);
  EXPECT_GT(tally.near_goal, worlds / 50);
  EXPECT_GT(tally.invalid, worlds / 50);
}

TEST(AStarOracle, ExactMovesEqualDijkstra) { compare_many(0, 400, false); }
TEST(AStarOracle, MovesByCellsEqualDijkstra) { compare_many(0, 400, true); }
TEST(AStarOracle, CellsOfALayerEqualDijkstra) {
  Tally tally;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    compare_own_cells(seed, tally);
  }
  EXPECT_GT(tally.solved, 600);
  EXPECT_GT(tally.unreachable, 40);
}
TEST(NightlyAStarOracle, CellsOfALayerEqualDijkstra) {
  Tally tally;
  for (std::uint64_t seed = 1000; seed < 6000; ++seed) {
    compare_own_cells(seed, tally);
  }
}
TEST(NightlyAStarOracle, ExactMovesEqualDijkstra) { compare_many(1000, 9000, false); }
TEST(NightlyAStarOracle, MovesByCellsEqualDijkstra) { compare_many(1000, 9000, true); }

struct TurnTally {
  int solved = 0;  ///< by cell and heading
  int lost = 0;    ///< of these, by parent
  int unreachable = 0;
};

/// `to_goal`: the shortest way to the goal itself, `expected` to where a route may end.
void hold_turns(const PlanResult& result, const Setting& setting, double to_goal, double expected,
                const Problem& problem, TurnTally& tally) {
  const Request& request = problem.request;
  const bool by_heading = setting.state == "cell_and_heading";
  if (result.status != PlanStatus::solved) {
    ASSERT_EQ(result.status, PlanStatus::no_route);
    EXPECT_TRUE(setting.state == "parent" || expected == kInfinity) << result.message;
    EXPECT_FALSE(result.proved && expected < kInfinity) << result.message;
    EXPECT_TRUE(result.proved || setting.state == "parent") << result.message;
    tally.lost += expected < kInfinity;
    tally.unreachable += by_heading;
    return;
  }
  EXPECT_TRUE(check(result.route, request).ok());
  if (has_long_last_leg(result.route, problem)) {
    EXPECT_FALSE(by_heading);
    return;
  }
  const double found = length(result.route);
  // The goal itself may be out of reach for the one parent of a cell: then the tolerance counts.
  const bool at_goal = result.route.back() == request.goal.position;
  EXPECT_GE(found, (at_goal ? to_goal : 0) * (1 - 1e-9) - 1e-6);
  ASSERT_LT(expected, kInfinity);
  if (by_heading) {
    ++tally.solved;
    EXPECT_NEAR(found, expected, expected * 1e-9 + 1e-6);
  }
}

/// With limits on turns one parent a cell may lose a route, but never invents one or a proof; by
/// cell and heading the route is the shortest.
void compare_turns(std::uint64_t seed, TurnTally& tally) {
  Mix mix;
  mix.max_cells = 4.5;
  mix.ground = false;
  const auto problem = random_problem(seed, mix);
  Request& request = problem->request;
  oracle::Draw draw(seed + 7);
  const double turns[] = {50, 80, 100, 140};
  (seed % 2 == 0 ? request.limits.max_turn_horizontal : request.limits.max_turn_space) =
      radians(turns[draw.below(4)]);
  request.vehicle.turns_on_the_spot = seed % 5 == 0;
  if (draw.below(2) == 0) {
    request.start.velocity = draw.point(3);
  }
  const LatticeOracle oracle(request, problem->scene, problem->lattice);
  const auto turn = [](Vec3 u, Vec3 v, bool flat) {
    u.z() = flat ? 0 : u.z();
    v.z() = flat ? 0 : v.z();
    const double norms = u.norm() * v.norm();
    return norms < 1e-12 ? 0 : std::acos(std::clamp(u.dot(v) / norms, -1.0, 1.0));
  };
  const auto& at = oracle.graph.at;
  const auto has_heading = [&](std::size_t from, std::size_t to) {
    return std::hypot(at[to].x() - at[from].x(), at[to].y() - at[from].y()) >= 1e-6;
  };
  const auto turn_ok = [&](const Reached& reached, std::size_t next) {
    const std::size_t here = reached.here;
    if (at[here] == at[next]) {
      return true;  // from the start to the cell whose centre it is
    }
    std::size_t from = reached.before;
    if (from != kNoNode && at[from] == at[here]) {
      from = kNoNode;
    }
    const Vec3 out = at[next] - at[here];
    const Vec3 in = from == kNoNode ? request.start.velocity : Vec3(at[here] - at[from]);
    // The heading lasts through legs that have none.
    Vec3 heading = reached.heading_from == kNoNode
                       ? request.start.velocity
                       : Vec3(at[reached.heading_to] - at[reached.heading_from]);
    if (request.vehicle.turns_on_the_spot) {
      heading = in;
    }
    const bool upright = std::hypot(out.x(), out.y()) < 1e-6;
    return (upright || turn(heading, out, true) <= request.limits.max_turn_horizontal + 1e-7) &&
           turn(in, out, false) <= request.limits.max_turn_space + 1e-7;
  };
  const auto best = dijkstra_with_turns(oracle.graph, oracle.start, turn_ok, has_heading);
  const double expected = oracle.shortest(best);
  if (oracle.rules.in_doubt() || request.goal.reached_at(request.start.position)) {
    return;
  }
  for (const std::string planner : kPlanners) {
    for (const char* state : {"parent", "cell_and_heading", "auto"}) {
      Setting setting;
      setting.state = state;
      const std::string yaml = setting.yaml(problem->lattice);
      SCOPED_TRACE("seed " + std::to_string(seed) + " " + planner + " " + yaml);
      const PlanResult result = testing::make_planner(planner, yaml)->plan(request);
      if (result.status == PlanStatus::invalid_problem) {
        return;
      }
      hold_turns(result, setting, best[oracle.goal], expected, *problem, tally);
    }
  }
}

TEST(AStarOracle, ByCellAndHeadingEqualsDijkstraUnderTurnLimits) {
  TurnTally tally;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    compare_turns(seed, tally);
  }
  EXPECT_GT(tally.solved, 120);
  EXPECT_GT(tally.lost, 0);
  EXPECT_GT(tally.unreachable, 20);
}

TEST(AStarOracle, HoldsWhereItOnceDidNot) {
  Tally tally;
  compare(24, false, tally);    // a route within the goal's tolerance, and a limit on its length
  compare(1433, false, tally);  // manhattan over faces, the goal between centres
  compare(4124, false, tally);  // a way around that left the lattice
  EXPECT_GT(tally.solved, 8);
  TurnTally turns;
  compare_turns(3976, turns);  // a vertical leg after one to the south-west
  compare_turns(4532, turns);  // a vertical leg but for rounding
  EXPECT_EQ(turns.solved, 4);
}

TEST(NightlyAStarOracle, ByCellAndHeadingEqualsDijkstraUnderTurnLimits) {
  TurnTally tally;
  for (std::uint64_t seed = 1000; seed < 6000; ++seed) {
    compare_turns(seed, tally);
  }
  EXPECT_GT(tally.solved, 2000);
}
}  // namespace
}  // namespace altiplan::reference::astar_oracle_test
