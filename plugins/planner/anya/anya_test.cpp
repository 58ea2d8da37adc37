// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <thread>

#include "altiplan/check.hpp"
#include "altiplan/error.hpp"
#include "reference/level_maps.hpp"

namespace altiplan::anya_test {
namespace {

using testing::counter;
using testing::draw;
using testing::Drawn;
using testing::make_planner;
using testing::Map;
using testing::random_map;
using testing::serpentine;

std::unique_ptr<Planner> anya() { return make_planner("anya"); }

Request drawn(const std::string& level) {
  Request request = draw({level}).request;
  request.level_m = 0.5;
  return request;
}

TEST(Anya, RoutesBendAtCornersOfBlockedCells) {
  const PlanResult open = anya()->plan(drawn("......G\n.......\n.......\nS......"));
  EXPECT_EQ(open.route, (Route{{0.5, 0.5, 0.5}, {6.5, 3.5, 0.5}}));
  EXPECT_EQ(counter(open, "expanded"), 2);  // the lines between

  const Request wall = drawn(".......\nS..#..G\n...#...");
  const PlanResult around = anya()->plan(wall);
  EXPECT_EQ(around.route, (Route{{0.5, 1.5, 0.5}, {3, 2, 0.5}, {4, 2, 0.5}, {6.5, 1.5, 0.5}}));
  EXPECT_NEAR(length(around.route), 1 + 2 * std::hypot(2.5, 0.5), 1e-12);
  EXPECT_EQ(around.message.find("a route of 6 m"), 0u) << around.message;
  EXPECT_TRUE(check(around.route, wall).ok());

  // No waypoint where a route only touches a corner, or passes it straight.
  const PlanResult stairs = anya()->plan(drawn("#..G\n#...\n....\nS.##"));
  EXPECT_EQ(stairs.route, (Route{{0.5, 0.5, 0.5}, {3.5, 3.5, 0.5}}));
  const PlanResult pinch = anya()->plan(drawn("S#\n#G"));
  EXPECT_EQ(pinch.route, (Route{{0.5, 1.5, 0.5}, {1.5, 0.5, 0.5}}));
}

TEST(Anya, PassesBetweenCellsThatMeetInACornerOnlyUnderAny) {
  const Request gap = drawn("..#.\n.S#G\n##..");
  const PlanResult passed = make_planner("anya", "{corner: any}")->plan(gap);
  EXPECT_EQ(passed.route, (Route{{1.5, 1.5, 0.5}, {2, 1, 0.5}, {3, 1, 0.5}, {3.5, 1.5, 0.5}}));
  const PlanResult shut = make_planner("anya", "{corner: one_free}")->plan(gap);
  EXPECT_EQ(shut.status, PlanStatus::no_route);
  EXPECT_TRUE(shut.proved);
  EXPECT_NE(shut.message.find("blocked cells bar every path on"), std::string::npos)
      << shut.message;
  // Under both, no route leads along the edge of two blocked cells.
  EXPECT_EQ(anya()->plan(drawn("..#.\n.S#G\n###.\n####")).status, PlanStatus::no_route);
}

TEST(Anya, BudgetAndCancellation) {
  const auto planner = anya();
  Request request = serpentine(40, 41).request(0, 40 * 41 - 1);
  const std::int64_t all = counter(planner->plan(request), "expanded");
  EXPECT_GT(all, 30);
  for (const std::int64_t maximum : {std::int64_t{0}, std::int64_t{7}, all - 1}) {
    request.budget.max_iterations = std::uint64_t(maximum);
    const PlanResult part = planner->plan(request);
    EXPECT_EQ(part.status, PlanStatus::timed_out);
    EXPECT_TRUE(part.budget_hit);
    EXPECT_FALSE(part.proved);
    EXPECT_EQ(counter(part, "expanded"), maximum);
    EXPECT_EQ(part.message.find("the budget was used up"), 0u) << part.message;
  }
  request.budget.max_iterations = std::uint64_t(all + 1);
  EXPECT_EQ(planner->plan(request).status, PlanStatus::solved);

  request.budget = {};
  request.budget.deadline = Budget::Clock::now();
  EXPECT_EQ(planner->plan(request).status, PlanStatus::timed_out);

  std::stop_source stop;
  stop.request_stop();
  request.budget = {};
  request.budget.stop = stop.get_token();
  EXPECT_EQ(planner->plan(request).status, PlanStatus::cancelled);
}

TEST(Anya, MemoryIsLimitedBeforeAndDuringTheSearch) {
  SplitMix64 random(4);
  const Map map = random_map(random, 200, 200, 0.35);
  const std::vector<int> free = map.free_cells();
  Request request = map.request(free.front(), free.back());
  const auto planner = anya();
  const PlanResult whole = planner->plan(request);
  ASSERT_EQ(whole.status, PlanStatus::solved) << whole.message;

  request.budget.max_memory_bytes = 5 * 200 * 200 - 1;
  const PlanResult none = planner->plan(request);
  EXPECT_EQ(none.status, PlanStatus::timed_out);
  EXPECT_TRUE(none.budget_hit);
  EXPECT_EQ(counter(none, "expanded"), 0);
  request.budget.max_memory_bytes = 5 * 200 * 200;
  const PlanResult part = planner->plan(request);
  EXPECT_EQ(part.status, PlanStatus::timed_out);
  EXPECT_TRUE(part.budget_hit);
  EXPECT_GT(counter(part, "expanded"), 0);
  EXPECT_LT(counter(part, "expanded"), counter(whole, "expanded"));
  EXPECT_EQ(part.message.find("the memory allowed was used up"), 0u) << part.message;
  request.budget.max_memory_bytes = std::size_t{100} << 20;
  EXPECT_EQ(planner->plan(request).route, whole.route);
  // What a search left in the memory is none of the next one's.
  request.budget.max_memory_bytes = 5 * 200 * 200;
  EXPECT_EQ(counter(anya()->plan(request), "expanded"), counter(part, "expanded"));

  Request huge = testing::request_in(World(), {5, 5, 5}, {95, 95, 5}, {{0, 0, 0}, {100, 100, 10}});
  try {
    make_planner("anya", "{cell_m: [0.001, 0.001, 1]}")->plan(huge);
    FAIL() << "a lattice of 1e10 cells was accepted";
  } catch (const ParameterError& error) {
    EXPECT_EQ(error.key(), "cell_m");
    EXPECT_NE(std::string(error.what()).find("MB"), std::string::npos) << error.what();
  }
}

TEST(Anya, SealedGoalAndStart) {
  const PlanResult goal = anya()->plan(drawn("S....\n.....\n..###\n..#G#\n..###\n....."));
  EXPECT_EQ(goal.status, PlanStatus::no_route);
  EXPECT_TRUE(goal.proved);
  EXPECT_NE(goal.message.find("the turn nearest to the goal is at (2, 1, 0), 2 m from it"),
            std::string::npos)
      << goal.message;
  const PlanResult start = anya()->plan(drawn("S#...\n##...\n....G"));
  EXPECT_EQ(start.status, PlanStatus::no_route);
  EXPECT_TRUE(start.proved);
}

TEST(Anya, HundredthCallEqualsTheFirstOnAnyThread) {
  SplitMix64 random(2);
  const auto planner = anya();
  const Map map = random_map(random, 120, 90, 0.2);
  const Map other = random_map(random, 150, 140, 0.3);
  const std::vector<int> free = map.free_cells();
  const std::vector<int> free_other = other.free_cells();
  const Request request = map.request(free.front(), free.back());
  const PlanResult first = planner->plan(request);
  ASSERT_EQ(first.status, PlanStatus::solved);
  const auto same = [&](const PlanResult& again) {
    return again.route == first.route && again.message == first.message &&
           counter(again, "generated") == counter(first, "generated");
  };
  for (std::size_t call = 0; call < 99; ++call) {
    planner->plan(call % 2 == 0 ? map.request(free.back(), free[call])
                                : other.request(free_other[call], free_other[9 * call]));
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

TEST(Anya, FliesOnTheStartsLevelAmongVoxels) {
  const Drawn voxels = draw({"........\n........\n........", "....#...\nS...#..G\n....#...",
                             "........\n........\n........"});
  const PlanResult barred = anya()->plan(voxels.request);
  EXPECT_EQ(barred.status, PlanStatus::no_route);
  Request above = voxels.request;
  above.start.position.z() = above.goal.position.z() = 2.7;
  EXPECT_EQ(anya()->plan(above).route, (Route{above.start.position, above.goal.position}));

  Request climbing = voxels.request;
  climbing.goal.position.z() = 2.5;
  const PlanResult refused = anya()->plan(climbing);
  EXPECT_EQ(refused.status, PlanStatus::invalid_problem);
  EXPECT_EQ(refused.message,
            "anya flies on one level, but the start is at 1.5 m and the goal at 2.5 m: use "
            "theta_star");
}

class ShortLegs final : public Constraint {
  bool do_admits(const Motion& leg) const override { return (leg.to - leg.from).norm() < 9; }
};

TEST(Anya, RefusesRulesThatCellsCannotHoldAndNamesThem) {
  const Request plain = drawn("S..\n...\n..G");
  const std::map<std::string, std::function<void(Request&)>> rules{
      {"limits on turns", [](Request& r) { r.limits.max_turn_horizontal = 1; }},
      {"limits on the length of legs", [](Request& r) { r.limits.max_leg = 2; }},
      {"a limit on the route's length", [](Request& r) { r.limits.max_route_length = 9; }},
      {"constraints on the ground below",
       [](Request& r) {
         r.limits.altitude.push_back({AltitudeBand::Datum::ground, -kInfinity, kInfinity});
       }},
      {"the constraint 'short'", [](Request& r) {
         r.constraints.push_back({"short", std::make_shared<ShortLegs>()});
       }}};
  for (const auto& [name, set] : rules) {
    Request request = plain;
    set(request);
    const PlanResult result = anya()->plan(request);
    EXPECT_EQ(result.status, PlanStatus::invalid_problem) << name;
    EXPECT_EQ(result.message, "anya cannot satisfy " + name + ": use theta_star");
  }
  EXPECT_EQ(anya()->plan(plain).status, PlanStatus::solved);
  EXPECT_NE(testing::parameter_problems("planner", "anya", "{corner: free_box}"), "");
}

/// Among solids, cells are those of the plugin, and the clearance grows the obstacles: what is
/// found is judged exactly, wherever the ends are.
TEST(Anya, KeepsTheClearanceAmongSolids) {
  SplitMix64 random(5);
  const auto planner = make_planner("anya", "{cell_m: [7, 9, 10]}");
  const auto grid = make_planner("astar", "{cell_m: [7, 9, 10], moves: cells, corner: free_box}");
  int solved = 0;
  for (int n = 0; n < 200; ++n) {
    std::vector<Shape> solids;
    for (int k = 0; k < 25; ++k) {
      const Vec3 at(300 * random.uniform(), 300 * random.uniform(), 5);
      solids.emplace_back(Sphere{at, 4 + 14 * random.uniform()});
      const Vec3 low(300 * random.uniform(), 300 * random.uniform(), -1);
      solids.emplace_back(BoxShape{{low, low + Vec3(30 * random.uniform(), 8, 20)}});
    }
    Request request = testing::request_in(
        testing::world_of(std::move(solids)), {10 * random.uniform(), 300 * random.uniform(), 5},
        {300 - 10 * random.uniform(), 300 * random.uniform(), 5}, {{0, 0, 0}, {300, 300, 10}});
    request.level_m = 5;
    request.vehicle.radius_m = n % 2 == 0 ? 0 : 3 * random.uniform();
    const PlanResult result = planner->plan(request);
    const PlanResult by_grid = grid->plan(request);
    EXPECT_TRUE(result.status == by_grid.status || by_grid.status == PlanStatus::no_route) << n;
    if (result.status == PlanStatus::solved) {
      ++solved;
      const CheckResult judged = check(result.route, request);
      ASSERT_TRUE(judged.ok()) << n << ": " << judged.violations.front().message;
      EXPECT_LE(length(result.route),
                length(by_grid.route.empty() ? result.route : by_grid.route) * (1 + 1e-9))
          << n;
    }
  }
  EXPECT_GT(solved, 80);
}

TEST(Anya, EndsWithinTheToleranceWhereNoLegJoinsTheGoal) {
  // A thin wall between the goal and the only column of free cells.
  Request request =
      testing::request_in(testing::world_of({BoxShape{{{10.2, -1, -1}, {10.4, 101, 11}}}}),
                          {5, 5, 5}, {12, 85, 5}, {{0, 0, 0}, {20, 100, 10}});
  request.level_m = 5;
  const auto planner = make_planner("anya", "{cell_m: [10, 10, 10]}");
  const PlanResult without = planner->plan(request);
  EXPECT_EQ(without.status, PlanStatus::no_route);
  EXPECT_TRUE(without.proved);
  EXPECT_EQ(without.message.find("no route: the goal cannot join the lattice"), 0u)
      << without.message;
  EXPECT_EQ(counter(without, "expanded"), 0);
  request.goal.tolerance_m = 8;
  const PlanResult within = planner->plan(request);
  ASSERT_EQ(within.status, PlanStatus::solved) << within.message;
  ASSERT_EQ(within.route, (Route{{5, 5, 5}, {5, 85, 5}}));
  EXPECT_TRUE(check(within.route, request).ok());
  // Cells farther away than a link were not examined.
  request.goal = {{17, 85, 5}, 11};
  const PlanResult beyond = planner->plan(request);
  EXPECT_EQ(beyond.status, PlanStatus::no_route);
  EXPECT_FALSE(beyond.proved);
}

TEST(Anya, EndsWithinTheToleranceWhereTheGoalIsShutIn) {
  const auto planner = make_planner("anya", "{corner: one_free}");
  Request request = drawn("..#G\n...#\n.#..\nS#..");
  const PlanResult without = planner->plan(request);
  EXPECT_EQ(without.status, PlanStatus::no_route);
  request.goal.tolerance_m = 1.5;
  const PlanResult within = planner->plan(request);
  ASSERT_EQ(within.route, (Route{{0.5, 0.5, 0.5}, {1, 2, 0.5}, {2.5, 2.5, 0.5}}));
  // The budget is that of both searches.
  Request there = request;
  there.goal = {within.route.back(), 0};
  const std::int64_t all = counter(within, "expanded");
  EXPECT_GT(counter(without, "expanded"), 0);
  EXPECT_EQ(all, counter(without, "expanded") + counter(planner->plan(there), "expanded"));
  request.budget.max_iterations = std::uint64_t(all - 1);
  const PlanResult part = planner->plan(request);
  EXPECT_EQ(part.status, PlanStatus::timed_out);
  EXPECT_EQ(counter(part, "expanded"), all - 1);
}

TEST(Anya, JoinsEndsInClosedCellsByStraightLegs) {
  // Both ends lie in cells that a thin post closes.
  Request request = testing::request_in(testing::world_of({BoxShape{{{12, 12, -1}, {13, 13, 11}}},
                                                           BoxShape{{{86, 83, -1}, {87, 84, 11}}}}),
                                        {16, 16, 5}, {82, 88, 5}, {{0, 0, 0}, {100, 100, 10}});
  request.level_m = 5;
  // The lattice begins at the start unless a layer has cells: the goal's cell is then closed.
  const PlanResult result = make_planner("anya", "{cell_m: [10, 10, 10]}")->plan(request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_EQ(result.route.front(), request.start.position);
  EXPECT_EQ(result.route.back(), request.goal.position);
  EXPECT_TRUE(check(result.route, request).ok());
  EXPECT_LT(length(result.route), 1.05 * std::hypot(66, 72));
}

/// Records the events of a search.
class Kept final : public Trace {
 public:
  void add(const TraceEvent& event) override { events.push_back(event); }
  std::vector<TraceEvent> events;
};

TEST(Anya, TracesRootsInTheOrderOfTheirEstimates) {
  SplitMix64 random(3);
  const auto planner = anya();
  std::size_t turns = 0;
  for (int n = 0; n < 100; ++n) {
    const Map map = random_map(random, 60, 50, 0.3);
    const std::vector<int> free = map.free_cells();
    Request request = map.request(free.front(), free.back());
    Kept trace;
    request.trace = &trace;
    const PlanResult result = planner->plan(request);
    double f = 0;
    for (const TraceEvent& event : trace.events) {
      ASSERT_EQ(event.kind, TraceEvent::Kind::expanded);
      ASSERT_GE(event.value, f - 1e-9);
      f = event.value;
      turns += event.parent >= 0;
    }
    if (result.status == PlanStatus::solved) {
      EXPECT_GE(length(result.route), f - 1e-9) << "an estimate was too long";
    }
  }
  EXPECT_GT(turns, 1000u);
}

TEST(Anya, TraitsPromiseTheShortestOnALevel) {
  const Traits traits = anya()->traits();
  EXPECT_TRUE(traits.complete && traits.optimal && traits.any_angle && traits.planar);
  EXPECT_FALSE(traits.spatial);
}
}  // namespace
}  // namespace altiplan::anya_test
