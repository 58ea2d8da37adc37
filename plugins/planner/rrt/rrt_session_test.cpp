// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "altiplan/kit/layers/obstacle_set.hpp"
#include "reference/pop_ups.hpp"
#include "support/support.hpp"

namespace altiplan::rrt_session_test {
namespace {

using testing::make_planner;

Request over_the_plain(std::uint64_t seed) {
  Request request =
      testing::request_in(testing::world_of(std::vector<Shape>{Sphere{{100, 100, 20}, 25}}),
                          {5, 100, 50}, {390, 100, 50}, {{0, 0, 0}, {400, 200, 100}});
  request.limits.max_turn_horizontal = radians(60);
  request.random = RandomStream(seed);
  return request;
}

std::map<std::string, std::int64_t> counters(const PlanResult& result) {
  std::map<std::string, std::int64_t> all;
  for (const Counter& counter : result.counters) {
    all[counter.name] = counter.value;
  }
  return all;
}

/// A sphere around the middle of a route, as a change of the request's world.
Change pop_up_on(const Route& route, Request& request) {
  const auto shape =
      std::make_shared<kit::ShapeLayer>(std::vector<Shape>{Sphere{route[route.size() / 2], 25}});
  request.world =
      std::make_shared<const World>(request.world->with({"pop_up", "sphere", shape, true}));
  return {Change::Kind::add, "pop_up", shape->bounds()};
}

/// The nodes in the tree after all its events.
struct Nodes : Trace {
  void add(const TraceEvent& event) override {
    if (event.kind == TraceEvent::Kind::added) {
      EXPECT_TRUE(given.insert(event.node).second) << "a number used again";
      at[event.node] = event.position;
    } else if (event.kind == TraceEvent::Kind::removed) {
      EXPECT_EQ(at.erase(event.node), 1u);
    }
  }
  std::set<std::int64_t> given;
  std::map<std::int64_t, Vec3> at;
};

TEST(RrtSession, AnUpdateWithoutAChangeKeepsTheTree) {
  Request request = over_the_plain(1);
  const auto session = make_planner("rrt")->begin(request);
  const PlanResult first = session->result();
  ASSERT_EQ(first.status, PlanStatus::solved) << first.message;
  const PlanResult& same = session->update(request.start, request.goal, request.world, {}, {});
  EXPECT_EQ(same.route, first.route);
  EXPECT_EQ(counters(same)["expanded"], 0);
  EXPECT_EQ(counters(same)["nodes_kept"], counters(first)["nodes"]);
  EXPECT_EQ(counters(same)["route_kept_percent"], 100);

  // Half-way along the second leg the rest of the route is flown unchanged.
  const State state =
      testing::on_route(first.route, 1.5 * (first.route[1] - first.route[0]).norm(), 20);
  request.start = state;
  const PlanResult& rest = session->update(state, request.goal, request.world, {}, {});
  ASSERT_EQ(rest.status, PlanStatus::solved) << rest.message;
  EXPECT_EQ(counters(rest)["expanded"], 0);
  EXPECT_EQ(rest.route.front(), state.position);
  EXPECT_TRUE(std::equal(rest.route.begin() + 1, rest.route.end(), first.route.begin() + 2));
}

// During a flight with threats that appear and disappear, a moving goal, and the vehicle off its
// route.
TEST(RrtSession, KeptNodesAreTheSameAndTheCountersAddUp) {
  for (const char* cut_off : {"drop", "reconnect"}) {
    for (std::uint64_t seed = 0; seed < 25; ++seed) {
      SCOPED_TRACE(std::string(cut_off) + " " + std::to_string(seed));
      RandomStream random = RandomStream(seed).sub("flight");
      Request request = over_the_plain(seed);
      Nodes nodes;
      request.trace = &nodes;
      const auto session =
          make_planner("rrt", std::string("{cut_off: ") + cut_off + "}")->begin(request);
      ASSERT_EQ(session->result().status, PlanStatus::solved);
      for (int update = 0; update < 6; ++update) {
        const std::int64_t before = counters(session->result())["nodes"];
        ASSERT_EQ(std::int64_t(nodes.at.size()), before);
        const std::map<std::int64_t, Vec3> known = nodes.at;
        if (session->result().status == PlanStatus::solved && update % 4 != 3) {
          request.start = testing::on_route(session->result().route, random.uniform(0, 60), 20);
          request.start.position += 0.01 * (update % 2) * Vec3(1, 1, 1);
        }
        if (update % 3 == 2) {
          request.goal.position.y() = random.uniform(20, 180);
        }
        const Vec3 centre = random.in({{150, 40, 30}, {350, 160, 70}});
        const auto shape =
            std::make_shared<kit::ShapeLayer>(std::vector<Shape>{Sphere{centre, 25}});
        std::vector<Change> changes = {
            {Change::Kind::add, "new" + std::to_string(update), shape->bounds()}};
        World world = request.world->with({changes[0].layer, "sphere", shape, true});
        if (update > 1) {
          const std::string old = "new" + std::to_string(update - 2);
          changes.push_back({Change::Kind::remove, old, world.find(old)->environment->bounds()});
          world = world.without(old);
        }
        request.world = std::make_shared<const World>(std::move(world));
        const PlanResult& result =
            session->update(request.start, request.goal, request.world, changes, {});
        std::map<std::string, std::int64_t> counted = counters(result);
        EXPECT_EQ(counted["nodes_kept"] + counted["nodes_pruned"], before);
        EXPECT_EQ(counted["nodes_kept"] + counted["nodes_added"], counted["nodes"]);
        EXPECT_EQ(counted["nodes"], std::int64_t(nodes.at.size()));
        std::int64_t kept = 0;
        for (const auto& [node, p] : nodes.at) {
          const auto found = known.find(node);
          kept += found != known.end() && found->second == p ? 1 : 0;
        }
        EXPECT_EQ(kept, counted["nodes_kept"]);
        if (result.status == PlanStatus::solved) {
          EXPECT_TRUE(check(result.route, request).ok());
        } else {
          EXPECT_EQ(result.status, PlanStatus::invalid_problem) << result.message;
        }
      }
    }
  }
}

// From far off its route the vehicle has a valid leg to it, but not the length.
TEST(RrtSession, TheLimitOnLengthHoldsWhereTheVehicleIsOffItsRoute) {
  for (const char* cut_off : {"drop", "reconnect"}) {
    SCOPED_TRACE(cut_off);
    Request request = over_the_plain(2);
    request.limits.max_turn_horizontal = kPi;
    const auto planner =
        make_planner("rrt", std::string("{max_iterations: 2000, cut_off: ") + cut_off + "}");
    request.limits.max_route_length = length(planner->plan(request).route) + 1;
    Nodes nodes;
    request.trace = &nodes;
    const auto session = planner->begin(request);
    ASSERT_EQ(session->result().status, PlanStatus::solved) << session->result().message;
    const std::map<std::int64_t, Vec3> known = nodes.at;
    request.start.position = {5, 190, 50};
    const PlanResult& result = session->update(request.start, request.goal, request.world, {}, {});
    EXPECT_TRUE(result.status == PlanStatus::no_route || check(result.route, request).ok());
    // The discarded end was not kept.
    const auto kept = std::count_if(nodes.at.begin(), nodes.at.end(),
                                    [&](const auto& node) { return known.count(node.first) > 0; });
    EXPECT_EQ(counters(result)["nodes_kept"], kept);
    EXPECT_EQ(counters(result)["nodes_added"], std::int64_t(nodes.at.size()) - kept);
  }
}

// Only the vehicle's position has changed: the rest of its route is near.
TEST(RrtSession, TheWayBackToTheRouteTakesLessThanAPlan) {
  std::int64_t back = 0;
  std::int64_t planned = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Request request = over_the_plain(seed);
    request.limits.min_leg = 4;
    const auto planner = make_planner("rrt");
    const auto session = planner->begin(request);
    request.start = testing::on_route(session->result().route, 150, 20);
    request.start.position.y() += 30;
    request.start.velocity = {0, 20, 0};
    const PlanResult& result = session->update(request.start, request.goal, request.world, {}, {});
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    EXPECT_TRUE(check(result.route, request).ok());
    back += counters(result)["expanded"];
    planned += counters(planner->plan(request))["expanded"];
  }
  EXPECT_LT(back, planned / 2);
}

// Searches for paths past a threat with legs of any length, and grows along them with short ones.
TEST(RrtSession, ALimitOnLegsLeavesTheRepairQuick) {
  std::int64_t repaired = 0;
  std::int64_t planned = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Request request = over_the_plain(seed);
    request.limits.max_leg = 8;
    const auto planner = make_planner("rrt");
    const auto session = planner->begin(request);
    const std::vector<Change> changes = {pop_up_on(session->result().route, request)};
    const PlanResult& result =
        session->update(request.start, request.goal, request.world, changes, {});
    ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
    EXPECT_TRUE(check(result.route, request).ok());
    repaired += counters(result)["expanded"];
    planned += counters(planner->plan(request))["expanded"];
  }
  EXPECT_LT(repaired, planned / 2);
}

