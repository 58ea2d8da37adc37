// SPDX-License-Identifier: Apache-2.0
// Searches of lattices for an aeroplane in wind, against Dijkstra's algorithm over every leg
// between neighbouring cells that the judge passes.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <map>
#include <queue>

#include "altiplan/check.hpp"
#include "support/support.hpp"

namespace altiplan::wind_searches_test {
namespace {

constexpr std::array<int, 3> kCounts{10, 8, 6};
constexpr double kCell = 40;
constexpr double kHeight = 7;  // atan(7 / 40) is 9.9 degrees

Vec3 centre(const Cell& c) {
  return {kCell * (c[0] + 0.5), kCell * (c[1] + 0.5), kHeight * (c[2] + 0.5)};
}

Vec3 random_wind(SplitMix64& random, double fastest) {
  return fastest * random.uniform() * unit_heading(2 * kPi * random.uniform());
}

/// Of one wind, of layers, of cells, or of layers of cells, where some cells are too windy.
Wind some_wind(SplitMix64& random, int kind) {
  Wind wind;
  const int layers = kind % 2 == 0 ? 1 : random.integer(2, 3);
  for (int n = 0; n < layers; ++n) {
    Wind::Layer layer{n == 0 ? -kInfinity : 15.0 * n, random_wind(random, 15)};
    if (kind >= 2) {
      std::vector<std::array<float, 2>> cells;
      for (int cell = 0; cell < 12; ++cell) {
        const Vec3 here = random_wind(random, 24);
        cells.push_back({float(here.x()), float(here.y())});
      }
      layer.grid = std::make_shared<WindGrid>(std::array<double, 2>{-30, -10},
                                              std::array<double, 2>{130, 110},
                                              std::array<int, 2>{4, 3}, std::move(cells));
    }
    wind.layers.push_back(std::move(layer));
  }
  return wind;
}

Request random_request(SplitMix64& random, int number) {
  std::vector<Shape> balls;
  for (int n = random.integer(0, 4); n > 0; --n) {
    balls.emplace_back(
        Sphere{{400 * random.uniform(), 320 * random.uniform(), 42 * random.uniform()},
               20 + 40 * random.uniform()});
  }
  const auto place = [&] {
    return centre({random.integer(0, kCounts[0] - 1), random.integer(0, kCounts[1] - 1),
                   random.integer(0, kCounts[2] - 1)});
  };
  const Vec3 start = place();
  Request request =
      testing::request_in(testing::world_of(std::move(balls)), start, place(),
                          {{0, 0, 0}, {kCell * kCounts[0], kCell * kCounts[1], 6 * kHeight}});
  request.vehicle.radius_m = 1;
  request.vehicle.wing = Wing{.airspeed_mps = 20};
  request.limits.max_climb = radians(10);
  request.wind = some_wind(random, number % 4);
  if (number % 5 == 0) {  // in still air, or in one wind, up but not down, or the reverse
    request.limits.max_climb = radians(number % 2 == 0 ? 10 : 8);
    request.limits.max_sink = radians(number % 2 == 0 ? 8 : 10);
    request.wind = number % 3 == 0 ? some_wind(random, 0) : Wind{};
  }
  return request;
}

/// Length of the shortest path; infinite if there is none.
double dijkstra(const Request& request) {
  const auto at = [](const Vec3& p) {
    return Cell{int(p.x() / kCell), int(p.y() / kCell), int(p.z() / kHeight)};
  };
  std::map<Cell, double> known;
  using Entry = std::pair<double, Cell>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const Cell goal = at(request.goal.position);
  known[at(request.start.position)] = 0;
  open.push({0, at(request.start.position)});
  while (!open.empty()) {
    const auto [length, c] = open.top();
    open.pop();
    if (c == goal) {
      return length;
    }
    for (int d = 0; d < 27 && length == known[c]; ++d) {
      const Cell to{c[0] + d % 3 - 1, c[1] + d / 3 % 3 - 1, c[2] + d / 9 - 1};
      const double there = length + (centre(to) - centre(c)).norm();
      const auto found = known.find(to);
      if (to != c && (found == known.end() || there < found->second) &&
          leg_ok(std::nullopt, centre(c), centre(to), request)) {
        known[to] = there;
        open.push({there, to});
      }
    }
  }
  return kInfinity;
}

const std::string kCells = "cell_m: [40, 40, 7]";

TEST(WindSearches, AstarFindsTheShortestRouteThatTheJudgePasses) {
  SplitMix64 random(23);
  int solved = 0;
  int climbs = 0;
  int none = 0;
  for (int n = 0; n < 400; ++n) {
    const Request request = random_request(random, n);
    if (impossible_ends(request) || request.start.position == request.goal.position) {
      continue;
    }
    const double shortest = dijkstra(request);
    for (const char* planner : {"astar", "bidirectional_astar", "dstar_lite"}) {
      const PlanResult result =
          testing::make_planner(planner, "{" + kCells + ", corner: any}")->plan(request);
      if (shortest == kInfinity) {
        EXPECT_EQ(result.status, PlanStatus::no_route) << planner << " " << n;
        ++none;
        continue;
      }
      ASSERT_EQ(result.status, PlanStatus::solved) << planner << " " << n << " " << result.message;
      const CheckResult judged = check(result.route, request);
      EXPECT_TRUE(judged.ok()) << planner << " " << n << " " << judged.violations.front().message;
      EXPECT_NEAR(length(result.route), shortest, 1e-5 * shortest) << planner << " " << n;
      ++solved;
      climbs += request.start.position.z() != request.goal.position.z() ? 1 : 0;
    }
  }
  EXPECT_GT(solved, 300);
  EXPECT_GT(climbs, 200);
  EXPECT_GT(none, 10);
}

TEST(WindSearches, NoSearchHasARouteThatTheJudgeRejects) {
  SplitMix64 random(29);
  std::map<std::string, int> solved;
  for (int n = 0; n < 100; ++n) {
    const Request request = random_request(random, n);
    if (impossible_ends(request)) {
      continue;
    }
    for (const char* planner : {"astar", "bidirectional_astar", "theta_star", "lazy_theta_star",
                                "dstar_lite", "stratified_theta"}) {
      const bool is_search = std::string(planner).find("theta") == std::string::npos;
      const PlanResult result =
          testing::make_planner(planner, "{" + kCells + (is_search ? ", moves: cells" : "") + "}")
              ->plan(request);
      if (result.status == PlanStatus::solved) {
        ++solved[planner];
        const CheckResult judged = check(result.route, request);
        EXPECT_TRUE(judged.ok()) << planner << " " << n << " " << judged.violations.front().message;
      }
    }
  }
  EXPECT_EQ(solved.size(), 6U);
  for (const auto& [planner, count] : solved) {
    EXPECT_GT(count, 20) << planner;
  }
}
}  // namespace
}  // namespace altiplan::wind_searches_test
