// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "altiplan/error.hpp"
#include "support/support.hpp"

namespace altiplan::spatial_slicing_test {
namespace {

using testing::counter;
using testing::draw;
using testing::Drawn;
using testing::make_planner;

PlanResult plan(const Request& request, const std::string& parameters = "{}") {
  return make_planner("spatial_slicing", parameters)->plan(request);
}

Drawn level(const std::string& rows) {
  Drawn drawn = draw({rows});
  drawn.request.level_m = 0.5;
  return drawn;
}

TEST(SpatialSlicing, KeepsToTheLineWhereItIsFree) {
  const Drawn open = level("......G\n.......\nS......");
  const PlanResult result = plan(open.request);
  EXPECT_EQ(result.route, (Route{{0.5, 0.5, 0.5}, {6.5, 2.5, 0.5}}));
  EXPECT_EQ(counter(result, "expanded"), 5);
  EXPECT_EQ(counter(result, "planes"), 5);
  EXPECT_EQ(counter(result, "planes_moved"), 0);
}

TEST(SpatialSlicing, MovesAPointOnItsPlaneAndAimsAtTheGoalAgain) {
  const Drawn wall = level(".......\n.......\nS..#..G\n...#...");
  const PlanResult result = plan(wall.request);
  // From (2.5, 1.5) the leg runs along the wall half way: only (3.5, 3.5) is beyond it.
  EXPECT_EQ(result.route,
            (Route{{0.5, 1.5, 0.5}, {2.5, 1.5, 0.5}, {3.5, 3.5, 0.5}, {6.5, 1.5, 0.5}}));
  EXPECT_EQ(counter(result, "planes_moved"), 1);
  EXPECT_TRUE(check(result.route, wall.request).ok());
}

TEST(SpatialSlicing, ARouteIsNoLongerThanAllowedEvenIfOneThatEndsShortOfTheGoalIsNot) {
  Drawn open = level("S.........G");
  open.request.goal.tolerance_m = 2.5;
  open.request.limits.max_route_length = 9.5;
  const PlanResult shorter = plan(open.request);
  ASSERT_EQ(shorter.status, PlanStatus::solved) << shorter.message;
  EXPECT_EQ(length(shorter.route), 9);
  EXPECT_TRUE(check(shorter.route, open.request).ok());
  open.request.limits.max_route_length = 7;
  const PlanResult none = plan(open.request);
  EXPECT_EQ(none.status, PlanStatus::no_route);
  EXPECT_NE(none.message.find("route_length"), std::string::npos) << none.message;
}

TEST(SpatialSlicing, SaysOnWhichPlaneItEndsAndWhy) {
  const PlanResult shut = plan(level("...#...\nS..#..G\n...#...").request);
  EXPECT_EQ(shut.status, PlanStatus::no_route);
  EXPECT_FALSE(shut.proved);
  EXPECT_EQ(shut.message,
            "no route: on plane 3 of 5, at x = 4 m, from (3, 2, 1) none of 0 free cells can be "
            "reached; refused legs: blocked cells (1)");
  // No point of the last plane sees the goal.
  const PlanResult last = plan(level("..#.\nS.#.\n...#\n..#G").request);
  EXPECT_EQ(last.status, PlanStatus::no_route);
  EXPECT_NE(last.message.find("none of 1 free cells can be reached and continued to the goal"),
            std::string::npos)
      << last.message;
}

TEST(SpatialSlicing, OnePlaneIsTheStraightLeg) {
  EXPECT_EQ(plan(level("S..\n...\nG..").request).route, (Route{{0.5, 2.5, 0.5}, {0.5, 0.5, 0.5}}));
  EXPECT_EQ(plan(level("S.\n.G").request).route.size(), 2u);
  const PlanResult shut = plan(level("S..\n#..\nG..").request);
  EXPECT_EQ(shut.status, PlanStatus::no_route);
  EXPECT_NE(shut.message.find("no plane lies between start and goal, at x = 1 and 1 m, and the "
                              "straight leg is not free; refused legs: blocked cells (1)"),
            std::string::npos)
      << shut.message;
  EXPECT_EQ(plan(level("S..\n#..\nG..").request, "{axis: y}").status, PlanStatus::solved);
  EXPECT_EQ(plan(level("S..\n#..\nG..").request, "{axis: auto}").status, PlanStatus::solved);
}

TEST(SpatialSlicing, WaypointsOfAStraightStretchStayWhereALegWouldBeTooLong) {
  Drawn open = level("S.........G");
  open.request.limits.max_leg = 3;
  const PlanResult result = plan(open.request);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
  EXPECT_EQ(result.route.size(), 5u);
  EXPECT_TRUE(check(result.route, open.request).ok());
}

TEST(SpatialSlicing, EndsWithinTheToleranceWhereNoLegLeadsToTheGoal) {
  const auto end = [](const std::string& rows, double tolerance) {
    Drawn drawn = level(rows);
    EXPECT_EQ(plan(drawn.request).status, PlanStatus::no_route);
    drawn.request.goal.tolerance_m = tolerance;
    const PlanResult within = plan(drawn.request);
    EXPECT_TRUE(check(within.route, drawn.request).ok()) << within.message;
    return within.route.empty() ? Vec3(0, 0, 0) : within.route.back();
  };
  // On the last plane, and before a closed one.
  EXPECT_NEAR((end("....\nS...\n...#\n..#G", 1.5) - Vec3(2.5, 2.5 - 4.0 / 3, 0.5)).norm(), 0, 1e-9);
  EXPECT_EQ(end("...##\nS..#.\n...#G", 2.1), Vec3(2.5, 1, 0.5));
}

TEST(SpatialSlicing, LimitOnTheRoutesLength) {
  Drawn wall = level(".......\n.......\nS..#..G\n...#...");
  const double long_way = length(plan(wall.request).route);
  wall.request.limits.max_route_length = long_way;
  EXPECT_EQ(plan(wall.request).status, PlanStatus::solved);
  wall.request.limits.max_route_length = long_way - 0.1;
  const PlanResult refused = plan(wall.request);
  EXPECT_EQ(refused.status, PlanStatus::no_route);
  EXPECT_NE(refused.message.find("route_length"), std::string::npos) << refused.message;
}

/// Records the events of a search.
class Kept final : public Trace {
 public:
  void add(const TraceEvent& event) override { events.push_back(event); }
  std::vector<TraceEvent> events;
};

TEST(SpatialSlicing, BudgetStopAndTraceCountPointsLookedAt) {
  Request request = level(".......\n.......\nS..#..G\n...#...").request;
  Kept trace;
  request.trace = &trace;
  const PlanResult whole = plan(request);
  ASSERT_EQ(whole.status, PlanStatus::solved);
  const auto all = std::uint64_t(counter(whole, "expanded"));
  EXPECT_EQ(trace.events.size(), all);
  EXPECT_EQ(trace.events.front().parent, -1);
  EXPECT_NEAR(trace.events.back().value, length(whole.route), 1e-9);

  request.trace = nullptr;
  for (const std::uint64_t maximum : {std::uint64_t(0), all - 1}) {
    request.budget.max_iterations = maximum;
    const PlanResult some = plan(request);
    EXPECT_EQ(some.status, PlanStatus::timed_out);
    EXPECT_TRUE(some.budget_hit);
    EXPECT_EQ(counter(some, "expanded"), std::int64_t(maximum));
  }
  request.budget.max_iterations = all;
  EXPECT_EQ(plan(request).route, whole.route);
  std::stop_source stop;
  stop.request_stop();
  request.budget.stop = stop.get_token();
  EXPECT_EQ(plan(request).status, PlanStatus::cancelled);
}

TEST(SpatialSlicing, MemoryIsCheckedBeforeItIsTaken) {
  Request request =
      testing::request_in(World(), {5, 5, 5}, {95, 95, 5}, {{0, 0, 0}, {100, 100, 10}});
  EXPECT_THROW(plan(request, "{cell_m: [0.01, 0.01, 0.01]}"), ParameterError);
  request.budget.max_memory_bytes = 20'000;
  const PlanResult result = plan(request, "{cell_m: [1, 1, 1]}");
  EXPECT_EQ(result.status, PlanStatus::timed_out);
  EXPECT_NE(result.message.find("MiB"), std::string::npos) << result.message;
}

TEST(SpatialSlicing, SolvesSimpleCitiesOfThePaperAndFewComplexOnes) {
  const auto solved = [](const std::string& kind, const Vec3& start, const Vec3& goal) {
    int count = 0;
    for (int seed = 0; seed < 100; ++seed) {
      static const World kEmpty;
      Site site;
      site.before = &kEmpty;
      site.start = start;
      site.goal = goal;
      const Request request = testing::request_in(
          testing::world_of(
              testing::make_environment(
                  "city", "{generate: " + kind + ", seed: " + std::to_string(seed) + "}", site),
              "city"),
          start, goal, {{0, 0, 0}, {800, 800, 1000}});
      const PlanResult result = plan(request);
      if (result.status == PlanStatus::solved) {
        ++count;
        EXPECT_TRUE(check(result.route, request).ok()) << kind << " " << seed;
      }
    }
    return count;
  };
  EXPECT_EQ(solved("simple", {15, 15, 15}, {675, 645, 995}), 100);
  const int complex = solved("complex", {15, 25, 45}, {675, 645, 45});
  EXPECT_GE(complex, 5);
  EXPECT_LE(complex, 20);
}
}  // namespace
}  // namespace altiplan::spatial_slicing_test
