// SPDX-License-Identifier: Apache-2.0
// What planners over cells promise, held against A* in small random worlds of all kinds.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <future>
#include <map>
#include <memory>
#include <string>

#include "altiplan/error.hpp"
#include "altiplan/measures.hpp"
#include "reference/random_levels.hpp"
#include "reference/random_problem.hpp"
#include "support/support.hpp"

namespace altiplan::random_plans_test {
namespace {

using testing::make_planner;

/// No leg is more than twice and a half as long as the one before.
class SlowGrowth final : public Constraint {
  bool do_admits(const Motion& leg) const override {
    return !leg.before || (leg.to - leg.from).norm() <= 2.5 * (leg.from - *leg.before).norm();
  }
};

void draw_more(oracle::Draw& draw, const Vec3& cell, Request& request) {
  Limits& limits = request.limits;
  if (draw.below(4) == 0) {
    limits.max_turn_horizontal = radians(draw(20, 170));
  }
  if (draw.below(5) == 0) {
    limits.max_turn_space = radians(draw(20, 170));
  }
  if (draw.below(8) == 0) {
    limits.min_turn_radius = cell.norm() * draw(0.2, 2);
  }
  if (draw.below(3) == 0) {
    request.start.velocity = draw.within({-20, -20, -5}, {20, 20, 5});
    request.start.velocity.z() = request.level_m ? 0 : request.start.velocity.z();
  }
  if (draw.below(8) == 0) {
    request.constraints.push_back({"slow_growth", std::make_shared<SlowGrowth>()});
  }
}

struct Case {
  Request request;
  Vec3 cell;
  std::unique_ptr<reference::Problem> kept;
};

Case among_solids(std::uint64_t seed) {
  Case world;
  world.kept = reference::random_problem(seed, {.max_cells = 10});
  world.request = world.kept->request;
  world.cell = world.kept->lattice.cell;
  oracle::Draw draw(seed + 1000);
  draw_more(draw, world.cell, world.request);
  return world;
}

/// A layer with cells of its own; ends off their centres.
Case among_cells(std::uint64_t seed) {
  oracle::Draw draw(seed + 2000);
  SplitMix64 random(seed);
  const bool level = draw.below(3) == 0;
  const int wide = draw.below(12) + 2;
  const int deep = draw.below(12) + 1;
  const int high = level ? 1 : draw.below(7) + 1;
  const double cell = draw.below(2) == 0 ? 1 : draw(0.5, 2000);
  const auto levels = testing::random_levels(random, wide, deep, high, draw(0.05, 0.45));
  Case world{testing::draw(levels, cell).request, Vec3::Constant(cell), nullptr};
  Request& request = world.request;
  for (Vec3* end : {&request.start.position, &request.goal.position}) {
    if (draw.below(2) == 0) {
      *end += draw.within(Vec3::Constant(-0.49 * cell), Vec3::Constant(0.49 * cell));
    }
  }
  if (level) {
    request.level_m = request.start.position.z();
    request.goal.position.z() = *request.level_m;
  }
  if (draw.below(3) == 0) {
    request.vehicle.radius_m = draw(0.05, 0.6) * cell;
  }
  if (draw.below(4) == 0) {
    request.goal.tolerance_m = cell * draw(0.1, 3);
  }
  if (draw.below(4) == 0) {
    const double way = (request.goal.position - request.start.position).norm();
    request.limits.max_route_length = way * draw(1, 2);
  }
  if (draw.below(3) == 0) {
    draw_more(draw, world.cell, request);
  }
  return world;
}

/// A planner's name, further parameters, and what it promises.
struct Held {
  std::string planner;
  std::string more;
  bool complete = false;    ///< finds a route where A* over cells and headings does
  bool short_ways = false;  ///< and without limits none that is longer than the grid's
};

const Held kPlanners[] = {
    {"theta_star", "", true, true},
    {"lazy_theta_star", "", true, true},
    {"theta_star", "angle_rule: printed", false, true},
    {"lazy_theta_star", "angle_rule: route_consistent", false, true},
    {"stratified_theta", "angle_rule: complete", true},
    {"stratified_theta", "angle_rule: complete, refine: corridor, d_limit_m: 0", true},
    {"stratified_theta", "start_levels: 4, p_max: 0.9, d_limit_m: 0"},
    {"spatial_slicing", "axis: auto"},
    {"spatial_slicing", "axis: z, plane_cells: 2"},
    {"dstar_lite", "moves: cells, corner: free_box, state: parent", false, true},
    {"dstar_lite", "moves: cells", true},
};

std::string yaml(const Vec3& cell, const std::string& more) {
  std::array<char, 120> text{};
  std::snprintf(text.data(), text.size(), "cell_m: [%.17g, %.17g, %.17g]", cell.x(), cell.y(),
                cell.z());
  return "{" + std::string(text.data()) + (more.empty() ? "" : ", ") + more + "}";
}

bool same(const PlanResult& a, const PlanResult& b) {
  return a.status == b.status && a.message == b.message && a.route == b.route &&
         a.budget_hit == b.budget_hit && a.proved == b.proved;
}

/// No rule looks at more than the cells that a leg leads through.
bool only_cells(const Request& request) {
  const Limits& limits = request.limits;
  return !limits.turns() && request.constraints.empty() && limits.max_climb >= kPi / 2 &&
         limits.min_leg <= 0 && limits.max_leg == kInfinity &&
         limits.max_route_length == kInfinity && !request.world->has_ground();
}

void expect_budgets_kept(const Planner& planner, const Request& request, const PlanResult& whole) {
  const std::int64_t all = whole.counters.front().value;
  for (std::int64_t most = 0; most <= std::min<std::int64_t>(all + 1, 40); ++most) {
    Request cut = request;
    cut.budget.max_iterations = std::uint64_t(most);
    const PlanResult part = planner.plan(cut);
    EXPECT_LE(part.counters.front().value, most);
    EXPECT_TRUE(part.status != PlanStatus::solved || check(part.route, request).ok());
    EXPECT_TRUE(part.budget_hit || same(part, whole)) << most << " of " << all << part.message;
    EXPECT_FALSE(part.status == PlanStatus::no_route && part.budget_hit) << part.message;
  }
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{1000}, std::size_t{30000}}) {
    Request little = request;
    little.budget.max_memory_bytes = bytes;
    const PlanResult part = planner.plan(little);
    EXPECT_TRUE(part.status != PlanStatus::solved || check(part.route, request).ok());
    EXPECT_FALSE(part.proved && !whole.proved) << part.message;
  }
}

