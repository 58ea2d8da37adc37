// SPDX-License-Identifier: Apache-2.0
// What a change of the problem must do to the shortest route: nothing, or make it no shorter.
#include <gtest/gtest.h>

#include "reference/isometry.hpp"

namespace altiplan::reference::astar_metamorphic_test {
namespace {

/// By cell and heading, which turns need for the shortest route.
PlanResult plan(const Problem& problem) {
  char yaml[256];
  const Vec3& c = problem.lattice.cell;
  std::snprintf(yaml, sizeof yaml,
                "{cell_m: [%.17g, %.17g, %.17g], neighbours: %d, corner: %s, moves: %s, "
                "state: cell_and_heading}",
                c.x(), c.y(), c.z(), problem.lattice.neighbours,
                problem.lattice.free_box ? "free_box" : "any",
                problem.lattice.cells ? "cells" : "exact");
  return testing::make_planner("astar", yaml)->plan(problem.request);
}

/// Length of the planned route; infinite where there is none.
double planned(const Problem& problem) {
  const PlanResult result = plan(problem);
  return result.status == PlanStatus::solved ? length(result.route) : kInfinity;
}

std::unique_ptr<Problem> problem_of(std::uint64_t seed, bool cells) {
  Mix mix;
  mix.prisms = mix.ground = !cells;
  auto problem = random_problem(seed, mix);
  problem->lattice.cells = cells;
  problem->lattice.free_box = seed % 4 >= 2;
  problem->lattice.neighbours = seed % 3 == 0 ? 6 : 26;
  return problem;
}

/// Whether a verdict of this problem hangs on rounding.
bool in_doubt(const Problem& problem) {
  const LatticeOracle oracle(problem.request, problem.scene, problem.lattice);
  oracle.rules.point_free(problem.request.start.position);
  oracle.rules.point_free(problem.request.goal.position);
  return oracle.rules.in_doubt();
}

void expect_equal(double one, double other) {
  if (one == kInfinity || other == kInfinity) {
    EXPECT_EQ(one, other);
  } else {
    EXPECT_NEAR(one, other, 1e-9 * one + 1e-8);
  }
}

void hold_isometries(std::uint64_t from, std::uint64_t to, bool cells) {
  int solved = 0;
  for (std::uint64_t seed = from; seed < to && !::testing::Test::HasFailure(); ++seed) {
    const auto problem = problem_of(seed, cells);
    if (in_doubt(*problem)) {
      continue;
    }
    const double plain = planned(*problem);
    solved += plain < kInfinity;
    for (const auto& [name, by] : isometries(problem->scene.ground.has_value())) {
      SCOPED_TRACE("seed " + std::to_string(seed) + " " + name);
      expect_equal(plain * by.scale, planned(mapped(*problem, by)));
    }
  }
  EXPECT_GT(solved, int(to - from) / 5);
}
TEST(AStarSeenFromElsewhere, HasTheSameLength) { hold_isometries(0, 300, false); }
TEST(AStarSeenFromElsewhere, HasTheSameLengthByCells) { hold_isometries(0, 200, true); }
TEST(NightlyAStarSeenFromElsewhere, HasTheSameLength) { hold_isometries(1000, 6000, false); }
TEST(NightlyAStarSeenFromElsewhere, HasTheSameLengthByCells) { hold_isometries(1000, 6000, true); }

/// From the goal to the start, where both are centres of one lattice.
void hold_swaps(std::uint64_t from, std::uint64_t to) {
  int solved = 0;
  for (std::uint64_t seed = from; seed < to && !::testing::Test::HasFailure(); ++seed) {
    const auto problem = problem_of(seed, seed % 5 == 0);
    Request& request = problem->request;
    request.goal.tolerance_m = 0;
    const Vec3 apart =
        (request.goal.position - request.start.position).cwiseQuotient(problem->lattice.cell);
    if ((apart - apart.array().round().matrix()).norm() > 1e-6 || in_doubt(*problem)) {
      continue;
    }
    const double there = planned(*problem);
    std::swap(request.start.position, request.goal.position);
    SCOPED_TRACE(seed);
    expect_equal(there, planned(*problem));
    solved += there < kInfinity;
  }
  EXPECT_GT(solved, int(to - from) / 10);
}
TEST(AStarSeenFromElsewhere, ThereAndBackAreEquallyFar) { hold_swaps(0, 400); }
TEST(NightlyAStarSeenFromElsewhere, ThereAndBackAreEquallyFar) { hold_swaps(1000, 9000); }

/// The same solids, told otherwise.
void hold_retellings(std::uint64_t from, std::uint64_t to) {
  int solved = 0;
  for (std::uint64_t seed = from; seed < to && !::testing::Test::HasFailure(); ++seed) {
    const auto problem = problem_of(seed, seed % 4 == 0);
    if (in_doubt(*problem)) {
      continue;
    }
    oracle::Draw draw(seed);
    const double plain = planned(*problem);
    solved += plain < kInfinity;
    SCOPED_TRACE(seed);
    const auto retold = [&](const char* how, const Scene& scene, std::size_t layers) {
      SCOPED_TRACE(how);
      Problem other = *problem;
      other.scene = scene;
      other.request.world = std::make_shared<const World>(world_of(scene, layers));
      expect_equal(plain, planned(other));
    };
    for (const std::size_t layers : {1, 2, 5}) {
      retold("other layers", problem->scene, layers);
    }
    Scene scene = problem->scene;
    std::shuffle(scene.solids.begin(), scene.solids.end(), draw.engine);
    retold("another order", scene, 3);
    scene = problem->scene;
    if (!scene.solids.empty()) {
      scene.solids.push_back(scene.solids[std::size_t(draw.below(int(scene.solids.size())))]);
      retold("one twice", scene, 2);
    }
    scene = problem->scene;
    for (const double side : {-1.0, 1.0}) {
      const Vec3 far = side * (problem->request.volume.max - problem->request.volume.min);
      const Vec3 at = (side < 0 ? problem->request.volume.min : problem->request.volume.max) + far;
      scene.solids.push_back({Sphere{at, 0.9 * far.norm() - 1}, {}});
    }
    retold("more outside", scene, 1);
    scene.solids.clear();
    for (const oracle::Solid& solid : problem->scene.solids) {
      const auto* whole = std::get_if<BoxShape>(&solid.shape);
      if (whole == nullptr) {
        scene.solids.push_back(solid);
        continue;
      }
      BoxShape low = *whole;
      BoxShape high = *whole;
      const int axis = draw.below(2);
      low.box.max[axis] = high.box.min[axis] = draw(whole->box.min[axis], whole->box.max[axis]);
      scene.solids.push_back({low, {}});
      scene.solids.push_back({high, {}});
    }
    retold("boxes in halves that touch", scene, 1);
  }
  EXPECT_GT(solved, int(to - from) / 3);
}
TEST(AStarMetamorphic, TheSameSolidsToldOtherwiseChangeNothing) { hold_retellings(0, 300); }
TEST(NightlyAStarMetamorphic, TheSameSolidsToldOtherwiseChangeNothing) {
  hold_retellings(1000, 6000);
}

struct Harder {
  const char* name;
  std::function<void(Problem&, oracle::Draw&)> make;
};
const std::vector<Harder> kHarder = {
    {"one solid more",
     [](Problem& p, oracle::Draw& draw) {
       const Box& v = p.request.volume;
       const Vec3 at = draw.within(v.min, v.max);
       p.scene.solids.push_back({Sphere{at, p.lattice.cell.norm() * draw(0.2, 1)}, {}});
       p.request.world = std::make_shared<const World>(world_of(p.scene));
     }},
    {"a larger vehicle",
     [](Problem& p, oracle::Draw& draw) { p.request.vehicle.radius_m += draw(0.01, 0.5); }},
    {"more clearance",
     [](Problem& p, oracle::Draw& draw) { p.request.limits.min_clearance += draw(0.01, 0.5); }},
    {"less climb",
     [](Problem& p, oracle::Draw& draw) { p.request.limits.max_climb *= draw(0.3, 0.99); }},
    {"shorter legs",
     [](Problem& p, oracle::Draw& draw) {
       double& most = p.request.limits.max_leg;
       most = std::min(most, p.lattice.cell.norm()) * draw(0.5, 0.99);
     }},
    {"longer legs",
     [](Problem& p, oracle::Draw& draw) {
       p.request.limits.min_leg += p.lattice.cell.minCoeff() * draw(0.2, 1.3);
     }},
    {"a shorter route",
     [](Problem& p, oracle::Draw& draw) {
       double& most = p.request.limits.max_route_length;
       const Vec3 way = p.request.goal.position - p.request.start.position;
       most = std::min(most, 2 * way.norm()) * draw(0.5, 0.99);
     }},
    {"a narrower band",
     [](Problem& p, oracle::Draw& draw) {
       const double at = p.request.start.position.z();
       p.request.limits.altitude.push_back(
           {AltitudeBand::Datum::sea, at - draw(0, 3), at + draw(0, 3)});
     }},
    {"a smaller volume",
     [](Problem& p, oracle::Draw& draw) {
       Box& v = p.request.volume;
       const Vec3 cut = (v.max - v.min) * draw(0, 0.2);
       v = {v.min + cut, v.max - cut};
     }},
    {"turns", [](Problem& p,
                 oracle::Draw& draw) { p.request.limits.max_turn_space = radians(draw(40, 170)); }},
    {"more room above the ground",
     [](Problem& p, oracle::Draw& draw) {
       auto& least = p.request.limits.min_ground_clearance;
       least = least.value_or(0) + (p.scene.ground ? draw(0.05, 1) : 0);
     }},
};

/// Taking an obstacle away is the same relation, read backward.
void hold_monotony(std::uint64_t from, std::uint64_t to) {
  int solved = 0;
  int longer = 0;
  for (std::uint64_t seed = from; seed < to && !::testing::Test::HasFailure(); ++seed) {
    const auto problem = problem_of(seed, seed % 4 == 0);
    problem->request.goal.tolerance_m = 0;  // else a goal out of reach is left for a nearer place
    const double plain = planned(*problem);
    oracle::Draw draw(seed);
    for (const Harder& harder : kHarder) {
      Problem other = *problem;
      harder.make(other, draw);
      SCOPED_TRACE("seed " + std::to_string(seed) + " " + harder.name);
      const double now = planned(other);
      EXPECT_GE(now, plain * (1 - 1e-9) - 1e-6);
      solved += now < kInfinity;
      longer += now > plain + 1e-6;
    }
  }
  EXPECT_GT(solved, int(to - from));
  EXPECT_GT(longer, int(to - from) / 4);
}
TEST(AStarMetamorphic, AHarderProblemHasNoShorterRoute) { hold_monotony(0, 300); }
TEST(NightlyAStarMetamorphic, AHarderProblemHasNoShorterRoute) { hold_monotony(1000, 6000); }

/// More iterations: from timed out to solved, never back, and never to another optimum.
TEST(AStarMetamorphic, MoreBudgetIsNeverWorse) {
  int grown = 0;
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    auto problem = problem_of(seed, false);
    const PlanResult all = plan(*problem);
    if (all.status != PlanStatus::solved && all.status != PlanStatus::no_route) {
      continue;
    }
    SCOPED_TRACE(seed);
    double best = kInfinity;
    for (std::uint64_t budget = 0; budget <= 1024; budget = 2 * budget + 1) {
      problem->request.budget.max_iterations = budget;
      const PlanResult result = plan(*problem);
      if (result.status == PlanStatus::solved) {
        EXPECT_TRUE(check(result.route, problem->request).ok());
        const double found = length(result.route);
        const bool at_goal = result.route.back() == problem->request.goal.position;
        EXPECT_TRUE(best == kInfinity || at_goal || found <= best + 1e-9);
        grown += best == kInfinity && budget > 0;
        best = found;
      } else {
        EXPECT_EQ(best, kInfinity) << "solved before, with less";
        EXPECT_TRUE(result.status == PlanStatus::no_route || result.budget_hit);
        EXPECT_FALSE(result.budget_hit && result.proved);
      }
    }
    EXPECT_EQ(best, all.status == PlanStatus::solved ? length(all.route) : kInfinity);
  }
  EXPECT_GT(grown, 30);
}
}  // namespace
}  // namespace altiplan::reference::astar_metamorphic_test
