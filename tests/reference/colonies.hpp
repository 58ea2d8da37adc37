// SPDX-License-Identifier: Apache-2.0
// What ant_colony and improved_ant_colony, one loop, are both held to. `settings` are parameters
// without the braces, with 20 iterations of 30 ants.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/objective.hpp"
#include "altiplan/route.hpp"
#include "support/support.hpp"

namespace altiplan::testing {

/// Level flight past a block in the straight way.
inline Request flat_world() {
  Request request = request_in(world_of({Shape{BoxShape{{{150, 100, 0}, {250, 320, 100}}}}}),
                               {25, 205, 50}, {375, 205, 50}, {{0, 0, 50}, {400, 400, 50}});
  request.level_m = 50;
  request.random = RandomStream(11);
  return request;
}

inline PlanResult plan_of(const std::string& planner, const std::string& settings,
                          const Request& request) {
  return make_planner(planner, "{" + settings + "}")->plan(request);
}

inline bool equal(const PlanResult& a, const PlanResult& b) {
  bool same = a.status == b.status && a.route == b.route && a.message == b.message &&
              a.counters.size() == b.counters.size();
  for (std::size_t n = 0; same && n < a.counters.size(); ++n) {
    same = a.counters[n].name == b.counters[n].name && a.counters[n].value == b.counters[n].value;
  }
  return same;
}

inline void expect_one_result_for_any_threads(const std::string& planner,
                                              const std::string& settings) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    Request request = flat_world();
    request.random = RandomStream(seed);
    request.budget.max_iterations = seed == 1 ? 5000 : ~std::uint64_t{0};
    const PlanResult one = plan_of(planner, settings, request);
    for (const int threads : {2, 3, 8, 100}) {
      request.threads = threads;
      EXPECT_TRUE(equal(one, plan_of(planner, settings, request))) << threads << " " << seed;
    }
  }
  // Nor does what is said of ants that never arrive depend on them.
  Request turning = flat_world();
  turning.limits.max_turn_space = radians(5);
  turning.start.velocity = {-9, 20, 0};
  const PlanResult stuck = plan_of(planner, settings, turning);
  EXPECT_NE(stuck.message.find("turn"), std::string::npos) << stuck.message;
  turning.threads = 8;
  EXPECT_TRUE(equal(stuck, plan_of(planner, settings, turning)));
}

inline void expect_anytime(const std::string& planner, const std::string& settings) {
  Request request = flat_world();
  double shortest = kInfinity;
  for (std::uint64_t steps = 500; steps <= 16'000; steps *= 2) {
    request.budget.max_iterations = steps;
    const PlanResult result = plan_of(planner, settings, request);
    const double metres = result.status == PlanStatus::solved ? length(result.route) : kInfinity;
    EXPECT_LE(metres, shortest);
    shortest = metres;
  }
  EXPECT_LT(shortest, kInfinity);
}

inline void expect_step_budgets_kept(const std::string& planner, const std::string& settings) {
  Request request = flat_world();
  const std::int64_t all = counter(plan_of(planner, settings, request), "expanded");
  for (std::int64_t steps = 0; steps <= all + 1; steps += steps < 60 ? 1 : all / 7) {
    request.budget.max_iterations = std::uint64_t(steps);
    const PlanResult result = plan_of(planner, settings, request);
    EXPECT_EQ(counter(result, "expanded"), std::min(steps, all));
    EXPECT_EQ(result.budget_hit, steps <= all);
    EXPECT_TRUE(result.status == PlanStatus::solved ? check(result.route, request).ok()
                                                    : result.status == PlanStatus::timed_out);
  }
}

