// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <queue>
#include <set>

#include "altiplan/check.hpp"
#include "altiplan/measures.hpp"
#include "reference/level_maps.hpp"
#include "reference/paper_cities.hpp"
#include "reference/random_levels.hpp"

namespace altiplan::taut_test {
namespace {

using testing::counter;
using testing::draw;
using testing::make_planner;

std::unique_ptr<Planner> taut(const std::string& gap = "0.0001") {
  return make_planner("taut", "{cell_m: [10, 10, 10], gap: " + gap + "}");
}
double bound(const PlanResult& result) { return double(counter(result, "bound_mm")) / 1000; }

VoxelGrid cells(const Cell& counts) {
  GridSpec spec;
  spec.counts = counts;
  spec.rule = GridSpec::Rule::native;
  return VoxelGrid(spec);
}
Request between(const VoxelGrid& grid, const Vec3& start, const Vec3& goal) {
  return testing::request_in(testing::world_of(std::make_shared<kit::CellLayer>(grid)), start, goal,
                             grid.spec().box());
}

/// The shortest route that bends at places half a cell apart on the lines between cells: no route
/// is shorter by much, and the shortest is not longer. Legs are exact, and lead through free cells,
/// on their faces, edges and corners.
class SampledLines {
 public:
  SampledLines(const VoxelGrid& grid, const Vec3& start, const Vec3& goal)
      : grid_(grid), places_{start, goal} {
    const Cell& n = grid.spec().counts;
    for (int k = 2; k <= 2 * n[2] - 2; ++k) {
      for (int j = 2; j <= 2 * n[1] - 2; ++j) {
        for (int i = 2; i <= 2 * n[0] - 2; ++i) {
          if (i % 2 + j % 2 + k % 2 < 2) {
            places_.emplace_back(i / 2.0, j / 2.0, k / 2.0);
          }
        }
      }
    }
  }

  double shortest() const {
    std::vector<double> g(places_.size(), kInfinity);
    std::vector<bool> closed(places_.size());
    g[0] = 0;
    for (;;) {
      std::size_t here = places_.size();
      for (std::size_t n = 0; n < places_.size(); ++n) {
        if (!closed[n] && g[n] < kInfinity && (here == places_.size() || g[n] < g[here])) {
          here = n;
        }
      }
      if (here == places_.size() || here == 1) {
        return g[1];
      }
      closed[here] = true;
      for (std::size_t n = 0; n < places_.size(); ++n) {
        const double through = g[here] + (places_[n] - places_[here]).norm();
        if (through < g[n] && is_free(places_[here], places_[n])) {
          g[n] = through;
        }
      }
    }
  }

 private:
  bool is_free(const Vec3& a, const Vec3& b) const {
    std::set<double> crossed{0, 1};
    for (int axis = 0; axis < 3; ++axis) {
      for (double at = std::ceil(std::min(a[axis], b[axis]));
           at <= std::max(a[axis], b[axis]) && a[axis] != b[axis]; ++at) {
        crossed.insert((at - a[axis]) / (b[axis] - a[axis]));
      }
    }
    for (auto next = std::next(crossed.begin()); next != crossed.end(); ++next) {
      if (const double before = *std::prev(next);
          *next - before > 1e-9 && !is_free(Vec3(a + (before + *next) / 2 * (b - a)))) {
        return false;
      }
    }
    return true;
  }
  /// True if one of the cells that the place lies in or touches is free.
  bool is_free(const Vec3& p) const {
    const auto first = [&](int axis) { return int(std::floor(p[axis] - 1e-7)); };
    const auto last = [&](int axis) { return int(std::floor(p[axis] + 1e-7)); };
    for (int k = first(2); k <= last(2); ++k) {
      for (int j = first(1); j <= last(1); ++j) {
        for (int i = first(0); i <= last(0); ++i) {
          if (!grid_.blocked(i, j, k)) {
            return true;
          }
        }
      }
    }
    return false;
  }

