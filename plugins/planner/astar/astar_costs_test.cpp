// SPDX-License-Identifier: Apache-2.0
// The multi-term cost compared with a Dijkstra search written for it, and the anytime search.
#include <gtest/gtest.h>

#include <queue>

#include "support/support.hpp"

namespace altiplan::astar_costs_test {
namespace {

constexpr const char* kPlanners[] = {"astar", "bidirectional_astar"};

std::int64_t expanded(const PlanResult& result) { return result.counters.front().value; }

/// 8 × 7 × 5 cells of 10 m with balls in them, which are also the threats.
Request among_balls(SplitMix64& random) {
  std::vector<Shape> balls;
  for (int i = 0; i < 5; ++i) {
    balls.emplace_back(
        Sphere{{random.uniform() * 80, random.uniform() * 70, random.uniform() * 50}, 8});
  }
  return testing::request_in(testing::world_of(std::move(balls)), {5, 5, 5}, {75, 65, 45},
                             {{0, 0, 0}, {80, 70, 50}});
}

struct Weights {
  double length, altitude, threat;
};

/// w_L L + w_C ∫ altitude + w_T ∫ 10 Σ 1 / distance, in units of 10 m, by the trapezoidal rule.
double cost(const Request& request, const Vec3& a, const Vec3& b, const Weights& w) {
  constexpr int kParts = 24;
  const std::vector<Threat> threats = request.world->threats();
  double sum = 0;
  for (int part = 0; part <= kParts; ++part) {
    const Vec3 p = a + (b - a) * part / kParts;
    double threat = 0;
    for (const Threat& one : threats) {
      threat += 10 * 10 / std::hypot(p.x() - one.centre.x(), p.y() - one.centre.y(), 1.0);
    }
    const double share = part == 0 || part == kParts ? 0.5 : 1;
    sum += share * (w.length + w.altitude * p.z() / 10 + w.threat * threat) / kParts;
  }
  return sum * (b - a).norm();
}

double cost(const Request& request, const Route& route, const Weights& weights) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    sum += cost(request, route[i], route[i + 1], weights);
  }
  return sum;
}

/// Minimum cost of a path over the cells, by Dijkstra's algorithm; infinite if there is none.
double min_cost(const Request& request, const Weights& weights) {
  const auto at = [](int node) {
    return Vec3(5 + 10 * (node % 8), 5 + 10 * (node / 8 % 7), 5 + 10.0 * (node / 56));
  };
  std::vector<double> best(8 * 7 * 5, kInfinity);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  queue.emplace(0, 0);
  best[0] = 0;
  while (!queue.empty()) {
    const auto [g, node] = queue.top();
    queue.pop();
    if (g > best[std::size_t(node)]) {
      continue;
    }
    for (int next = 0; next < int(best.size()); ++next) {
      if (next == node || (at(next) - at(node)).cwiseAbs().maxCoeff() > 11 ||
          !leg_ok(std::nullopt, at(node), at(next), request)) {
        continue;
      }
      const double way = g + cost(request, at(node), at(next), weights);
      if (way < best[std::size_t(next)]) {
        best[std::size_t(next)] = way;
        queue.emplace(way, next);
      }
    }
  }
  return best.back();
}

TEST(AStarCosts, SummedCostsEqualDijkstra) {
  SplitMix64 random(1);
  const Weights kinds[] = {{1, 0.5, 0}, {1, 0, 0.3}, {0.2, 0.1, 0.7}, {0, 1, 1}};
  int solved = 0;
  int longer = 0;
  for (int world = 0; world < 16; ++world) {
    const Request request = among_balls(random);
    if (!point_problem(request.goal.position, request).empty() ||
        !point_problem(request.start.position, request).empty()) {
      continue;
    }
    const Weights& w = kinds[world % 4];
    const double expected = min_cost(request, w);
    const std::string yaml =
        "{cell_m: [10, 10, 10], length_unit_m: 10, weight_length: " + std::to_string(w.length) +
        ", weight_altitude: " + std::to_string(w.altitude) +
        ", weight_threat: " + std::to_string(w.threat) + "}";
    const double shortest =
        length(testing::make_planner("astar", "{cell_m: [10, 10, 10]}")->plan(request).route);
    for (const char* name : kPlanners) {
      const PlanResult result = testing::make_planner(name, yaml)->plan(request);
      ASSERT_EQ(result.status == PlanStatus::solved, expected < kInfinity)
          << name << result.message;
      if (expected < kInfinity) {
        ++solved;
        // The oracle's sum is not exact: near a centre the trapezoids are coarse.
        EXPECT_NEAR(cost(request, result.route, w), expected, 2e-3 * expected) << name << yaml;
        longer += length(result.route) > shortest + 1;
      }
    }
  }
  EXPECT_GT(solved, 10);
  EXPECT_GT(longer, 5);
}

