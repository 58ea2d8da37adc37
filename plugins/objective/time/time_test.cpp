// SPDX-License-Identifier: Apache-2.0
// The objective, and limits on its total: astar against an exhaustive search, written here, of the
// fronts of cost and total at every cell.
#include <gtest/gtest.h>

#include <map>

#include "altiplan/measures.hpp"
#include "altiplan/random.hpp"
#include "altiplan/total_limit.hpp"
#include "support/support.hpp"

namespace altiplan::time_objective_test {
namespace {
using testing::make_objective;

constexpr double kCell = 10;

Request empty_request() {
  Request request =
      testing::request_in({}, {0, 0, 100}, {1000, 0, 100}, {{0, 0, 0}, {1000, 1000, 400}});
  request.vehicle.speed_mps = 20;
  return request;
}

TEST(TimeObjective, IsTheFlyingTimeAboveAHeight) {
  const Request request = empty_request();
  const auto time = make_objective("time");
  const auto above = make_objective("time", "{above_m: 200}");
  const auto seconds = [&](const Objective& objective, const Vec3& a, const Vec3& b) {
    return objective.cost(Leg::straight(a, b), 0, request);
  };
  EXPECT_DOUBLE_EQ(seconds(*time, {0, 0, 100}, {300, 400, 100}), 25);
  EXPECT_DOUBLE_EQ(seconds(*above, {0, 0, 100}, {300, 400, 100}), 0);
  EXPECT_DOUBLE_EQ(seconds(*above, {0, 0, 300}, {300, 400, 300}), 25);
  EXPECT_DOUBLE_EQ(seconds(*above, {0, 0, 150}, {0, 0, 350}), 7.5);
  EXPECT_DOUBLE_EQ(seconds(*above, {0, 0, 350}, {0, 0, 150}), 7.5);
  EXPECT_EQ(seconds(*above, {0, 0, 200}, {100, 0, 200}), 0);
  EXPECT_EQ(time->unit(), "s");
}

TEST(TimeObjective, AWaitTakesItsTime) {
  const Request request = empty_request();
  EXPECT_EQ(make_objective("time")->cost(Leg::hold({0, 0, 100}, 60), 0, request), 60);
  EXPECT_EQ(make_objective("time", "{above_m: 50}")->cost(Leg::hold({0, 0, 100}, 60), 0, request),
            60);
  EXPECT_EQ(make_objective("time", "{above_m: 200}")->cost(Leg::hold({0, 0, 100}, 60), 0, request),
            0);
}

TEST(TimeObjective, TheBoundDivesBelowTheHeight) {
  const Request request = empty_request();
  const auto above = make_objective("time", "{above_m: 200}");
  EXPECT_DOUBLE_EQ(above->bound({0, 0, 300}, {1000, 0, 400}, request), 300 / 20.0);
  EXPECT_DOUBLE_EQ(above->bound({0, 0, 300}, {40, 30, 300}, request), 50 / 20.0);
  EXPECT_EQ(above->bound({0, 0, 200}, {1000, 0, 100}, request), 0);
  EXPECT_DOUBLE_EQ(make_objective("time")->bound({0, 0, 300}, {1000, 0, 300}, request), 50);
}

TEST(TimeObjective, WindDoesNotChangeThatOfACopter) {
  Request request = empty_request();
  const Request calm = request;
  request.wind.layers = {{-kInfinity, {5, 0, 0}}};
  const Leg leg = Leg::straight({0, 0, 100}, {500, 0, 300});
  const auto time = make_objective("time");
  const auto above = make_objective("time", "{above_m: 200}");
  EXPECT_DOUBLE_EQ(time->cost(leg, 0, request), std::hypot(500, 200) / 20);
  EXPECT_EQ(time->cost(leg, 0, request), time->cost(leg, 0, calm));
  EXPECT_EQ(above->cost(leg, 0, request), above->cost(leg, 0, calm));
  EXPECT_EQ(time->bound(leg.from, leg.to, request), time->bound(leg.from, leg.to, calm));
}

using Key = std::array<int, 3>;
constexpr Key kCells{7, 5, 4};

Vec3 place(const Key& k) {
  return {kCell * (k[0] + 0.5), kCell * (k[1] + 0.5), kCell * (k[2] + 0.5)};
}
Key key(const Vec3& p) { return {int(p.x() / kCell), int(p.y() / kCell), int(p.z() / kCell)}; }

/// Cost and total of a path.
using Ends = std::pair<double, double>;

/// Adds what none is at least as good as, up to rounding; true if it was added.
bool add(std::vector<Ends>& front, const Ends& path) {
  for (const auto& [cost, total] : front) {
    if (!costs_more(cost, path.first) && !costs_more(total, path.second)) {
      return false;
    }
  }
  front.push_back(path);
  return true;
}

/// Costs and totals of the paths to the goal of which none is better in both: the front of every
/// cell is joined with those of its neighbours until nothing changes.
std::vector<Ends> exhaustive(const Request& request, const Objective& of) {
  struct Edge {
    Key from, to;
    Ends ends;
  };
  std::vector<Edge> edges;
  for (int n = 0; n < kCells[0] * kCells[1] * kCells[2]; ++n) {
    const Key from{n % kCells[0], n / kCells[0] % kCells[1], n / kCells[0] / kCells[1]};
    for (int d = 0; d < 27; ++d) {
      const Key to{from[0] + d % 3 - 1, from[1] + d / 3 % 3 - 1, from[2] + d / 9 - 1};
      if (to == from || to[0] < 0 || to[1] < 0 || to[2] < 0 || to[0] >= kCells[0] ||
          to[1] >= kCells[1] || to[2] >= kCells[2] ||
          !leg_ok(std::nullopt, place(from), place(to), request)) {
        continue;
      }
      const Leg leg = Leg::straight(place(from), place(to));
      edges.push_back({from, to, {cost_of(leg, request), of.cost(leg, 0, request)}});
    }
  }
  std::map<Key, std::vector<Ends>> fronts;
  fronts[key(request.start.position)] = {{0, 0}};
  for (bool changes = true; changes;) {
    changes = false;
    for (const Edge& edge : edges) {
      const std::vector<Ends> before = fronts[edge.from];
      for (const auto& [cost, total] : before) {
        changes |= add(fronts[edge.to], {cost + edge.ends.first, total + edge.ends.second});
      }
    }
  }
  return fronts[key(request.goal.position)];
}

/// Among balls, high enough that going round them at the limited height costs time there.
Request random_request(SplitMix64& random, int number) {
  const auto centre = [&](int axis) {
    return kCell * (random.integer(0, kCells[std::size_t(axis)] - 1) + 0.5);
  };
  std::vector<Shape> balls;
  for (int n = random.integer(2, 8); n > 0; --n) {
    balls.emplace_back(Sphere{{70 * random.uniform(), 50 * random.uniform(), 25 * random.uniform()},
                              5 + 12 * random.uniform()});
  }
  Request request =
      testing::request_in(testing::world_of(std::move(balls)), {centre(0), centre(1), centre(2)},
                          {centre(0), centre(1), centre(2)}, {{0, 0, 0}, {70, 50, 40}});
  request.vehicle.speed_mps = 5;
  const std::shared_ptr<const Objective> all[] = {nullptr, make_objective("altitude"),
                                                  make_objective("time")};
  request.objective = all[number % 3];
  return request;
}

void hold_to_exhaustive(int first, int worlds) {
  SplitMix64 random(std::uint64_t(first) + 3);
  int kept = 0;
  int refused = 0;
  for (int world = first; world < first + worlds; ++world) {
    SCOPED_TRACE(world);
    Request request = random_request(random, world);
    if (!start_problem(request).empty() || !goal_problem(request).empty()) {
      continue;
    }
    const std::shared_ptr<const Objective> of =
        make_objective("time", world % 4 == 0 ? "{}" : "{above_m: 17}");
    const std::vector<Ends> front = exhaustive(request, *of);
    const auto planner = testing::make_planner("astar", "{cell_m: [10, 10, 10]}");
    const PlanResult without = planner->plan(request);
    if (front.empty() || without.status != PlanStatus::solved) {
      EXPECT_TRUE(front.empty() && without.status == PlanStatus::no_route);
      continue;
    }
    Request by = request;
    by.objective = of;
    const double maximum = cost_of(without.route, by) * (0.3 + 0.7 * random.uniform());
    apply_constraints(request, {{"limit", std::make_shared<TotalLimit>(of, maximum)}},
                      AppliesTo::route);
    double minimum = kInfinity;
    for (const auto& [cost, total] : front) {
      minimum = costs_more(total, maximum) ? minimum : std::min(minimum, cost);
    }
    const PlanResult result = planner->plan(request);
    if (minimum == kInfinity) {
      EXPECT_EQ(result.status, PlanStatus::no_route) << result.message;
      EXPECT_TRUE(result.proved);
      ++refused;
      continue;
    }
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    EXPECT_NEAR(cost_of(result.route, request), minimum, 1e-9 * minimum);
    EXPECT_TRUE(check(result.route, request).ok());
    // What it finds without the limit is refused by the judge alone.
    const CheckResult judged = check(without.route, request);
    EXPECT_EQ(judged.ok(), !costs_more(cost_of(without.route, by), maximum));
    if (!judged.ok()) {
      EXPECT_EQ(judged.violations.front().constraint, "limit");
      EXPECT_EQ(judged.violations.front().unit, "s");
      ++kept;
    }
  }
  EXPECT_GT(kept, worlds / 8);
  EXPECT_GT(refused, 0);
}

TEST(TotalLimit, AstarFindsTheBestThatKeepsIt) { hold_to_exhaustive(0, 24); }
TEST(NightlyTotalLimit, AstarFindsTheBestThatKeepsIt) { hold_to_exhaustive(24, 200); }

TEST(TotalLimit, AstarKeepsLimitsOnLengthUnderAnotherObjective) {
  Request request = testing::request_in({}, {5, 5, 35}, {115, 5, 35}, {{0, 0, 0}, {120, 50, 40}});
  request.objective = make_objective("altitude");
  const auto planner = testing::make_planner("astar", "{cell_m: [10, 10, 10]}");
  const double without = length(planner->plan(request).route);
  request.limits.max_route_length = 130;
  const PlanResult result = planner->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_GT(without, 130);
  EXPECT_LT(length(result.route), 130);
  EXPECT_GT(length(result.route), 115) << "lower than a straight line";
}

TEST(TotalLimit, ATurnCountsAsItIsNotAsItsChords) {
  Request request = empty_request();
  Route route(Polyline{{100, 100, 100}});
  route.push_back(Leg::turning({{100, 100, 100}, 0}, 3, 100, 0));
  const double seconds = leg_duration(route.leg(0), request);
  const auto judged = [&](double maximum) {
    return TotalLimit(make_objective("time"), maximum).violations_of(route, request).empty();
  };
  EXPECT_TRUE(judged(seconds));
  EXPECT_FALSE(judged(seconds * (1 - 1e-6)));
}
}  // namespace
}  // namespace altiplan::time_objective_test
