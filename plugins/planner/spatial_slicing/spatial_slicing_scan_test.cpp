// SPDX-License-Identifier: Apache-2.0
// The choice of points compared with one that examines every cell of a plane.
#include <gtest/gtest.h>

#include <algorithm>

#include "altiplan/kit/lattice/line_of_sight.hpp"
#include "altiplan/kit/lattice/move_rules.hpp"
#include "support/support.hpp"

namespace altiplan::spatial_slicing_scan_test {
namespace {

/// A world of boxes of cells, or of balls that do not align with cells.
Request drawn_world(SplitMix64& random, bool cells, bool is_level) {
  const int size[3] = {16, 14, is_level ? 1 : 9};
  std::vector<std::string> levels(is_level ? 1 : 9);
  std::vector<Shape> balls;
  for (std::string& rows : levels) {
    for (int row = 0; row < size[1]; ++row) {
      for (int i = 0; i < size[0]; ++i) {
        const bool blocked = random.uniform() < (is_level ? 0.1 : 0.2);
        rows += blocked ? '#' : '.';
      }
      rows += '\n';
    }
  }
  for (int n = 0; n < 12; ++n) {
    const double x = random.uniform() * size[0];
    const double y = random.uniform() * size[1];
    const double z = random.uniform() * size[2];
    balls.emplace_back(Sphere{{x, y, z}, 1.2});
  }
  Request request = testing::draw(levels).request;
  if (!cells) {
    request.world = std::make_shared<const World>(testing::world_of(std::move(balls)));
    request.vehicle.radius_m = request.limits.min_clearance = 0.1;
  }
  const auto place = [&](double x) {
    const double y = random.uniform() * size[1];
    return Vec3(x, y, is_level ? 0.5 : random.uniform() * size[2]);
  };
  request.start.position = place(0.5);
  request.goal.position = place(15.2);
  if (is_level) {
    request.level_m = 0.5;
  }
  return request;
}

/// The same with the judge's own checks and a scan of every cell of a plane; empty if a plane has
/// no point. With a waypoint on every plane.
Polyline full_scan(const Request& request, int axis, int apart) {
  const kit::Lattice lattice(request, {1, 1, 1}, kit::Neighbourhood::all, {});
  const auto grid = kit::occupancy(request, lattice);
  const Vec3& goal = request.goal.position;
  const int ahead = goal[axis] < request.start.position[axis] ? -1 : 1;
  const int cells = lattice.spec().counts[std::size_t(axis)];
  std::vector<double> planes;
  int passed = 0;
  for (int n = 0; n < cells; ++n) {
    const int cell = ahead > 0 ? n : cells - 1 - n;
    const double at = lattice.spec().origin[axis] + cell + 0.5;
    if ((at - request.start.position[axis]) * ahead > 1e-6 && (goal[axis] - at) * ahead > 1e-6 &&
        ++passed % apart == 0) {
      planes.push_back(at);
    }
  }
  const auto is_centre = [&](const Vec3& p) { return lattice.nearest(p).length == 0; };
  const auto in_sight = [&](const Vec3& a, const Vec3& b) {
    return kit::walk_cells(lattice.nearest(a).cell, lattice.nearest(b).cell,
                           [&](const Cell& cell) { return !grid->blocked(cell); });
  };
  Polyline route = {request.start.position};
  const auto on_line = [&](std::size_t i) {
    if (i >= planes.size()) {
      return goal;
    }
    const Vec3 way = goal - route.back();
    Vec3 p = route.back() + (planes[i] - route.back()[axis]) / way[axis] * way;
    p[axis] = planes[i];
    return p;
  };
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const auto before = approach(route, i, request.before_start());
    const auto free = [&](const std::optional<Approach>& from, const Vec3& a, const Vec3& b) {
      return leg_ok(from, a, b, request) && (!is_centre(a) || !is_centre(b) || in_sight(a, b));
    };
    const auto reached = [&](const Vec3& p) {
      return free(before, route.back(), p) &&
             (i + 1 < planes.size() || free(onward(before, route.back()), p, goal));
    };
    std::optional<Vec3> best;
    double minimum = kInfinity;
    if (const Vec3 p = on_line(i); reached(p)) {
      best = p;
      minimum = 0;
    }
    for (std::uint32_t index = 0; index < lattice.size(); ++index) {
      const Vec3 p = lattice.position(lattice.cell(index));
      const double cost = (p - route.back()).norm() + (on_line(i + 1) - p).norm();
      if (std::abs(p[axis] - planes[i]) < 0.1 && cost < minimum &&
          !grid->blocked(lattice.cell(index)) && reached(p)) {
        minimum = cost;
        best = p;
      }
    }
    if (!best) {
      return {};
    }
    route.push_back(*best);
  }
  route.push_back(goal);
  return planes.empty() && !leg_ok(request.before_start(), route.front(), goal, request)
             ? Polyline()
             : route;
}

double distance_to(const Vec3& p, const Polyline& route) {
  double minimum = kInfinity;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    minimum = std::min(minimum, point_leg_distance(p, route[i], route[i + 1]));
  }
  return minimum;
}

TEST(SpatialSlicing, TakesThePointThatAFullScanOfThePlaneFindsBest) {
  SplitMix64 random(1);
  int solved = 0;
  int failed = 0;
  std::int64_t moved = 0;
  for (int n = 0; n < 400; ++n) {
    Request request = drawn_world(random, n % 2 == 0, n % 3 == 0);
    if (n % 5 == 0) {
      std::swap(request.start.position, request.goal.position);
    }
    if (n % 7 == 0) {
      request.limits.max_turn_space = radians(70);
      request.start.velocity = {1, 0.2, 0};
    }
    if (n % 11 == 0) {
      request.limits.max_climb = radians(40);
    }
    const int axis = n % 4 == 0 ? 1 : 0;
    const int apart = 1 + n % 3 / 2;
    const PlanResult result =
        testing::make_planner("spatial_slicing",
                              std::string("{cell_m: [1, 1, 1], axis: ") + "xy"[axis] +
                                  ", plane_cells: " + std::to_string(apart) + "}")
            ->plan(request);
    if (result.status == PlanStatus::invalid_problem) {  // an end in a random obstacle
      continue;
    }
    const Polyline expected = full_scan(request, axis, apart);
    ASSERT_EQ(result.status == PlanStatus::solved, !expected.empty())
        << n << ": " << result.message;
    if (expected.empty()) {
      ++failed;
      continue;
    }
    ++solved;
    moved += result.counters.back().value;  // planes_moved
    EXPECT_TRUE(check(result.route, request).ok()) << n;
    EXPECT_NEAR(length(result.route), length(expected), 1e-9) << n;
    for (const Vec3& p : expected) {
      ASSERT_LT(distance_to(p, result.route.waypoints()), 1e-6) << n;
    }
    for (std::size_t i = 0; i + 2 < result.route.size(); ++i) {
      const Route& r = result.route;
      EXPECT_GT(point_leg_distance(r[i + 1], r[i], r[i + 2]), 1e-9) << n << ": an idle waypoint";
    }
  }
  EXPECT_GT(solved, 100);
  EXPECT_GT(failed, 20);
  EXPECT_GT(moved, 100);
}

}  // namespace
}  // namespace altiplan::spatial_slicing_scan_test