/// Two paths of equal length around a wall; a threat lies beside the eastern one.
TEST(AStarCosts, ValuesAtAPlaceOrderTheSearchAndChooseNoWay) {
  Request request =
      testing::request_in(testing::world_of({BoxShape{{{-15, 15, -10}, {15, 35, 10}}},
                                             Cylinder{60, 25, 5, -kInfinity, kInfinity}}),
                          {0, 0, 0}, {0, 50, 0}, {{-100, -20, 0}, {100, 70, 0}});
  request.level_m = 0;
  const auto plan = [&](const std::string& more) {
    return testing::make_planner("astar", "{cell_m: [10, 10, 10], heuristic: zero, " + more + "}")
        ->plan(request);
  };
  const auto east = [](const PlanResult& result) {
    double sum = 0;
    for (const Vec3& p : result.route) {
      sum += p.x();
    }
    return sum;
  };
  const PlanResult plain = plan("weight_threat: 0");
  const PlanResult summed = plan("weight_threat: 1, length_unit_m: 10");
  const PlanResult values = plan("weight_threat: 1, length_unit_m: 10, accumulate: none");
  ASSERT_EQ(plain.status, PlanStatus::solved);
  EXPECT_LT(east(summed), 0);
  // As published, the cost of the path there does not count, so the route is as short as without
  // threats; it leads west because cells there come first.
  EXPECT_NEAR(length(values.route), length(plain.route), 1e-9);
  EXPECT_LT(east(values), 0);
  EXPECT_FALSE(testing::make_planner("astar", "{weight_threat: 1}")->traits().optimal);
}

/// By hand: a row of three cells at heights 0; f of a cell is its length plus its altitude.
TEST(AStarCosts, EvaluationByHand) {
  struct Kept final : Trace {
    std::vector<TraceEvent> events;
    void add(const TraceEvent& event) override { events.push_back(event); }
  } trace;
  Request request =
      testing::request_in(World(), {0, 0, 2000}, {2000, 0, 2000}, {{0, 0, 2000}, {2000, 0, 2000}});
  request.trace = &trace;
  const auto planner = testing::make_planner(
      "astar",
      "{cell_m: [1000, 1000, 1000], weight_g: 0.6, weight_h: 0.4, weight_length: 0.5, "
      "weight_altitude: 0.3, accumulate: none}");
  ASSERT_EQ(planner->plan(request).status, PlanStatus::solved);
  ASSERT_EQ(trace.events.size(), 3u);
  // 0.6 (0.5 L + 0.3 · 2 km) + 0.4 · 0.5 · (2 km - L)
  EXPECT_NEAR(trace.events[0].value, 1000 * (0.6 * 0.6 + 0.4), 1e-9);
  EXPECT_NEAR(trace.events[1].value, 1000 * (0.6 * 1.1 + 0.2), 1e-9);
  EXPECT_NEAR(trace.events[2].value, 1000 * (0.6 * 1.6), 1e-9);
}

TEST(AStarAnytime, MoreIterationsNeverGiveALongerRouteAndAllOfThemTheShortest) {
  SplitMix64 random(3);
  int improved = 0;
  for (int world = 0; world < 12; ++world) {
    Request request = among_balls(random);
    if (!point_problem(request.goal.position, request).empty() ||
        !point_problem(request.start.position, request).empty()) {
      continue;
    }
    request.limits.max_turn_space = world % 2 == 0 ? radians(50) : kPi;
    for (const char* name : kPlanners) {
      const std::string cells = "cell_m: [5, 5, 5], state: cell_and_heading";
      const PlanResult plain = testing::make_planner(name, "{" + cells + "}")->plan(request);
      const auto planner = testing::make_planner(name, "{anytime: true, " + cells + "}");
      request.budget = {};
      const PlanResult whole = planner->plan(request);
      ASSERT_EQ(whole.status, plain.status) << whole.message;
      EXPECT_NEAR(length(whole.route), length(plain.route), 1e-9 * length(plain.route)) << name;
      EXPECT_FALSE(whole.budget_hit);
      double before = kInfinity;
      for (std::int64_t maximum = 8; maximum < 2 * expanded(whole); maximum += maximum / 2) {
        request.budget.max_iterations = std::uint64_t(maximum);
        const PlanResult result = planner->plan(request);
        EXPECT_LE(expanded(result), maximum);
        const double now = result.status == PlanStatus::solved ? length(result.route) : kInfinity;
        EXPECT_LE(now, before + 1e-9) << name << ", " << maximum << " iterations";
        improved += now < before - 1e-6 && before < kInfinity;
        before = now;
      }
      EXPECT_NEAR(before, length(plain.route), 1e-9 * before);
    }
  }
  EXPECT_GT(improved, 0);
}

TEST(AStarAnytime, ByCellsToo) {
  SplitMix64 random(4);
  for (int world = 0; world < 10; ++world) {
    std::string level(12 * 21, '.');
    for (std::size_t i = 0; i < level.size(); ++i) {
      level[i] = i % 21 == 20 ? '\n' : random.uniform() < 0.3 ? '#' : '.';
    }
    level.front() = 'S';
    level[level.size() - 2] = 'G';
    testing::Drawn drawn = testing::draw({level});
    drawn.request.level_m = 0.5;
    const PlanResult plain = testing::make_planner("astar")->plan(drawn.request);
    const auto planner = testing::make_planner("astar", "{anytime: true}");
    EXPECT_TRUE(planner->traits().anytime);
    const PlanResult whole = planner->plan(drawn.request);
    ASSERT_EQ(whole.status, plain.status);
    EXPECT_EQ(whole.proved, plain.proved);
    EXPECT_NEAR(length(whole.route), length(plain.route), 1e-9);
  }
}
}  // namespace
}  // namespace altiplan::astar_costs_test
