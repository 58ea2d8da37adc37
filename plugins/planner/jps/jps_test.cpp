// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <map>
#include <thread>

#include "altiplan/error.hpp"
#include "jps_maps_test.hpp"

namespace altiplan::jps_test {
namespace {

using testing::counter;
using testing::draw;
using testing::Drawn;
using testing::jps;
using testing::Map;
using testing::random_map;
using testing::serpentine;

Drawn drawn(const std::string& level) {
  Drawn drawn = draw({level});
  drawn.request.level_m = 0.5;
  return drawn;
}

TEST(Jps, RoutesHaveTheirCornersOnly) {
  const Drawn open = drawn("......G\n.......\n.......\nS......");
  const PlanResult straight = jps(true)->plan(open.request);
  EXPECT_EQ(straight.route, (Route{{0.5, 0.5, 0.5}, {3.5, 3.5, 0.5}, {6.5, 3.5, 0.5}}));
  EXPECT_EQ(counter(straight, "expanded"), 1);  // the goal is the only jump point

  const Drawn wall = drawn(".......\nS..#..G\n...#...");
  EXPECT_EQ(
      jps(false)->plan(wall.request).route,
      (Route{{0.5, 1.5, 0.5}, {1.5, 2.5, 0.5}, {3.5, 2.5, 0.5}, {4.5, 1.5, 0.5}, {6.5, 1.5, 0.5}}));
  const PlanResult wide = jps(true)->plan(wall.request);
  EXPECT_NEAR(length(wide.route), 4 + 2 * std::sqrt(2.0), 1e-12);
  EXPECT_TRUE(check(wide.route, wall.request).ok());
}

TEST(Jps, PassesBetweenCellsThatMeetInACornerOnlyUnderAny) {
  const Drawn corner = drawn("..#.\n.S#.\n###G");
  EXPECT_EQ(jps(false)->plan(corner.request).status, PlanStatus::no_route);
  const Drawn gap = drawn("..#.\n.S#G\n##..");
  EXPECT_EQ(jps(false)->plan(gap.request).status, PlanStatus::solved);
  const PlanResult shut = jps(true)->plan(gap.request);
  EXPECT_EQ(shut.status, PlanStatus::no_route);
  EXPECT_TRUE(shut.proved);
}

TEST(Jps, BudgetAndCancellation) {
  const auto planner = jps(true);
  Request request = serpentine(40, 41).request(0, 40 * 41 - 1);
  request.budget.max_iterations = 0;
  const PlanResult none = planner->plan(request);
  EXPECT_EQ(none.status, PlanStatus::timed_out);
  EXPECT_TRUE(none.budget_hit);
  request.budget.max_iterations = 7;
  const PlanResult some = planner->plan(request);
  EXPECT_EQ(some.status, PlanStatus::timed_out);
  EXPECT_EQ(counter(some, "expanded"), 7);

  std::stop_source stop;
  stop.request_stop();
  request.budget = {};
  request.budget.stop = stop.get_token();
  EXPECT_EQ(planner->plan(request).status, PlanStatus::cancelled);
}

TEST(Jps, SealedGoalAndStart) {
  const PlanResult goal = jps(true)->plan(drawn("S....\n.....\n..###\n..#G#\n..###").request);
  EXPECT_EQ(goal.status, PlanStatus::no_route);
  EXPECT_TRUE(goal.proved);
  EXPECT_NE(goal.message.find("the nearest to the goal at"), std::string::npos) << goal.message;
  const PlanResult start = jps(true)->plan(drawn("S#...\n##...\n....G").request);
  EXPECT_EQ(start.status, PlanStatus::no_route);
  EXPECT_EQ(counter(start, "expanded"), 1);
}

TEST(Jps, AWorldThatComesToLieWhereAnotherWasIsScannedAnew) {
  SplitMix64 random(1);
  const auto kept = jps(true);
  const auto other_rule = jps(false);
  int solved = 0;
  for (int n = 0; n < 300; ++n) {
    // Two of one size in a row, then another: each world is destroyed before the next is created.
    const int width = 20 + n / 2 % 7 * 17;
    const Map map = random_map(random, width, 150 - width, 0.25);
    const std::vector<int> free = map.free_cells();
    const Request request = map.request(free.front(), free.back());
    const PlanResult expected = jps(true)->plan(request);
    const PlanResult result = kept->plan(request);
    ASSERT_EQ(result.status, expected.status) << n;
    ASSERT_EQ(result.route, expected.route) << n;
    ASSERT_EQ(other_rule->plan(request).route, jps(false)->plan(request).route) << n;
    solved += result.status == PlanStatus::solved;
  }
  EXPECT_GT(solved, 100);
}

TEST(Jps, HundredthCallEqualsTheFirstOnAnyThread) {
  SplitMix64 random(2);
  const auto planner = jps(false);
  const Map map = random_map(random, 120, 90, 0.2);
  const std::vector<int> free = map.free_cells();
  const Request request = map.request(free.front(), free.back());
  const PlanResult first = planner->plan(request);
  ASSERT_EQ(first.status, PlanStatus::solved);
  const auto same = [&](const PlanResult& again) {
    return again.route == first.route && again.message == first.message &&
           counter(again, "generated") == counter(first, "generated");
  };
  for (int call = 0; call < 99; ++call) {
    planner->plan(map.request(free.back(), free[std::size_t(call)]));
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

TEST(Jps, KeepsTheVehiclesRadius) {
  Request request = testing::request_in(testing::world_of({BoxShape{{{40, -10, 0}, {60, 70, 10}}}}),
                                        {10, 20, 5}, {90, 20, 5}, {{0, 0, 0}, {100, 100, 10}});
  request.level_m = 5;
  request.vehicle.radius_m = request.limits.min_clearance = 3;
  const auto cells = testing::make_planner("jps", "{cell_m: [5, 5, 5]}");
  const PlanResult result = cells->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_TRUE(check(result.route, request).ok());
  const PlanResult astar =
      testing::make_planner("astar", "{cell_m: [5, 5, 5], moves: cells}")->plan(request);
  EXPECT_NEAR(length(result.route), length(astar.route), 1e-6);
}

TEST(Jps, EndsWithinTheToleranceWhereNoLegJoinsTheGoal) {
  // A thin wall between the goal and the only column of free cells.
  Request request =
      testing::request_in(testing::world_of({BoxShape{{{10.2, -1, -1}, {10.4, 101, 11}}}}),
                          {5, 5, 5}, {12, 85, 5}, {{0, 0, 0}, {20, 100, 10}});
  request.level_m = 5;
  const auto planner = testing::make_planner("jps", "{cell_m: [10, 10, 10]}");
  const PlanResult without = planner->plan(request);
  EXPECT_EQ(without.status, PlanStatus::no_route);
  EXPECT_TRUE(without.proved);
  request.goal.tolerance_m = 8;
  const PlanResult within = planner->plan(request);
  ASSERT_EQ(within.status, PlanStatus::solved) << within.message;
  EXPECT_EQ(within.route.back(), Vec3(5, 85, 5));
  EXPECT_TRUE(check(within.route, request).ok());
  // Cells farther away than a link were not examined.
  request.goal = {{17, 85, 5}, 11};
  const PlanResult beyond = planner->plan(request);
  EXPECT_EQ(beyond.status, PlanStatus::no_route);
  EXPECT_FALSE(beyond.proved);
}

TEST(Jps, OneLevelOfCellsNeedsNoLevelFlight) {
  Drawn flat = draw({"S..#\n.#..\n...G"});
  const PlanResult result = jps(true)->plan(flat.request);
  EXPECT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_TRUE(check(result.route, flat.request).ok());
  const Drawn deep = draw({"S..", "..G"});
  const PlanResult refused = jps(true)->plan(deep.request);
  EXPECT_EQ(refused.status, PlanStatus::invalid_problem);
  EXPECT_NE(refused.message.find("this lattice has 2"), std::string::npos) << refused.message;
}

TEST(Jps, RefusesRulesThatCellsCannotHoldAndNamesThem) {
  const Request plain = drawn("S..\n...\n..G").request;
  const std::map<std::string, std::function<void(Request&)>> rules{
      {"limits on turns", [](Request& r) { r.limits.max_turn_horizontal = 1; }},
      {"limits on the length of legs", [](Request& r) { r.limits.max_leg = 2; }},
      {"a limit on the route's length", [](Request& r) { r.limits.max_route_length = 9; }},
      {"constraints on the ground below",
       [](Request& r) {
         r.limits.altitude.push_back({AltitudeBand::Datum::ground, -kInfinity, kInfinity});
       }},
      {"the constraint 'climb'", [](Request& r) {
         r.constraints.push_back(
             {"climb", testing::make_constraint("climb_angle", "{max_deg: 9}")});
       }}};
  for (const auto& [name, set] : rules) {
    Request request = plain;
    set(request);
    const PlanResult result = jps(true)->plan(request);
    EXPECT_EQ(result.status, PlanStatus::invalid_problem) << name;
    EXPECT_EQ(result.message, "jps cannot satisfy " + name + ": use astar");
  }
  Request bounded = plain;
  bounded.limits.min_leg = 0.1;
  EXPECT_EQ(jps(true)->plan(bounded).status, PlanStatus::invalid_problem);
  EXPECT_EQ(jps(true)->plan(plain).status, PlanStatus::solved);
}

TEST(Jps, MemoryIsCheckedBeforeItIsTaken) {
  Request request =
      testing::request_in(World(), {5, 5, 5}, {95, 95, 5}, {{0, 0, 0}, {100, 100, 10}});
  request.level_m = 5;
  const auto planner = testing::make_planner("jps", "{cell_m: [0.001, 0.001, 1]}");
  try {
    planner->plan(request);
    FAIL() << "a lattice of 1e10 cells was accepted";
  } catch (const ParameterError& error) {
    EXPECT_EQ(error.key(), "cell_m");
    EXPECT_NE(std::string(error.what()).find("MB"), std::string::npos) << error.what();
  }
}

TEST(Jps, CellsTooUnlikeForTheCostsAreRefused) {
  Request request =
      testing::request_in(World(), {5e5, 0.01, 5}, {9e5, 0.09, 5}, {{0, 0, 0}, {1e6, 0.1, 10}});
  request.level_m = 5;
  const PlanResult result =
      testing::make_planner("jps", "{cell_m: [100000, 0.001, 1]}")->plan(request);
  EXPECT_EQ(result.status, PlanStatus::invalid_problem);
  EXPECT_NE(result.message.find("100000"), std::string::npos) << result.message;
}

/// Records the events of a search.
class Kept final : public Trace {
 public:
  void add(const TraceEvent& event) override { events.push_back(event); }
  std::vector<TraceEvent> events;
};

TEST(Jps, TracesEveryJumpPointItExpands) {
  Request request = drawn("....#...\n.S..#.G.\n....#...\n........").request;
  Kept trace;
  request.trace = &trace;
  const PlanResult result = jps(true)->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved);
  ASSERT_EQ(std::int64_t(trace.events.size()), counter(result, "expanded"));
  EXPECT_EQ(trace.events.front().parent, -1);
  double f = 0;
  for (const TraceEvent& event : trace.events) {
    EXPECT_EQ(event.kind, TraceEvent::Kind::expanded);
    EXPECT_GE(event.value, f - 1e-9);
    f = event.value;
  }
  EXPECT_NEAR(f, length(result.route), 1e-6);
}

TEST(Jps, TracedParentsAreWhereRunsBegan) {
  SplitMix64 random(3);
  const auto planner = jps(false);
  std::size_t orphans = 0;
  std::size_t events = 0;
  for (int n = 0; n < 100; ++n) {
    const Map map = random_map(random, 60, 50, 0.3);
    const std::vector<int> free = map.free_cells();
    Request request = map.request(free.front(), free.back());
    Kept trace;
    request.trace = &trace;
    planner->plan(request);
    events += trace.events.size();
    for (const TraceEvent& event : trace.events) {
      if (event.parent < 0) {
        ++orphans;
        continue;
      }
      const Vec3 run = (event.position - map.centre(int(event.parent))).cwiseAbs();
      EXPECT_TRUE(run.x() == 0 || run.y() == 0 || run.x() == run.y()) << run.transpose();
    }
  }
  // The starts, and the few cells that only a detour reached.
  EXPECT_GE(orphans, 100u);
  EXPECT_LT(orphans, 100 + events / 50);
}

TEST(Jps, TraitsFollowTheParameters) {
  EXPECT_TRUE(jps(true)->traits().optimal);
  EXPECT_TRUE(jps(true)->traits().complete);
  EXPECT_FALSE(jps(true)->traits().spatial);
  EXPECT_FALSE(testing::make_planner("jps", "{costs: integer}")->traits().optimal);
  EXPECT_NE(testing::parameter_problems("planner", "jps", "{corner: round}"), "");
}
}  // namespace
}  // namespace altiplan::jps_test