void expect_promises_kept(const Held& held, const Case& world, const PlanResult& by_box,
                          const PlanResult& by_heading, bool more) {
  const Request& request = world.request;
  const auto planner = make_planner(held.planner, yaml(world.cell, held.more));
  const PlanResult result = planner->plan(request);
  if (result.status == PlanStatus::solved) {
    const CheckResult judged = check(result.route, request);
    EXPECT_TRUE(judged.ok()) << judged.violations.front().message;
    if (held.short_ways && only_cells(request) && by_box.status == PlanStatus::solved &&
        by_box.route.back() == result.route.back()) {
      EXPECT_LE(length(result.route), length(by_box.route) * (1 + 1e-7));
    }
  } else {
    ASSERT_EQ(result.status, PlanStatus::no_route) << result.message;
    EXPECT_FALSE(result.proved && by_box.status == PlanStatus::solved) << result.message;
    EXPECT_FALSE(held.short_ways && only_cells(request) && by_box.status == PlanStatus::solved);
    // What is proved is proved of steps that keep off closed corners.
    EXPECT_FALSE(held.complete && !result.proved && by_heading.status == PlanStatus::solved)
        << result.message;
  }
  EXPECT_TRUE(same(planner->plan(request), result));
  if (more) {
    auto other = std::async(std::launch::async, [&] { return planner->plan(request); });
    EXPECT_TRUE(
        same(make_planner(held.planner, yaml(world.cell, held.more))->plan(request), result));
    EXPECT_TRUE(same(other.get(), result));
    expect_budgets_kept(*planner, request, result);
  }
}

void expect_promises_kept(Case (*draw)(std::uint64_t), std::uint64_t count) {
  std::map<PlanStatus, int> seen;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    const Case world = draw(seed);
    const Request& request = world.request;
    if (!point_problem(request.start.position, request).empty() ||
        !point_problem(request.goal.position, request).empty()) {
      continue;
    }
    const auto astar = [&](const char* with) {
      return make_planner("astar", yaml(world.cell, with))->plan(request);
    };
    const PlanResult by_box = astar("moves: cells, corner: free_box, state: parent");
    const PlanResult by_heading = astar("moves: cells, state: cell_and_heading");
    ++seen[by_box.status];
    for (const Held& held : kPlanners) {
      SCOPED_TRACE(held.planner + " {" + held.more + "} seed " + std::to_string(seed));
      expect_promises_kept(held, world, by_box, by_heading, seed % 8 == 0);
    }
  }
  EXPECT_GT(seen[PlanStatus::solved], int(count / 8));
  EXPECT_GT(seen[PlanStatus::no_route], int(count / 16));
}

TEST(RandomPlans, KeepTheirPromisesAmongSolids) { expect_promises_kept(among_solids, 400); }
TEST(RandomPlans, KeepTheirPromisesAmongCells) { expect_promises_kept(among_cells, 400); }
TEST(NightlyRandomPlans, KeepTheirPromises) {
  expect_promises_kept(among_solids, 10'000);
  expect_promises_kept(among_cells, 5'000);
}
}  // namespace
}  // namespace altiplan::random_plans_test
