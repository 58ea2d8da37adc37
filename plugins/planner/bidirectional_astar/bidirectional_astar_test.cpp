// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>

#include "altiplan/error.hpp"
#include "support/support.hpp"

namespace altiplan::bidirectional_astar_test {
namespace {

using testing::make_planner;

constexpr const char* kCells = "{cell_m: [10, 10, 5]}";

Request among_balls(SplitMix64& random, int count) {
  std::vector<Shape> balls;
  for (int i = 0; i < count; ++i) {
    balls.emplace_back(
        Sphere{{random.uniform() * 100, random.uniform() * 90, random.uniform() * 40}, 12});
  }
  Request request = testing::request_in(testing::world_of(std::move(balls)), {5, 5, 5},
                                        {95, 85, 35}, {{0, 0, 0}, {100, 90, 40}});
  request.limits.min_clearance = request.vehicle.radius_m = 1.5;
  return request;
}

TEST(BidirectionalAStar, RoutesAreAsLongAsFromOneEnd) {
  SplitMix64 random(1);
  int solved = 0;
  for (int world = 0; world < 60; ++world) {
    Request request = among_balls(random, 3 + world % 25);
    if (world % 2 == 0) {
      request.goal.position = {93, 82, 33};  // not the centre of a cell
    }
    if (world % 3 == 0) {
      request.limits.max_route_length = 140;
    }
    for (const char* heuristic : {"octile", "euclidean", "zero"}) {
      const std::string yaml = std::string("{cell_m: [10, 10, 5], heuristic: ") + heuristic + "}";
      const PlanResult one_way = make_planner("astar", yaml)->plan(request);
      const PlanResult result = make_planner("bidirectional_astar", yaml)->plan(request);
      ASSERT_EQ(result.status, one_way.status) << result.message;
      EXPECT_EQ(result.proved, one_way.proved);
      if (result.status == PlanStatus::solved) {
        ++solved;
        EXPECT_NEAR(length(result.route), length(one_way.route), 1e-9 * length(result.route));
        EXPECT_TRUE(check(result.route, request).ok());
      }
    }
  }
  EXPECT_GT(solved, 60);
}

TEST(BidirectionalAStar, TurnsAreKeptAtBothEndsAndWhereTheSidesMeet) {
  SplitMix64 random(2);
  int solved = 0;
  for (int world = 0; world < 60; ++world) {
    Request request = among_balls(random, 6);
    request.limits.max_turn_space = radians(50);
    request.limits.max_climb = radians(30);
    request.start.velocity = {10, 2, 0};
    request.goal.position = {93, 82, 33};
    double by_heading = kInfinity;
    for (const char* state : {"cell_and_heading", "parent", "auto"}) {
      const std::string yaml = std::string("{cell_m: [10, 10, 5], state: ") + state + "}";
      const PlanResult result = make_planner("bidirectional_astar", yaml)->plan(request);
      if (result.status == PlanStatus::solved) {
        ++solved;
        const CheckResult judged = check(result.route, request);
        EXPECT_TRUE(judged.ok()) << judged.violations.front().message;
        EXPECT_EQ(result.route.back(), request.goal.position);
        by_heading = std::min(by_heading, length(result.route));
        EXPECT_GE(length(result.route), by_heading - 1e-9) << state;
      } else if (by_heading < kInfinity) {
        EXPECT_STREQ(state, "parent");
        EXPECT_FALSE(result.proved);
      }
    }
  }
  EXPECT_GT(solved, 60);
}

/// Allows a leg after another only if both climb, both descend or both are level.
class NoPorpoising final : public Constraint {
  bool do_admits(const Motion& leg) const override {
    return !leg.before || (leg.from.z() > leg.before->z()) == (leg.to.z() > leg.from.z());
  }
};

TEST(BidirectionalAStar, ConstraintsThatLookAtTwoLegsAreKept) {
  SplitMix64 random(3);
  int solved = 0;
  for (int world = 0; world < 30; ++world) {
    Request request = among_balls(random, 8);
    request.goal.position.z() = 5;
    request.constraints.push_back({"no_porpoising", std::make_shared<NoPorpoising>()});
    const std::string yaml = "{cell_m: [10, 10, 5], state: cell_and_heading}";
    const PlanResult result = make_planner("bidirectional_astar", yaml)->plan(request);
    const PlanResult one_way = make_planner("astar", yaml)->plan(request);
    ASSERT_EQ(result.status, one_way.status) << result.message;
    if (result.status == PlanStatus::solved) {
      ++solved;
      EXPECT_TRUE(check(result.route, request).ok());
      EXPECT_TRUE(check(one_way.route, request).ok());
      EXPECT_NEAR(length(result.route), length(one_way.route), 1e-9 * length(result.route));
    }
  }
  EXPECT_GT(solved, 8);
}

TEST(BidirectionalAStar, ReasonBudgetAndSealedGoal) {
  const auto planner = make_planner("bidirectional_astar");
  testing::Drawn sealed = testing::draw({"S....\n.....\n..###\n..#G#\n..###"});
  sealed.request.level_m = 0.5;
  const PlanResult shut = planner->plan(sealed.request);
  EXPECT_EQ(shut.status, PlanStatus::no_route);
  EXPECT_TRUE(shut.proved);
  EXPECT_NE(shut.message.find("blocked cells"), std::string::npos) << shut.message;

  SplitMix64 random(4);
  Request request = among_balls(random, 10);
  request.budget.max_iterations = 3;
  const PlanResult cut = make_planner("bidirectional_astar", kCells)->plan(request);
  EXPECT_EQ(cut.status, PlanStatus::timed_out);
  EXPECT_TRUE(cut.budget_hit);
  EXPECT_EQ(cut.counters.front().value, 3);

  request.budget = {};
  EXPECT_THROW(
      make_planner("bidirectional_astar", "{cell_m: [0.001, 0.001, 0.001]}")->plan(request),
      ParameterError);
}

TEST(BidirectionalAStar, TraceHoldsATreeForEachSide) {
  struct Kept final : Trace {
    std::vector<TraceEvent> events;
    void add(const TraceEvent& event) override { events.push_back(event); }
  } trace;
  SplitMix64 random(5);
  bool both = false;
  for (int world = 0; world < 10; ++world) {
    Request request = among_balls(random, 20);
    request.trace = &trace;
    trace.events.clear();
    const PlanResult result = make_planner("bidirectional_astar", kCells)->plan(request);
    if (result.status == PlanStatus::invalid_problem) {
      continue;
    }
    ASSERT_EQ(std::int64_t(trace.events.size()), result.counters.front().value);
    std::set<std::int64_t> expanded;
    std::set<std::int64_t> roots;
    for (const TraceEvent& event : trace.events) {
      if (event.parent >= 0) {
        EXPECT_TRUE(expanded.contains(event.parent));
        EXPECT_EQ(event.parent % 2, event.node % 2);
      } else {
        roots.insert(event.node % 2);
      }
      EXPECT_TRUE(expanded.insert(event.node).second);
    }
    both = both || roots.size() == 2;
  }
  EXPECT_TRUE(both);
}
}  // namespace
}  // namespace altiplan::bidirectional_astar_test
