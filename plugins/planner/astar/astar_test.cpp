// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "altiplan/error.hpp"
#include "astar_worlds_test.hpp"

namespace altiplan::astar_test {
namespace {

using testing::among;
using testing::Balls;
using testing::counter;
using testing::draw;
using testing::Drawn;
using testing::make_planner;
using testing::random_balls;
using testing::random_levels;

TEST(AStar, KeepsTurnAndClimbLimits) {
  SplitMix64 random(3);
  int solved = 0;
  for (int world = 0; world < 60; ++world) {
    Request request = among(random_balls(random, 6));
    request.limits.max_turn_horizontal = radians(55);
    request.limits.max_climb = radians(30);
    request.start.velocity = {10, 2, 0};
    request.goal.position = {93, 82, 33};  // not the centre of a cell
    const PlanResult result = make_planner("astar", "{cell_m: [10, 10, 5]}")->plan(request);
    if (result.status == PlanStatus::solved) {
      ++solved;
      const CheckResult judged = check(result.route, request);
      EXPECT_TRUE(judged.ok()) << judged.violations.front().message;
      EXPECT_EQ(result.route.back(), request.goal.position);
    }
  }
  EXPECT_GT(solved, 20);
}

TEST(AStar, BudgetCancellationSealedGoalAndCorridor) {
  const auto planner = make_planner("astar");
  Drawn corridor =
      draw({"#########\n#S..#...#\n###.#.#.#\n#...#.#.#\n#.###.#.#\n#.....#G#\n#########"});
  corridor.request.level_m = 0.5;
  const PlanResult through = planner->plan(corridor.request);
  ASSERT_EQ(through.status, PlanStatus::solved) << through.message;
  EXPECT_TRUE(check(through.route, corridor.request).ok());

  corridor.request.budget.max_iterations = 0;
  const PlanResult none = planner->plan(corridor.request);
  EXPECT_EQ(none.status, PlanStatus::timed_out);
  EXPECT_TRUE(none.budget_hit);
  corridor.request.budget.max_iterations = 5;
  EXPECT_EQ(counter(planner->plan(corridor.request), "expanded"), 5);

  std::stop_source stop;
  stop.request_stop();
  corridor.request.budget = {};
  corridor.request.budget.stop = stop.get_token();
  EXPECT_EQ(planner->plan(corridor.request).status, PlanStatus::cancelled);

  Drawn sealed = draw({"S....\n.....\n..###\n..#G#\n..###"});
  sealed.request.level_m = 0.5;
  const PlanResult shut = planner->plan(sealed.request);
  EXPECT_EQ(shut.status, PlanStatus::no_route);
  EXPECT_TRUE(shut.proved);
  EXPECT_NE(shut.message.find("blocked cells"), std::string::npos) << shut.message;

  sealed.request.goal = {sealed.request.start.position, 0};
  EXPECT_EQ(planner->plan(sealed.request).route.size(), 1u);
}

TEST(AStar, TraceByCellsIsATreeOfSteps) {
  struct Kept final : Trace {
    std::vector<TraceEvent> events;
    void add(const TraceEvent& event) override { events.push_back(event); }
  } trace;
  SplitMix64 random(7);
  Drawn drawn = draw(random_levels(random, 15, 15, 8, 0.3), 10);
  drawn.request.trace = &trace;
  const PlanResult result = make_planner("astar")->plan(drawn.request);
  ASSERT_EQ(result.status, PlanStatus::solved);
  ASSERT_EQ(std::int64_t(trace.events.size()), counter(result, "expanded"));
  std::map<std::int64_t, Vec3> expanded;
  for (const TraceEvent& event : trace.events) {
    if (!expanded.empty()) {
      ASSERT_TRUE(expanded.contains(event.parent)) << event.node;
      EXPECT_LT((expanded[event.parent] - event.position).norm(), 17.4);
    }
    EXPECT_TRUE(expanded.emplace(event.node, event.position).second);
  }
}

TEST(AStar, EndsWithinTheToleranceOfAGoalThatCannotBeReached) {
  Drawn drawn = draw({"S.........\n..........\n..........\n.......###\n.......#G.\n.......###"});
  drawn.request.level_m = 0.5;
  drawn.request.goal.tolerance_m = 2.1;
  const PlanResult result = make_planner("astar")->plan(drawn.request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_EQ(result.route.back(), Vec3(6.5, 1.5, 0.5));
  EXPECT_TRUE(check(result.route, drawn.request).ok());
}

TEST(AStar, RefusalsNameTheRule) {
  Request request = among(std::make_shared<Balls>());
  request.limits.max_climb = radians(1);
  const PlanResult result = make_planner("astar", "{cell_m: [10, 10, 5]}")->plan(request);
  EXPECT_EQ(result.status, PlanStatus::no_route);
  EXPECT_TRUE(result.proved);
  EXPECT_NE(result.message.find("climb_angle rules out 18 of 26"), std::string::npos)
      << result.message;
}

TEST(AStar, TurnsThatTheCellsAreTooSmallForAreNamed) {
  Request request = among(std::make_shared<Balls>());
  request.level_m = 20;
  request.start.position = {5, 5, 20};
  request.goal.position = {95, 45, 20};
  const std::string clause =
      "; turns of cells of 10 m have a radius of at most 12.071 m, below the required 12.5 m: use "
      "larger cells, or hybrid_astar, whose legs curve";
  for (const char* name : {"astar", "bidirectional_astar", "dstar_lite"}) {
    const auto planner = make_planner(name, "{cell_m: [10, 10, 5]}");
    request.limits.min_turn_radius = 12.5;
    const PlanResult none = planner->plan(request);
    EXPECT_EQ(none.status, PlanStatus::no_route) << name;
    EXPECT_NE(none.message.find(clause), std::string::npos) << name << ": " << none.message;
    request.limits.min_turn_radius = 12;
    EXPECT_EQ(planner->plan(request).status, PlanStatus::solved) << name;
  }
}

TEST(AStar, RouteLengthCutsTheSearch) {
  Request request = among(std::make_shared<Balls>());
  const double direct = (request.goal.position - request.start.position).norm();
  request.limits.max_route_length = direct * 1.001;
  const PlanResult result = make_planner("astar", "{cell_m: [10, 10, 5]}")->plan(request);
  EXPECT_EQ(result.status, PlanStatus::no_route);
  request.limits.max_route_length = direct * 1.1;
  EXPECT_EQ(make_planner("astar", "{cell_m: [10, 10, 5]}")->plan(request).status,
            PlanStatus::solved);
}

TEST(AStar, MemoryIsCheckedBeforeItIsTaken) {
  Request request = among(std::make_shared<Balls>());
  const auto planner = make_planner("astar", "{cell_m: [0.001, 0.001, 0.001]}");
  try {
    planner->plan(request);
    FAIL() << "a lattice of 3.6e14 cells was accepted";
  } catch (const ParameterError& error) {
    EXPECT_EQ(error.key(), "cell_m");
    EXPECT_NE(std::string(error.what()).find("MB"), std::string::npos) << error.what();
  }
}

TEST(AStar, CellsBeyondTheMemoryOfABudgetAreAResult) {
  Drawn drawn = draw({"S...", "....", "...G"});
  drawn.request.budget.max_memory_bytes = 20;
  // Memory is taken before the search where cells decide alone, else as cells are reached.
  for (const auto& [moves, message] :
       {std::pair("{moves: cells}", "the budget is 0 MiB"),
        {"{moves: exact}", "max_memory_mb or within_mb is used up"}}) {
    const PlanResult result = make_planner("astar", moves)->plan(drawn.request);
    EXPECT_EQ(result.status, PlanStatus::timed_out);
    EXPECT_TRUE(result.budget_hit);
    EXPECT_NE(result.message.find(message), std::string::npos) << result.message;
  }
}

TEST(AStar, HundredthCallEqualsTheFirstOnAnyThread) {
  SplitMix64 random(5);
  const auto planner = make_planner("astar", "{cell_m: [10, 10, 5]}");
  const Request request = among(random_balls(random, 12));
  const Request other = among(random_balls(random, 5));
  const PlanResult first = planner->plan(request);
  const auto same = [&](const PlanResult& again) {
    return again.route == first.route && again.message == first.message &&
           counter(again, "expanded") == counter(first, "expanded");
  };
  for (int call = 0; call < 99; ++call) {
    planner->plan(other);
    ASSERT_TRUE(same(planner->plan(request))) << call;
  }
  std::array<bool, 4> equal{};
  std::vector<std::thread> threads;
  for (bool& flag : equal) {
    threads.emplace_back([&] { flag = same(planner->plan(request)); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(equal, (std::array<bool, 4>{true, true, true, true}));
}

TEST(AStar, TraitsFollowTheParameters) {
  EXPECT_TRUE(make_planner("astar")->traits().optimal);
  EXPECT_TRUE(make_planner("astar", "{weight_g: 0.7, weight_h: 0.3, heuristic: manhattan}")
                  ->traits()
                  .optimal);
  EXPECT_FALSE(make_planner("astar", "{heuristic: manhattan}")->traits().optimal);
  EXPECT_FALSE(make_planner("astar", "{weight_g: 0.3, weight_h: 0.7}")->traits().optimal);
  EXPECT_NE(testing::parameter_problems("planner", "astar", "{neighbours: 8}"), "");
  EXPECT_NE(testing::parameter_problems("planner", "astar", "{cell_m: [1, 0, 1]}"), "");
}
}  // namespace
}  // namespace altiplan::astar_test
