// SPDX-License-Identifier: Apache-2.0
// What theta_star and lazy_theta_star are both held to.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "altiplan/measures.hpp"
#include "reference/paper_cities.hpp"
#include "reference/random_levels.hpp"
#include "reference/visible_cells.hpp"
#include "support/support.hpp"

namespace altiplan::testing {

inline void expect_sound(const PlanResult& result, const Request& request) {
  const CheckResult judged = check(result.route, request);
  EXPECT_TRUE(judged.ok()) << judged.violations.front().message;
}

/// Every grid route is a visible route, so on cells none is longer than the shortest of them.
inline void expect_never_longer_than_the_grid(const std::string& planner, int maps) {
  SplitMix64 random(11);
  const auto grid = make_planner("astar", "{corner: free_box}");
  const auto any_angle = make_planner(planner);
  double sum = 0;
  int solved = 0;
  for (int map = 0; map < maps; ++map) {
    const bool level = map % 4 == 0;
    Drawn drawn = draw(level ? random_levels(random, 40, 30, 1, 0.1 + 0.05 * (map % 5))
                             : random_levels(random, 16, 14, 12, 0.05 + 0.05 * (map % 5)));
    if (level) {
      drawn.request.level_m = 0.5;
    }
    const PlanResult shortest = grid->plan(drawn.request);
    const PlanResult result = any_angle->plan(drawn.request);
    ASSERT_EQ(result.status, shortest.status) << map << result.message;
    if (result.status == PlanStatus::solved) {
      ++solved;
      expect_sound(result, drawn.request);
      EXPECT_LE(length(result.route), length(shortest.route) * (1 + 1e-9)) << map;
      sum += length(result.route) / std::max(length(shortest.route), 1.0);
    } else {
      EXPECT_EQ(result.proved, shortest.proved) << map;
    }
  }
  EXPECT_GT(solved, maps / 2);
  EXPECT_LT(sum / solved, 0.985);
}

/// Balls in a box; neither end is the centre of a cell but for the lattice that starts there.
inline Request among_some_balls(SplitMix64& random, int count) {
  std::vector<Shape> balls;
  while (int(balls.size()) < count) {
    const double x = random.uniform() * 200;
    const double y = random.uniform() * 160;
    const double z = random.uniform() * 80;
    const Vec3 at(x, y, z);
    if ((at - Vec3(7, 8, 9)).norm() > 40 && (at - Vec3(188, 151, 66)).norm() > 40) {
      balls.emplace_back(Sphere{at, 15});
    }
  }
  Request request = request_in(world_of(std::move(balls)), {7, 8, 9}, {188, 151, 66},
                               {{0, 0, 0}, {200, 160, 80}});
  request.vehicle.radius_m = 2;
  return request;
}

inline void expect_limits_kept(const std::string& planner) {
  SplitMix64 random(12);
  const auto complete = make_planner(planner, "{cell_m: [10, 10, 10]}");
  const auto consistent =
      make_planner(planner, "{cell_m: [10, 10, 10], angle_rule: route_consistent}");
  const auto printed = make_planner(planner, "{cell_m: [10, 10, 10], angle_rule: printed}");
  int solved = 0;
  int refused = 0;
  for (int world = 0; world < 30; ++world) {
    Request request = among_some_balls(random, 25);
    request.limits.max_climb = radians(60);
    (world % 2 == 0 ? request.limits.max_turn_space : request.limits.max_turn_horizontal) =
        radians(50);
    request.limits.min_clearance = 1;
    if (world % 3 == 0) {
      request.start.velocity = {10, 2, 1};
    }
    for (const Planner* one : {complete.get(), consistent.get(), printed.get()}) {
      const PlanResult result = one->plan(request);
      if (result.status == PlanStatus::solved) {
        ++solved;
        expect_sound(result, request);
        EXPECT_EQ(result.route.back(), request.goal.position);
      } else {
        EXPECT_NE(one, complete.get()) << world << result.message;
        refused += result.message.find("rule as printed") != std::string::npos;
      }
    }
  }
  EXPECT_GT(solved, 50);
  EXPECT_GT(refused, 0);
}

/// Sums of rounded costs do not decide whether a route is too long.
inline void expect_a_limit_on_length_kept(const std::string& planner) {
  SplitMix64 random(14);
  const auto any_angle = make_planner(planner);
  int solved = 0;
  for (int map = 0; map < 50; ++map) {
    Request request = draw(random_levels(random, 20, 16, 4, 0.2), 1000).request;
    const double whole = length(any_angle->plan(request).route);
    for (const double less : {0.0, 1e-5, 3e-5, 1e-4, 3e-4}) {
      request.limits.max_route_length = whole - less;
      const PlanResult result = any_angle->plan(request);
      if (result.status == PlanStatus::solved) {
        ++solved;
        expect_sound(result, request);
      }
    }
  }
  EXPECT_GT(solved, 0);
}

/// A route by the rule as printed that breaks another rule proves nothing.
inline void expect_no_proof_by_the_printed_rule(const std::string& planner) {
  Request request =
      request_in(world_of(make_environment("hills",
                                           "{base_m: 0, peaks: "
                                           "[{at_m: [100, 55], height_m: 40, sigma_m: [20, 20]}]}"),
                          "hills"),
                 {5, 55, 25}, {195, 55, 25}, {{0, 0, 0}, {200, 100, 100}});
  request.limits.min_ground_clearance = 15;
  const PlanResult sound = make_planner(planner, "{cell_m: [10, 10, 10]}")->plan(request);
  ASSERT_EQ(sound.status, PlanStatus::solved) << sound.message;
  const PlanResult printed =
      make_planner(planner, "{cell_m: [10, 10, 10], angle_rule: printed}")->plan(request);
  EXPECT_EQ(printed.status, PlanStatus::no_route);
  EXPECT_NE(printed.message.find("ground"), std::string::npos) << printed.message;
  EXPECT_FALSE(printed.proved);
}

inline void expect_the_ends_joined_wherever_they_are(const std::string& planner) {
  SplitMix64 random(13);
  const auto cells = make_planner(planner, "{cell_m: [10, 10, 10]}");
  int solved = 0;
  for (int world = 0; world < 30; ++world) {
    const Request request = among_some_balls(random, 30);
    const PlanResult result = cells->plan(request);
    if (result.status == PlanStatus::solved) {
      ++solved;
      expect_sound(result, request);
      EXPECT_EQ(result.route.front(), request.start.position);
      EXPECT_EQ(result.route.back(), request.goal.position);
    }
  }
  EXPECT_GT(solved, 25);
  // Beside the centres of a layer's own cells, in level flight and not.
  Drawn drawn = draw({"S.......\n........\n..####..\n..####..\n........\n.......G",
                      "........\n........\n........\n..####..\n........\n........"},
                     10);
  drawn.request.start.position += Vec3(3, -2, 1);
  drawn.request.goal.position += Vec3(-4, 1, 2);
  const PlanResult beside = make_planner(planner)->plan(drawn.request);
  ASSERT_EQ(beside.status, PlanStatus::solved) << beside.message;
  expect_sound(beside, drawn.request);
  EXPECT_LT(length(beside.route), 100);
}

inline void expect_budget_and_refusals_told(const std::string& planner) {
  const auto plan = [&](const Request& request) { return make_planner(planner)->plan(request); };
  Drawn drawn = draw({"S.........\n.########.\n.........G"});
  drawn.request.level_m = 0.5;
  drawn.request.budget.max_iterations = 3;
  const PlanResult cut = plan(drawn.request);
  EXPECT_EQ(cut.status, PlanStatus::timed_out);
  EXPECT_TRUE(cut.budget_hit);
  EXPECT_EQ(cut.counters.front().value, 3);
  std::stop_source stop;
  stop.request_stop();
  drawn.request.budget = {};
  drawn.request.budget.stop = stop.get_token();
  EXPECT_EQ(plan(drawn.request).status, PlanStatus::cancelled);

  Drawn sealed = draw({"S.....\n......\n...###\n...#G#\n...###"});
  sealed.request.level_m = 0.5;
  const PlanResult shut = plan(sealed.request);
  EXPECT_EQ(shut.status, PlanStatus::no_route);
  EXPECT_TRUE(shut.proved);
  EXPECT_NE(shut.message.find("blocked cells"), std::string::npos) << shut.message;
  sealed.request.goal.tolerance_m = 2.1;
  const PlanResult near = plan(sealed.request);
  ASSERT_EQ(near.status, PlanStatus::solved) << near.message;
  EXPECT_LE((near.route.back() - sealed.request.goal.position).norm(), 2.1 + 1e-9);
  sealed.request.goal = {sealed.request.start.position, 0};
  EXPECT_EQ(plan(sealed.request).route.size(), 1u);

  drawn.request.budget = {};
  drawn.request.limits.max_route_length = 11.0;
  EXPECT_EQ(plan(drawn.request).status, PlanStatus::solved);
  drawn.request.limits.max_route_length = 10.0;
  const PlanResult long_way = plan(drawn.request);
  EXPECT_EQ(long_way.status, PlanStatus::no_route) << length(long_way.route);
  EXPECT_NE(long_way.message.find("route_length"), std::string::npos) << long_way.message;
}

struct CountedTrace final : Trace {
  void add(const TraceEvent&) override { ++events; }
  std::int64_t events = 0;
};

/// A corridor too long for the finest costs: the search that finds this out counts too.
inline void expect_long_ways_found(const std::string& planner) {
  std::string text;
  constexpr int kEdge = 601;
  for (int row = 0; row < kEdge; ++row) {
    std::string line(kEdge, row % 2 == 0 ? '.' : '#');
    if (row % 2 == 1) {
      (row % 4 == 1 ? line.back() : line.front()) = '.';
    }
    text += line + "\n";
  }
  text.front() = 'S';
  text[text.size() - 2] = 'G';
  Drawn drawn = draw({text});
  drawn.request.level_m = 0.5;
  const PlanResult result = make_planner(planner)->plan(drawn.request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  constexpr int kCells = (kEdge + 1) / 2 * kEdge + kEdge / 2;
  EXPECT_NEAR(length(result.route), kCells - 1, 1e-6);
  CountedTrace trace;
  drawn.request.trace = &trace;
  drawn.request.budget.max_iterations = std::uint64_t(result.counters.front().value) - 1;
  EXPECT_EQ(make_planner(planner)->plan(drawn.request).status, PlanStatus::timed_out);
  EXPECT_LE(trace.events, result.counters.front().value);
}

/// Beside the shortest route of all that bend at centres of cells, on 20 of the paper's complex
/// cities: below their roofs, which all stand higher than 55 cells, that is one on the start's
/// level.
inline void expect_nearly_the_shortest(const std::string& planner, int cities) {
  const auto any_angle = make_planner(planner);
  constexpr int kLevel = 4;
  double share = 0;
  int seen = 0;
  for (std::uint64_t seed = 0; seen < cities; ++seed) {
    const Request request = in_city(true, seed);
    const GridSpec spec = *request.world->native_grid();
    const VoxelGrid grid = reference::level_of(*request.world->voxels(spec), kLevel);
    const auto shortest = reference::shortest_visible(grid, {1, 2, 0}, {67, 64, 0});
    const double over_roofs = 2 * 10 * (60 - kLevel);
    if (shortest && *shortest < over_roofs) {
      ++seen;
      const double route = length(any_angle->plan(request).route);
      EXPECT_GE(route, *shortest * (1 - 1e-9)) << seed;
      share += route / *shortest / cities;
    }
  }
  EXPECT_LT(share, 1.005);
}
}  // namespace altiplan::testing
