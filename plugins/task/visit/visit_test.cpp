// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "altiplan/flown_route.hpp"
#include "support/support.hpp"

namespace altiplan::visit_task_test {
namespace {

Request copter() {
  Request request =
      testing::request_in({}, {0, 0, 0}, {0, 0, 0}, {{-1e4, -1e4, 0}, {1e4, 1e4, 500}});
  request.vehicle.acceleration.mps2 = 2;
  request.vehicle.climb_mps = 2;  // the order depends on the direction
  request.vehicle.sink_mps = 1;
  return request;
}

std::vector<Vec3> places(std::size_t count, std::uint64_t seed) {
  RandomStream random(seed);
  std::vector<Vec3> all;
  while (all.size() < count) {
    all.push_back(random.in({{-500, -500, 20}, {500, 500, 120}}));
  }
  return all;
}

std::string parameters(const std::vector<Vec3>& stops, bool closed) {
  std::string text = "{closed: " + std::string(closed ? "true" : "false") + ", stops: [";
  for (const Vec3& p : stops) {
    text += "{at_m: [" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ", " +
            std::to_string(p.z()) + "]}, ";
  }
  return text + "]}";
}

double seconds(const std::vector<Vec3>& order, const TaskEnds& ends, bool closed) {
  Polyline flown = order;
  if (ends.start) {
    flown.insert(flown.begin(), *ends.start);
  }
  if (ends.goal || closed) {
    flown.push_back(ends.goal.value_or(flown.front()));
  }
  return flown_time(Route(flown), copter());
}

/// Of all orders.
double minimum(std::vector<Vec3> stops, const TaskEnds& ends, bool closed) {
  const auto less = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  std::sort(stops.begin(), stops.end(), less);
  double best = kInfinity;
  do {
    best = std::min(best, seconds(stops, ends, closed));
  } while (std::next_permutation(stops.begin(), stops.end(), less));
  return best;
}

TEST(Visit, FindsTheOrderThatBruteForceFinds) {
  const TaskEnds depot{Vec3(0, 0, 30), {}};
  const TaskEnds across{Vec3(-600, 0, 30), Vec3(600, 0, 30)};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const std::vector<Vec3> stops = places(seed <= 3 ? 5 : 7, seed);
    for (const bool closed : {false, true}) {
      const auto task = testing::make_task("visit", parameters(stops, closed));
      for (const TaskEnds& ends : {TaskEnds{}, depot, across}) {
        const TaskOrder order = task->order(copter(), ends);
        ASSERT_EQ(order.passes.size(), stops.size());
        EXPECT_NEAR(order.time_s, minimum(stops, ends, closed && !ends.goal), 1e-4);
        EXPECT_NEAR(order.bound_s, order.time_s, 1e-9);
        std::vector<Vec3> flown;
        for (const Pass& pass : order.passes) {
          flown.push_back(pass.points[0]);
        }
        EXPECT_NEAR(seconds(flown, ends, closed && !ends.goal), order.time_s, 1e-9);
      }
    }
  }
}

TEST(Visit, OfManyPlacesItIsNearItsBound) {
  const auto task = testing::make_task("visit", parameters(places(60, 9), true));
  const TaskOrder order = task->order(copter(), {});
  EXPECT_EQ(order.passes.size(), 60U);
  EXPECT_LE(order.bound_s, order.time_s);
  EXPECT_GE(order.bound_s, 0.8 * order.time_s);
  Request request = copter();
  request.budget.max_iterations = 1;
  const TaskOrder first = task->order(request, {});
  EXPECT_TRUE(first.budget_hit);
  EXPECT_LE(order.time_s, first.time_s);
}
}  // namespace
}  // namespace altiplan::visit_task_test
