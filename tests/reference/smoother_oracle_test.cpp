// SPDX-License-Identifier: Apache-2.0
// Smoothers on planned routes: prune against every subset of the waypoints, and what holds for all.
#include <gtest/gtest.h>

#include "reference/isometry.hpp"

namespace altiplan::reference::smoother_oracle_test {
namespace {

struct Planned {
  std::unique_ptr<Problem> problem;
  Polyline route;
};

/// A route of astar, perhaps under limits on turns; empty where there is none.
Planned planned_route(std::uint64_t seed) {
  oracle::Draw draw(seed + 17);
  Mix mix;
  mix.max_cells = 9;
  Planned planned{random_problem(seed, mix), {}};
  Request& request = planned.problem->request;
  if (draw.below(2) == 0) {
    request.limits.max_turn_horizontal = radians(draw(60, 120));
  }
  const Vec3& c = planned.problem->lattice.cell;
  char yaml[160];
  std::snprintf(yaml, sizeof yaml, "{cell_m: [%.17g, %.17g, %.17g], neighbours: %d}", c.x(), c.y(),
                c.z(), seed % 3 == 0 ? 6 : 26);
  const PlanResult result = testing::make_planner("astar", yaml)->plan(request);
  if (result.status == PlanStatus::solved) {
    planned.route = result.route.waypoints();
  }
  return planned;
}

struct Best {
  std::size_t points = ~std::size_t{0};
  double metres = kInfinity;
};

/// The fewest waypoints, and of those choices the shortest, by trying all.
Best best_subset(const Polyline& route, const Request& request) {
  Best best;
  const std::size_t inner = route.size() - 2;
  for (std::size_t kept = 0; kept < std::size_t{1} << inner; ++kept) {
    Polyline subset = {route.front()};
    for (std::size_t i = 0; i < inner; ++i) {
      if ((kept >> i & 1) != 0) {
        subset.push_back(route[i + 1]);
      }
    }
    subset.push_back(route.back());
    const double metres = length(subset);
    const bool better =
        subset.size() < best.points || (subset.size() == best.points && metres < best.metres);
    if (better && check(subset, request).ok()) {
      best = {subset.size(), metres};
    }
  }
  return best;
}

void hold_prune(std::uint64_t from, std::uint64_t to) {
  const auto prune = testing::make_smoother("prune");
  int thinned = 0;
  int kept = 0;
  for (std::uint64_t seed = from; seed < to; ++seed) {
    const auto [problem, route] = planned_route(seed);
    if (route.size() < 3 || route.size() > 12) {
      continue;
    }
    SCOPED_TRACE(seed);
    const PlanResult result = prune->smooth(route, problem->request);
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    EXPECT_TRUE(check(result.route, problem->request).ok());
    std::size_t at = 0;
    for (const Vec3& p : result.route) {
      while (at < route.size() && route[at] != p) {
        ++at;
      }
      EXPECT_LT(at, route.size()) << "a waypoint that was not there";
    }
    const Best best = best_subset(route, problem->request);
    EXPECT_EQ(result.route.size(), best.points);
    EXPECT_NEAR(length(result.route), best.metres, 1e-9 * best.metres);
    EXPECT_LE(length(result.route), length(route) + 1e-9);
    ++(result.route.size() < route.size() ? thinned : kept);
  }
  EXPECT_GT(thinned, int(to - from) / 10);
  EXPECT_GT(kept, 5);
}
TEST(SmootherOracle, PruneIsTheBestOfAllSubsets) { hold_prune(0, 400); }
TEST(NightlySmootherOracle, PruneIsTheBestOfAllSubsets) { hold_prune(1000, 9000); }

/// Sound, the same ends, not below the straight line, and the same seen from elsewhere.
void hold_laws(const std::string& name, bool never_longer, std::uint64_t from, std::uint64_t to) {
  const auto smoother = testing::make_smoother(name);
  int smoothed = 0;
  for (std::uint64_t seed = from; seed < to; ++seed) {
    const auto [problem, route] = planned_route(seed);
    if (route.size() < 3) {
      continue;
    }
    SCOPED_TRACE(name + " " + std::to_string(seed));
    const PlanResult result = smoother->smooth(route, problem->request);
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    const auto judged = check(result.route, problem->request);
    EXPECT_TRUE(judged.ok()) << judged.violations.front().message;
    EXPECT_EQ(result.route.front(), route.front());
    EXPECT_EQ(result.route.back(), route.back());
    EXPECT_GE(length(result.route), (route.back() - route.front()).norm() * (1 - 1e-12));
    EXPECT_TRUE(!never_longer || length(result.route) <= length(route) + 1e-9);
    for (const auto& [how, by] : isometries(problem->scene.ground.has_value())) {
      SCOPED_TRACE(how);
      const Problem other = mapped(*problem, by);
      Polyline there = mapped(route, by);
      there.front() = other.request.start.position;
      if (!check(there, other.request).ok()) {
        continue;  // a limit met to the last bit, and lost by rounding
      }
      const PlanResult elsewhere = smoother->smooth(there, other.request);
      ASSERT_EQ(elsewhere.status, PlanStatus::solved) << elsewhere.message;
      EXPECT_TRUE(check(elsewhere.route, other.request).ok());
      if (never_longer) {
        EXPECT_EQ(elsewhere.route.size(), result.route.size());
        EXPECT_NEAR(length(elsewhere.route), by.scale * length(result.route),
                    1e-6 * length(elsewhere.route));
      }
    }
    smoothed += result.route != route;
  }
  EXPECT_GT(smoothed, int(to - from) / 20);
}
TEST(SmootherOracle, PruneKeepsItsLaws) { hold_laws("prune", true, 0, 150); }
TEST(SmootherOracle, BSplineKeepsItsLaws) { hold_laws("bspline", false, 0, 150); }
TEST(SmootherOracle, ShortcutKeepsItsLaws) { hold_laws("shortcut", true, 0, 150); }
TEST(SmootherOracle, TrimKeepsItsLaws) { hold_laws("trim", true, 0, 150); }
TEST(SmootherOracle, HermiteKeepsItsLaws) { hold_laws("hermite", false, 0, 150); }
TEST(NightlySmootherOracle, PruneKeepsItsLaws) { hold_laws("prune", true, 1000, 5000); }
TEST(NightlySmootherOracle, BSplineKeepsItsLaws) { hold_laws("bspline", false, 1000, 5000); }
TEST(NightlySmootherOracle, ShortcutKeepsItsLaws) { hold_laws("shortcut", true, 1000, 5000); }
TEST(NightlySmootherOracle, TrimKeepsItsLaws) { hold_laws("trim", true, 1000, 5000); }
TEST(NightlySmootherOracle, HermiteKeepsItsLaws) { hold_laws("hermite", false, 1000, 5000); }
}  // namespace
}  // namespace altiplan::reference::smoother_oracle_test
