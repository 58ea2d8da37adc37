// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <thread>

#include "altiplan/error.hpp"
#include "dstar_worlds_test.hpp"

namespace altiplan::dstar_lite_test {
namespace {

using testing::city_request;
using testing::draw;
using testing::Drawn;
using testing::expanded;
using testing::make_planner;
using testing::request_in;

void expect_the_length_of_astar_in_cities(int from, int to) {
  const auto dstar = make_planner("dstar_lite");
  const auto astar = make_planner("astar");
  for (int n = from; n < to; ++n) {
    const Request request = city_request(n % 2 == 0 ? "complex" : "simple", n / 2);
    const PlanResult result = dstar->plan(request);
    const PlanResult expected = astar->plan(request);
    ASSERT_EQ(result.status, PlanStatus::solved) << n << ": " << result.message;
    ASSERT_EQ(expected.status, PlanStatus::solved) << n;
    EXPECT_NEAR(length(result.route), length(expected.route), 1e-9 * length(expected.route)) << n;
    EXPECT_TRUE(check(result.route, request).ok()) << n;
  }
}

TEST(DStarLite, FirstPlanHasTheLengthOfAStarInCities) {
  expect_the_length_of_astar_in_cities(0, 50);
}
TEST(NightlyDStarLite, FirstPlanHasTheLengthOfAStarInCities) {
  expect_the_length_of_astar_in_cities(50, 200);
}

TEST(DStarLite, TheHundredthPlanIsTheFirstAndThreadsAgree) {
  const Request request = city_request("complex", 3);
  const auto planner = make_planner("dstar_lite");
  const PlanResult first = planner->plan(request);
  const auto same = [&](const PlanResult& again) {
    return again.route == first.route && again.message == first.message;
  };
  for (int call = 0; call < 20; ++call) {
    Request other = request;
    other.start.position = Vec3(15 + 10 * call, 705, 955);
    planner->plan(other);
    ASSERT_TRUE(same(planner->plan(request))) << call;
  }
  std::array<bool, 4> equal{};
  std::vector<std::thread> threads;
  for (bool& flag : equal) {
    threads.emplace_back([&] { flag = same(planner->begin(request)->result()); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(equal, (std::array<bool, 4>{true, true, true, true}));
}

TEST(DStarLite, BudgetAndCancellation) {
  const auto planner = make_planner("dstar_lite");
  Request request = city_request("complex", 1);
  for (const std::uint64_t maximum : {0, 7, 600}) {
    request.budget.max_iterations = maximum;
    const PlanResult cut = planner->plan(request);
    EXPECT_EQ(cut.status, PlanStatus::timed_out);
    EXPECT_TRUE(cut.budget_hit);
    EXPECT_EQ(expanded(cut), std::int64_t(maximum));
  }
  request.budget = {};
  request.budget.max_memory_bytes = 9 * 640'000 + 10'000;
  EXPECT_EQ(planner->plan(request).status, PlanStatus::timed_out);
  std::stop_source stop;
  stop.request_stop();
  request.budget = {};
  request.budget.stop = stop.get_token();
  EXPECT_EQ(planner->plan(request).status, PlanStatus::cancelled);
}

TEST(DStarLite, EndsWithinTheToleranceWhereNoLegJoinsTheGoal) {
  // A thin wall between the goal and the only column of free cells.
  Request request = request_in(testing::world_of({BoxShape{{{10.2, -1, -1}, {10.4, 101, 11}}}}),
                               {5, 5, 5}, {12, 85, 5}, {{0, 0, 0}, {20, 100, 10}});
  request.level_m = 5;
  const auto planner = make_planner("dstar_lite", "{cell_m: [10, 10, 10], moves: cells}");
  const PlanResult without = planner->plan(request);
  EXPECT_EQ(without.status, PlanStatus::no_route);
  EXPECT_TRUE(without.proved);
  request.goal.tolerance_m = 8;
  const PlanResult within = planner->plan(request);
  ASSERT_EQ(within.status, PlanStatus::solved) << within.message;
  EXPECT_EQ(within.route.back(), Vec3(5, 85, 5));
  EXPECT_TRUE(check(within.route, request).ok());
}

TEST(DStarLite, ALimitOnTheRoutesLengthIsHeldToTheShortest) {
  Drawn drawn = draw({"S.#..\n..#..\n..#.G\n....."});
  const auto planner = make_planner("dstar_lite");
  const double shortest = length(planner->plan(drawn.request).route);
  drawn.request.limits.max_route_length = shortest + 0.01;
  EXPECT_EQ(planner->plan(drawn.request).status, PlanStatus::solved);
  drawn.request.limits.max_route_length = shortest - 0.01;
  const PlanResult result = planner->plan(drawn.request);
  EXPECT_EQ(result.status, PlanStatus::no_route);
  EXPECT_TRUE(result.proved);
  EXPECT_NE(result.message.find("route_length"), std::string::npos) << result.message;
}

TEST(DStarLite, TurnsAreHeldByHeadingOrGivenUp) {
  Drawn drawn = draw({".......\n.......\n.......\n..S#G..\n.......\n......."});
  drawn.request.level_m = 0.5;
  drawn.request.limits.max_turn_horizontal = 0.8;
  const PlanResult given_up = make_planner("dstar_lite", "{state: parent}")->plan(drawn.request);
  EXPECT_EQ(given_up.status, PlanStatus::no_route);
  EXPECT_FALSE(given_up.proved);
  EXPECT_NE(given_up.message.find("turn"), std::string::npos) << given_up.message;
  Drawn near = drawn;  // also where a search for ends near the goal follows
  near.request.goal.position += Vec3(0.3, 0, 0);
  near.request.goal.tolerance_m = 0.2;
  const PlanResult still = make_planner("dstar_lite", "{state: parent}")->plan(near.request);
  EXPECT_EQ(still.status, PlanStatus::no_route);
  EXPECT_FALSE(still.proved);
  EXPECT_EQ(still.message, given_up.message);
  const PlanResult searched = make_planner("dstar_lite")->plan(drawn.request);
  const PlanResult expected =
      make_planner("astar", "{state: cell_and_heading}")->plan(drawn.request);
  EXPECT_EQ(searched.status, expected.status) << searched.message;
  EXPECT_NEAR(length(searched.route), length(expected.route), 1e-6);
  EXPECT_NE(searched.message.find("by cell and heading"), std::string::npos) << searched.message;
}

TEST(DStarLite, TooLittleMemoryForHeadingsIsABudgetThatEnds) {
  Drawn drawn = draw({"S.......\n........\n.......G"});
  drawn.request.limits.max_turn_horizontal = 0.8;
  drawn.request.budget.max_memory_bytes = 24 * 100;
  const PlanResult cut =
      make_planner("dstar_lite", "{state: cell_and_heading}")->plan(drawn.request);
  EXPECT_EQ(cut.status, PlanStatus::timed_out) << cut.message;
  EXPECT_TRUE(cut.budget_hit);
  EXPECT_EQ(expanded(cut), 0);
}

TEST(DStarLite, MemoryIsCheckedBeforeItIsTaken) {
  const Request request = request_in(World(), {5, 5, 5}, {95, 95, 5}, {{0, 0, 0}, {100, 100, 10}});
  const auto planner = make_planner("dstar_lite", "{cell_m: [0.001, 0.001, 1]}");
  try {
    planner->plan(request);
    FAIL() << "a lattice of 1e11 cells was accepted";
  } catch (const ParameterError& error) {
    EXPECT_EQ(error.key(), "cell_m");
  }
}

/// Records the events of a search.
class Kept final : public Trace {
 public:
  void add(const TraceEvent& event) override { events.push_back(event); }
  std::vector<TraceEvent> events;
};

TEST(DStarLite, TracesEveryVertexItExpands) {
  Drawn drawn = draw({"....#...\n.S..#.G.\n....#...\n........"});
  Kept trace;
  drawn.request.trace = &trace;
  const PlanResult result = make_planner("dstar_lite")->plan(drawn.request);
  ASSERT_EQ(result.status, PlanStatus::solved);
  ASSERT_EQ(std::int64_t(trace.events.size()), expanded(result));
  for (const TraceEvent& event : trace.events) {
    EXPECT_LE(event.value, length(result.route) + 1e-6);
  }
}

TEST(DStarLite, TraitsAndParameters) {
  const Traits traits = make_planner("dstar_lite")->traits();
  EXPECT_TRUE(traits.complete && traits.optimal && traits.incremental);
  EXPECT_NE(testing::parameter_problems("planner", "dstar_lite", "{corner: round}"), "");
  EXPECT_NE(testing::parameter_problems("planner", "dstar_lite", "{neighbours: 8}"), "");
}
}  // namespace
}  // namespace altiplan::dstar_lite_test