  const VoxelGrid& grid_;
  std::vector<Vec3> places_;
};

/// Holds the plan between two centres to the reference.
void expect_shortest(const VoxelGrid& grid, const Cell& start, const Cell& goal, int& planned,
                     double& above) {
  const Request request = between(grid, grid.spec().centre(start), grid.spec().centre(goal));
  const PlanResult result = taut()->plan(request);
  if (result.status != PlanStatus::solved) {
    return;
  }
  EXPECT_TRUE(check(result.route, request).ok());
  const double reference =
      SampledLines(grid, request.start.position, request.goal.position).shortest();
  ++planned;
  EXPECT_LE(bound(result), reference + 1e-6);
  EXPECT_LE(bound(result), length(result.route) + 1e-6);
  EXPECT_LE(length(result.route), reference * 1.0001 + 1e-6);
  above += length(result.route) / bound(result) - 1;
}

TEST(Taut, NoRouteIsShorterThanTheBoundInRandomCells) {
  SplitMix64 random(1);
  int planned = 0;
  double above = 0;
  for (int map = 0; map < 120; ++map) {
    SCOPED_TRACE(map);
    VoxelGrid grid = cells({4, 4, 4});
    const double density = 0.1 + 0.1 * (map % 4);
    for (int n = 0; n < 64; ++n) {
      grid.set({n % 4, n / 4 % 4, n / 16}, random.uniform() < density);
    }
    const Cell start{0, random.integer(0, 3), random.integer(0, 3)};
    const Cell goal{3, random.integer(0, 3), random.integer(0, 3)};
    grid.set(start, false);
    grid.set(goal, false);
    expect_shortest(grid, start, goal, planned, above);
  }
  EXPECT_GT(planned, 90);
  EXPECT_LT(above / planned, 2e-4);
}

TEST(Taut, NoRouteIsShorterThanTheBoundAroundEveryCorner) {
  SplitMix64 random(2);
  int planned = 0;
  double above = 0;
  for (unsigned corner = 0; corner < 255; ++corner) {
    SCOPED_TRACE(corner);
    VoxelGrid grid = cells({4, 4, 4});
    std::vector<Cell> free;
    for (int n = 0; n < 64; ++n) {
      const Cell c{n % 4, n / 4 % 4, n / 16};
      const bool is_closed = (corner >> (c[0] / 2 + 2 * (c[1] / 2) + 4 * (c[2] / 2)) & 1) != 0;
      grid.set(c, is_closed);
      if (!is_closed) {
        free.push_back(c);
      }
    }
    const auto any = [&] { return free[std::size_t(random.integer(0, int(free.size()) - 1))]; };
    expect_shortest(grid, any(), any(), planned, above);
  }
  EXPECT_GT(planned, 200);
  EXPECT_LT(above / planned, 2e-4);
}

/// Two free cells that meet in a corner alone: the route bends there, where no edge is.
TEST(Taut, NoRouteIsShorterThanTheBoundThroughACorner) {
  VoxelGrid grid = cells({4, 4, 4});
  for (int n = 1; n < 7; ++n) {
    grid.set({1 + n % 2, 1 + n / 2 % 2, 1 + n / 4}, true);
  }
  int planned = 0;
  double above = 0;
  expect_shortest(grid, {1, 1, 1}, {3, 2, 2}, planned, above);
  EXPECT_EQ(planned, 1);
  EXPECT_LT(above, 2e-4);
}

/// Over the roof of a box: its faces unfolded into a plane, the route is straight.
TEST(Taut, TheShortestOverOneBox) {
  VoxelGrid grid = cells({24, 40, 20});
  for (int k = 0; k < 12; ++k) {
    for (int j = 0; j < 40; ++j) {
      grid.block_run(8, 15, j, k);
    }
  }
  const Vec3 start(2.5, 3.5, 4.5);
  const Vec3 goal(20.5, 33.5, 1.5);
  const Request request = between(grid, start, goal);
  const PlanResult result = taut("1.0e-6")->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  const double up = std::hypot(8 - start.x(), 12 - start.z());
  const double down = std::hypot(goal.x() - 16, 12 - goal.z());
  const double exact = std::hypot(up + 8 + down, goal.y() - start.y());
  EXPECT_LE(bound(result), exact);
  EXPECT_GE(bound(result), exact * (1 - 2e-6) - 1e-3);
  EXPECT_NEAR(length(result.route), exact, exact * 1e-6);
  EXPECT_EQ(result.route.size(), 4u);
}

/// On a level anya's routes are the shortest of all.
TEST(Taut, AsLongAsThoseOfAnyaOnALevel) {
  SplitMix64 random(3);
  const auto anya = make_planner("anya");
  int planned = 0;
  for (int map = 0; map < 60; ++map) {
    SCOPED_TRACE(map);
    Request request =
        draw(testing::random_levels(random, 40, 30, 1, 0.05 + 0.05 * (map % 6))).request;
    request.level_m = 0.5;
    const PlanResult result = taut()->plan(request);
    if (result.status == PlanStatus::solved) {
      const double exact = length(anya->plan(request).route);
      EXPECT_TRUE(check(result.route, request).ok());
      EXPECT_NEAR(bound(result), exact, 2e-3);
      EXPECT_NEAR(length(result.route), exact, 2e-3);
      ++planned;
    }
  }
  EXPECT_GT(planned, 40);
}

/// What the gap of a route by theta_star is: it stays half a cell off all edges.
TEST(Taut, TheBoundHoldsInThePapersCities) {
  const auto theta_star = make_planner("theta_star");
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    const Request request = testing::in_city(true, seed);
    const PlanResult result = taut("0.005")->plan(request);
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    EXPECT_TRUE(check(result.route, request).ok());
    EXPECT_LE(length(result.route), bound(result) * 1.005);
    EXPECT_LE(length(result.route), length(theta_star->plan(request).route));
    const PlanResult closer = taut("0.0001")->plan(request);
    EXPECT_LE(bound(result), length(closer.route));
    EXPECT_LE(length(closer.route), length(result.route));
    EXPECT_LE(length(closer.route), bound(closer) * 1.0001 + 1e-3);
  }
}

TEST(Taut, WithoutTimeTheBoundIsTheStraightLine) {
  Request request = testing::in_city(true, 5);
  const PlanResult whole = taut()->plan(request);
  request.budget.max_iterations =
      std::uint64_t(counter(make_planner("lazy_theta_star")->plan(request), "expanded")) + 10;
  const PlanResult part = taut()->plan(request);
  ASSERT_EQ(part.status, PlanStatus::solved) << part.message;
  EXPECT_TRUE(part.budget_hit);
  EXPECT_FALSE(whole.budget_hit);
  EXPECT_GE(length(part.route), length(whole.route));
  const double straight = (request.goal.position - request.start.position).norm();
  EXPECT_NEAR(bound(part), straight, 1e-2);
}

TEST(Taut, RefusesWhatCellsDoNotDecide) {
  Request request = draw({"S..G"}).request;
  request.limits.max_climb = radians(30);
  const PlanResult result = taut()->plan(request);
  EXPECT_EQ(result.status, PlanStatus::invalid_problem);
  EXPECT_EQ(result.message, "taut cannot satisfy a limit on climb: use theta_star");
}
}  // namespace
}  // namespace altiplan::taut_test