/// Ants that a budget has no steps left for do not walk.
inline void expect_no_work_beyond_the_budget(const std::string& planner,
                                             const std::string& settings) {
  class Counting final : public Constraint {
   public:
    std::atomic<int>& asked;
    explicit Counting(std::atomic<int>& count) : asked(count) {}

   private:
    bool do_admits(const Motion&) const override {
      ++asked;
      return true;
    }
  };
  std::atomic<int> asked = 0;
  Request request = flat_world();
  request.constraints.push_back({"counting", std::make_shared<Counting>(asked)});
  request.budget.max_iterations = 300;
  EXPECT_EQ(counter(plan_of(planner, "ants: 20000, " + settings, request), "expanded"), 300);
  EXPECT_LE(asked, 30'000);
}

/// A metre costs ten times as much in the south as elsewhere; in the far north nothing has a cost.
struct DearSouth final : Objective {
  double do_cost(const Leg& leg, double, const Request&) const override {
    const auto [south, north] = std::minmax(leg.from.y(), leg.to.y());
    const double in_south = std::max(std::min(north, kSouth) - south, 0.0);
    const double share = north > south ? in_south / (north - south) : double(south < kSouth);
    return north > kVoid ? kInfinity : per_metre * leg.length() * (1 + 9 * share);
  }
  double do_bound(const Vec3& from, const Vec3& to, const Request&) const override {
    return per_metre * (to - from).norm();
  }
  std::string do_unit() const override { return ""; }
  static constexpr double kSouth = 100;
  static constexpr double kVoid = 370;
  double per_metre = 1;
};

/// The short way around the block is dear, the other one leads past places without a cost.
inline void expect_objective_minimised(const std::string& planner, const std::string& settings) {
  SearchProgress progress;
  double cost = 0;
  double without = 0;  // an objective
  const auto dear = std::make_shared<DearSouth>();
  const auto in_cents = std::make_shared<DearSouth>();
  in_cents->per_metre = 128;  // a power of two: sums are the same to the last bit
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Request request = flat_world();
    request.random = RandomStream(seed);
    request.budget.progress = &progress;
    const Route shortest = plan_of(planner, settings, request).route;
    request.objective = dear;
    const PlanResult result = plan_of(planner, settings, request);
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    EXPECT_TRUE(check(result.route, request).ok());
    cost += cost_of(result.route, request);
    without += cost_of(shortest, request);
    EXPECT_EQ(progress.best, cost_of(result.route, request));
    request.objective = in_cents;  // the unit of costs does not matter
    EXPECT_EQ(plan_of(planner, settings, request).route, result.route);
  }
  EXPECT_LT(cost, 0.9 * without);  // a colony may settle for the dear way
}

inline void expect_iterations_traced(const std::string& planner, const std::string& settings) {
  struct Kept : Trace {
    void add(const TraceEvent& event) override { events.push_back(event); }
    std::vector<TraceEvent> events;
  } trace;
  Request request = flat_world();
  request.trace = &trace;
  const PlanResult result = plan_of(planner, settings, request);
  std::int64_t iteration = 0;
  std::int64_t routes = 0;
  std::int64_t alive = 0;
  double best = kInfinity;
  TraceEvent before;
  for (const TraceEvent& event : trace.events) {
    if (event.kind == TraceEvent::Kind::iteration) {
      EXPECT_EQ(routes, std::min<std::int64_t>(alive, 10));
      EXPECT_EQ(event.node, ++iteration);
      EXPECT_LE(event.value, best);
      EXPECT_GE(event.mean, event.value);
      best = event.value;
      alive = event.alive;
      routes = 0;
    } else if (event.parent < 0) {
      ++routes;
      EXPECT_EQ(event.position, request.start.position);
      EXPECT_EQ(event.value, 0);
    } else {
      EXPECT_EQ(event.parent, before.node);
      EXPECT_NEAR(event.value - before.value, (event.position - before.position).norm(), 1e-9);
    }
    before = event;
  }
  EXPECT_EQ(iteration, counter(result, "iterations"));
  EXPECT_EQ(alive, counter(result, "alive"));
  EXPECT_NEAR(best, length(result.route), 1e-9);
  request.trace = nullptr;
  EXPECT_TRUE(equal(result, plan_of(planner, settings, request)));
}