// The old root is loose at the position of the new one.
TEST(RrtSession, AVehicleThatTurnsOnTheSpotIsHeldToItsHeading) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Request request = over_the_plain(seed);
    const auto session = make_planner("rrt")->begin(request);
    request.start.position = testing::on_route(session->result().route, 100, 20).position;
    for (const double heading : {0.0, 90.0, 200.0, 300.0}) {
      request.start.velocity = 20 * Vec3(std::cos(radians(heading)), std::sin(radians(heading)), 0);
      const PlanResult& result =
          session->update(request.start, request.goal, request.world, {}, {});
      ASSERT_EQ(result.status, PlanStatus::solved) << result.message;
      const CheckResult found = check(result.route, request);
      EXPECT_TRUE(found.ok()) << found.violations.front().message;
    }
  }
}

TEST(RrtSession, AnUpdateMendsWhatTheOneBeforeHadNoBudgetFor) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Request request = over_the_plain(seed);
    const auto planner = make_planner("rrt");
    const auto session = planner->begin(request);
    const auto late = planner->begin(request);
    const std::vector<Change> changes = {pop_up_on(session->result().route, request)};
    const PlanResult& at_once =
        session->update(request.start, request.goal, request.world, changes, {});
    ASSERT_EQ(at_once.status, PlanStatus::solved) << at_once.message;
    Budget none;
    none.max_iterations = 0;
    EXPECT_EQ(late->update(request.start, request.goal, request.world, changes, none).status,
              PlanStatus::timed_out);
    const PlanResult& then = late->update(request.start, request.goal, request.world, {}, {});
    ASSERT_EQ(then.status, PlanStatus::solved) << then.message;
    EXPECT_TRUE(check(then.route, request).ok());
    EXPECT_LE(counters(then)["expanded"], counters(at_once)["expanded"] + 200);
  }
}

