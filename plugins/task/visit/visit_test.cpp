// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "altiplan/flown_route.hpp"
#include "support/posts.hpp"
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

/// Places at which something is done, over ground that slopes up to the east.
struct Errands {
  std::vector<Vec3> at;
  std::vector<Stop> stops;
  World world = testing::world_of(std::make_shared<testing::Posts>(
      HeightField({-1000, -1000}, {2000, 2000}, 2, 2, {0, 20, 0, 20})));

  Errands(std::size_t count, std::uint64_t seed) : at(places(count, seed)) {
    for (std::size_t i = 0; i < count; ++i) {
      stops.push_back({i % 3 == 2 ? 0 : 5.0 + double(i), i % 2 == 1, i % 5 == 4});
    }
  }
  Request request() const {
    Request request = copter();
    request.world = std::make_shared<const World>(world);
    return request;
  }
  std::unique_ptr<Task> task(bool closed) const {
    std::string text = "{closed: " + std::string(closed ? "true" : "false") + ", stops: [";
    for (std::size_t i = 0; i < at.size(); ++i) {
      text += "{at_m: [" + std::to_string(at[i].x()) + ", " + std::to_string(at[i].y()) + ", " +
              std::to_string(at[i].z()) + "], hold_s: " + std::to_string(stops[i].hold_s) +
              ", land: " + (stops[i].lands ? "true" : "false") +
              ", drop: " + (stops[i].drops ? "true" : "false") + "}, ";
    }
    return testing::make_task("visit", text + "]}", world);
  }
  /// Of a landing with the ways down and up by hand.
  double seconds(std::size_t i) const {
    const double wait_s = stops[i].drops ? std::max(1.0, stops[i].hold_s) : stops[i].hold_s;
    const Vec3 foot(at[i].x(), at[i].y(), (at[i].x() + 1000) / 100);
    return wait_s + (stops[i].lands ? flown_time(Route{at[i], foot}, copter()) +
                                          flown_time(Route{foot, at[i]}, copter())
                                    : 0);
  }
  double sum() const {
    double sum = 0;
    for (std::size_t i = 0; i < at.size(); ++i) {
      sum += seconds(i);
    }
    return sum;
  }
};

TEST(Visit, WithStopsFindsTheOrderThatBruteForceFinds) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Errands errands(5, seed);
    for (const bool closed : {false, true}) {
      for (const TaskEnds& ends : {TaskEnds{}, TaskEnds{Vec3(0, 0, 30), {}}}) {
        const TaskOrder order = errands.task(closed)->order(errands.request(), ends);
        EXPECT_NEAR(order.time_s, minimum(errands.at, ends, closed) + errands.sum(), 1e-3);
        EXPECT_NEAR(order.bound_s, order.time_s, 1e-9);
        ASSERT_EQ(order.passes.size(), 5U);
        for (const Pass& pass : order.passes) {
          const auto found = std::find_if(errands.at.begin(), errands.at.end(), [&](const Vec3& p) {
            return (p - pass.points[0]).norm() < 1e-5;
          });
          ASSERT_NE(found, errands.at.end());
          const auto i = std::size_t(found - errands.at.begin());
          EXPECT_EQ(pass.stop.lands, errands.stops[i].lands);
          EXPECT_EQ(pass.stop.drops, errands.stops[i].drops);
          EXPECT_NEAR(pass.stop.seconds(pass.points[0], errands.request()), errands.seconds(i),
                      1e-4);
        }
        EXPECT_NEAR(flown_time(order.route(ends, errands.request()), errands.request()),
                    order.time_s, 1e-9);
      }
    }
  }
}

TEST(Visit, StopsAddToTimeAndBoundWhatTheyTake) {
  const Errands errands(30, 11);
  const TaskOrder with = errands.task(true)->order(errands.request(), {});
  const TaskOrder without =
      testing::make_task("visit", parameters(errands.at, true))->order(errands.request(), {});
  EXPECT_NEAR(with.time_s, without.time_s + errands.sum(), 1e-3);
  EXPECT_NEAR(with.bound_s, without.bound_s + errands.sum(), 1e-3);
}

TEST(Visit, RefusesStopsThatCannotBe) {
  const auto refused = [](const std::string& stops, bool has_wing) {
    World world;
    try {
      auto task = testing::make_task("visit", "{stops: [" + stops + "]}", world);
      Request request = copter();
      if (has_wing) {
        request.vehicle.wing.emplace();
      }
      task->order(request, {});
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string place = "{at_m: [0, 0, 50]";
  EXPECT_EQ(refused(place + ", hold_s: 3}", false), "");
  EXPECT_NE(refused(place + ", land: true}", false).find("no ground is known"), std::string::npos);
  EXPECT_NE(refused(place + "}, " + place + ", drop: true}", false).find("that of stop 0"),
            std::string::npos);
  EXPECT_NE(refused(place + ", hold_s: 3}", true).find("an aeroplane stops"), std::string::npos);
  EXPECT_NE(testing::parameter_problems("task", "visit", "{stops: [" + place + ", hold_s: -1}]}"),
            "");
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