/// What cells know nothing of: turns, a heading, lengths.
inline void expect_limits_hold(const std::string& planner, const std::string& settings) {
  Request request = flat_world();
  request.limits.max_turn_space = radians(50);
  request.start.velocity = {0, 20, 0};
  const double open = length(plan_of(planner, settings, request).route);
  int solved = 0;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    request.random = RandomStream(seed);
    request.limits.max_leg = seed % 2 == 0 ? kInfinity : 150;
    request.limits.max_route_length = seed < 2 ? kInfinity : 1.2 * open;
    const PlanResult result = plan_of(planner, settings, request);
    solved += result.status == PlanStatus::solved ? 1 : 0;
    const CheckResult judged = check(result.route, request);
    EXPECT_TRUE(result.route.empty() || judged.ok()) << judged.violations.front().message;
  }
  EXPECT_GE(solved, 2);
}

/// In a wind from the north-west in which courses lead 72 degrees off it at most, around a ball, of
/// which cells know nothing.
inline void expect_strong_wind_obeyed(const std::string& planner) {
  Request request = request_in(world_of({Shape{Sphere{{300, 300, 50}, 60}}}), {112.5, 487.5, 50},
                               {487.5, 112.5, 50}, {{0, 0, 50}, {600, 600, 50}});
  request.level_m = 50;
  request.vehicle.speed_mps = 10;
  request.wind.layers = {{-kInfinity, {7.4, -7.4, 0}}};
  int solved = 0;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    request.random = RandomStream(seed);
    const PlanResult result = plan_of(planner, "cell_m: [25, 25, 10]", request);
    solved += result.status == PlanStatus::solved ? 1 : 0;
    const CheckResult judged = check(result.route, request);
    EXPECT_TRUE(result.route.empty() || judged.ok()) << judged.violations.front().message;
  }
  EXPECT_GE(solved, 2);
}

inline void expect_ends_joined(const std::string& planner, const std::string& settings) {
  Request request = flat_world();
  request.goal.position += Vec3(3.1, -2.2, 0);
  const PlanResult off = plan_of(planner, settings, request);
  ASSERT_EQ(off.status, PlanStatus::solved) << off.message;
  EXPECT_TRUE(check(off.route, request).ok());
  EXPECT_EQ(off.route.back(), request.goal.position);
  // In one cell the straight leg is all there is to it.
  request.goal.position = request.start.position + Vec3(1, 1, 0);
  const PlanResult near = plan_of(planner, settings, request);
  EXPECT_EQ(near.route, (Route{request.start.position, request.goal.position}));
  request.limits.max_route_length = 1;
  EXPECT_EQ(plan_of(planner, settings, request).status, PlanStatus::no_route);
  request.limits.max_route_length = kInfinity;
  // A goal among closed cells.
  request.goal.position = {200, 200, 50};
  EXPECT_NE(plan_of(planner, settings, request).status, PlanStatus::solved);
}

/// With pheromone that all but vanishes, or never does, ants still choose: none is stuck for want
/// of a weight above 0.
inline void expect_roulettes_sound(const std::string& planner, const std::string& settings) {
  Request request = flat_world();
  request.world = std::make_shared<const World>();
  for (const std::string powers :
       {"alpha: 6, beta: 3, evaporation: 0.6", "alpha: 20, beta: 20, evaporation: 0.99",
        "alpha: 6, beta: 3, evaporation: 1", "alpha: 1.5, beta: 2.5, evaporation: 0",
        "alpha: 0, beta: 3, evaporation: 0.5", "alpha: 6, beta: 3, deposit_q: 1.0e+9",
        "alpha: 20, beta: 3, deposit_q: 1.0e-9, initial_pheromone: 1.0e+9"}) {
    const PlanResult result = plan_of(planner, settings + ", " + powers, request);
    EXPECT_EQ(result.status, PlanStatus::solved) << powers;
    EXPECT_GT(counter(result, "alive"), 0) << powers << ": " << result.message;
    EXPECT_GE(length(result.route), 350 - 1e-9);
  }
}
}  // namespace altiplan::testing