// Back and forth between two goals: what is cut off behind the vehicle does not accumulate.
TEST(RrtSession, ALongFlightDoesNotGatherNodes) {
  Request request = over_the_plain(1);
  const auto session = make_planner("rrt")->begin(request);
  for (int update = 0; update < 2000; ++update) {
    const PlanResult& last = session->result();
    ASSERT_EQ(last.status, PlanStatus::solved) << last.message;
    request.start = testing::on_route(last.route, 15, 20);
    if ((request.start.position - request.goal.position).norm() < 40) {
      request.goal.position.x() = request.goal.position.x() > 200 ? 10 : 390;
    }
    session->update(request.start, request.goal, request.world, {}, {});
    EXPECT_LT(counters(session->result())["nodes"], 3000);
  }
}

TEST(RrtSession, AfreshIsAPlanFromThere) {
  Request request = over_the_plain(3);
  const auto planner = make_planner("rrt", "{cut_off: afresh}");
  const auto session = planner->begin(request);
  request.start = testing::on_route(session->result().route, 40, 20);
  const PlanResult& result = session->update(request.start, request.goal, request.world, {}, {});
  EXPECT_EQ(result.route, planner->plan(request).route);
  EXPECT_EQ(counters(result)["nodes_kept"], 0);
}
}  // namespace
}  // namespace altiplan::rrt_session_test
