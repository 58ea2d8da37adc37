// SPDX-License-Identifier: Apache-2.0
#include "host/flight/flight.hpp"

#include <gtest/gtest.h>

#include "altiplan/error.hpp"
#include "flight_scene.hpp"

namespace altiplan::host::flight_test {
namespace {

TEST(Flight, WithoutTheUnknownFollowsTheRoute) {
  FlightScene scene;
  const FlightResult result = fly(scene.setup);
  expect_flown(result, 0);
  EXPECT_TRUE(result.handovers.empty());
  for (const auto& [t, p] : result.track) {
    EXPECT_NEAR(p.y(), 15000, 1e-9);
    EXPECT_NEAR((p.x() - 2000) / 30, t, 1e-6);
  }
  EXPECT_EQ(result.track.back().second, scene.setup.route.back());
  EXPECT_TRUE(std::any_of(result.track.begin(), result.track.end(),
                          [&](const auto& at) { return at.second == scene.setup.route[1]; }));
  EXPECT_NEAR(*result.min_separation_m, 1500, 1e-3);
  EXPECT_NEAR(*result.measures.duration_s, 26000.0 / 30, 1e-6);
}

TEST(Flight, PilotFliesAroundWhatWasNotKnownAndHandsBack) {
  FlightScene scene;
  scene.hide(layer("unknown", post(17000, 15050, 800)));
  const FlightResult result = fly(scene.setup);
  expect_flown(result, 2);
  EXPECT_EQ(result.handovers.size(), 2u);
  EXPECT_NE(result.handovers[0].why.find("'unknown'"), std::string::npos);
  EXPECT_GT(*result.min_separation_m, 2);
  EXPECT_LT(result.measures.length_m, 1.06 * 26000);
  EXPECT_LE(result.measures.max_turn_deg.value(), 30 + 1e-6);
}

TEST(Flight, FollowingAloneCollides) {
  FlightScene scene;
  scene.hide(layer("unknown", post(17000, 15050, 800)));
  scene.follow_alone();
  const FlightResult result = fly(scene.setup);
  EXPECT_EQ(result.status, RunStatus::collided);
  EXPECT_EQ(result.collisions, 1);
  EXPECT_FALSE(result.reached);
  EXPECT_FALSE(result.check.ok());
  EXPECT_LT(result.min_separation_m, 0);
  EXPECT_GT(result.min_separation_m, -30) << "no deeper than a step";
  EXPECT_NE(result.message.find("'unknown'"), std::string::npos) << result.message;
}

TEST(Flight, StartingInsideTheUnknownIsACollision) {
  FlightScene scene;
  scene.hide(layer("unknown", post(2000, 15000, 800)));
  const FlightResult result = fly(scene.setup);
  EXPECT_EQ(result.status, RunStatus::collided);
  EXPECT_EQ(result.collisions, 1);
  EXPECT_EQ(result.track.size(), 1u);
}

TEST(Flight, CollisionDoesNotDependOnTheTimeStep) {
  // A wall of 1 cm, and a mover that is on the route for a fifth of a second.
  for (const double step_s : {0.25, 1.0, 7.0, 60.0}) {
    FlightScene wall;
    wall.hide(layer("wall", BoxShape{{{17000, 14000, 0}, {17000.01, 16000, 4000}}}));
    wall.follow_alone();
    wall.setup.step_s = step_s;
    EXPECT_EQ(fly(wall.setup).status, RunStatus::collided) << step_s;
    FlightScene mover;
    mover.hide_moving({17000, 15000, 500}, 500, {0, 200, 0}, 20);
    mover.follow_alone();
    mover.setup.step_s = step_s;
    const FlightResult met = fly(mover.setup);
    EXPECT_EQ(met.status, RunStatus::collided) << step_s;
    EXPECT_EQ(met.check.violations.front().constraint, "collision");
    mover.hide_moving({17000, 15000, 500}, 503, {0, 200, 0}, 20);
    EXPECT_EQ(fly(mover.setup).status, RunStatus::solved) << step_s;
  }
}

TEST(Flight, IsNotKnownBeforeItIsInSensingRange) {
  for (const double sensing_m : {1500.0, 2500.0}) {
    FlightScene scene;
    scene.hide(layer("unknown", post(17000, 15050, 800)));
    scene.setup.request.vehicle.sensing_m = sensing_m;
    const FlightResult result = fly(scene.setup);
    expect_flown(result, 2);
    const double edge = 17000 - std::sqrt(800.0 * 800 - 50 * 50);
    const double met_s = (edge - sensing_m - 2000) / 30;
    EXPECT_GE(result.handovers[0].at_s, met_s - 2);
    EXPECT_LE(result.handovers[0].at_s, met_s + 2);
  }
}

TEST(Flight, MovingObstacleIsEvaded) {
  FlightScene scene;
  scene.hide_moving({14000, 15000, 500}, 400, {-3, 12, 0}, 300);
  const FlightResult result = fly(scene.setup);
  expect_flown(result, 2);
  scene.follow_alone();
  EXPECT_EQ(fly(scene.setup).status, RunStatus::collided);
}

TEST(Flight, RejectionSaysWhenAndWhere) {
  FlightScene scene;
  scene.follow_alone();
  scene.setup.route = {
      {2000, 15000, 500}, {11000, 15000, 500}, {12000, 15000, 900}, {28000, 15000, 500}};
  const FlightResult steep = fly(scene.setup);
  EXPECT_EQ(steep.status, RunStatus::rejected);
  EXPECT_TRUE(steep.reached);
  EXPECT_EQ(steep.message.find("reached the goal, but at 300.0 s, near (11000, 15000, 500) m: "),
            0U)
      << steep.message;
  // Of several the worst.
  scene.setup.route = {{2000, 15000, 500},  {11000, 15000, 500}, {12000, 15000, 900},
                       {20000, 15000, 900}, {20500, 15000, 500}, {28000, 15000, 500}};
  const std::string worst = fly(scene.setup).message;
  EXPECT_NE(worst.find(", near (20000, 15000, 900) m: "), std::string::npos) << worst;
  // No place causes a length.
  scene.setup.request.limits.max_climb = kPi / 2;
  scene.setup.request.limits.max_route_length = 26000;
  EXPECT_EQ(fly(scene.setup).message,
            "reached the goal, but the flight is longer than the maximum route length");
}

TEST(Flight, EventsAddRemoveAndMove) {
  FlightEvent pop_up;
  pop_up.at_s = 200;
  pop_up.id = "pop_up";
  pop_up.layer = layer("pop_up", post(17000, 15050, 800), false);
  FlightScene scene;
  scene.setup.events = {pop_up};
  const FlightResult evaded = fly(scene.setup);
  expect_flown(evaded, 2);
  EXPECT_GT(evaded.handovers[0].at_s, 200);

  FlightEvent gone;
  gone.kind = FlightEvent::Kind::remove;
  gone.id = "pop_up";
  gone.when_near = {{11000, 15000, 500}, 500};
  scene.setup.events = {pop_up, gone};
  EXPECT_TRUE(fly(scene.setup).handovers.empty());

  FlightEvent aside = gone;
  aside.kind = FlightEvent::Kind::move;
  aside.vector = {0, 3000, 0};
  scene.setup.events = {pop_up, aside};
  EXPECT_TRUE(fly(scene.setup).handovers.empty());

  FlightEvent into;
  into.kind = FlightEvent::Kind::move;
  into.id = "beside";
  into.at_s = 10;
  into.vector = {8000, 2050, 0};
  into.known = true;
  scene.setup.events = {into};
  expect_flown(fly(scene.setup), 2);
  scene.follow_alone();
  EXPECT_EQ(fly(scene.setup).status, RunStatus::collided);
}

TEST(Flight, EventThatNamesNothingFails) {
  FlightScene scene;
  FlightEvent gone;
  gone.kind = FlightEvent::Kind::remove;
  gone.id = "nobody";
  gone.at_s = 5;
  scene.setup.events = {gone};
  const FlightResult result = fly(scene.setup);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_NE(result.message.find("'nobody'"), std::string::npos);
}

TEST(Flight, GoalMoves) {
  FlightScene scene;
  FlightEvent away;
  away.kind = FlightEvent::Kind::move_goal;
  away.at_s = 600;
  away.vector = {26000, 18000, 700};
  scene.setup.events = {away};
  const FlightResult result = fly(scene.setup);
  expect_flown(result, 0);
  EXPECT_EQ(result.track.back().second, away.vector);
}

/// Answers with one fixed detour through a point.
class Detour final : public Session {
 public:
  explicit Detour(const Vec3& by) : by_(by) {}
  std::vector<Change> changes;
  State asked_from;

 private:
  const PlanResult& do_result() const override { return result_; }
  const PlanResult& do_update(const State& state, const Goal& goal, std::shared_ptr<const World>,
                              std::span<const Change> news, const Budget&) override {
    asked_from = state;
    changes.assign(news.begin(), news.end());
    result_.status = PlanStatus::solved;
    result_.route = {state.position, by_, goal.position};
    result_.counters = {{"expanded", 3}};
    return result_;
  }
  Vec3 by_;
  PlanResult result_;
};

TEST(Flight, ReplansAroundWhatBlocksTheRest) {
  FlightScene scene;
  scene.hide(layer("unknown", post(17000, 15050, 800)));
  scene.follow_alone();
  Detour detour({17000, 13000, 500});
  scene.setup.replanner = &detour;
  scene.setup.replan_step = "route";
  scene.setup.replan_latency_s = 7;
  const FlightResult result = fly(scene.setup);
  EXPECT_EQ(result.status, RunStatus::solved) << result.message;
  ASSERT_EQ(result.replans.size(), 1u);
  EXPECT_EQ(result.replans[0].step, "route");
  EXPECT_EQ(result.replans[0].at_s, detour.asked_from.time_s);
  const double met_s = (17000 - std::sqrt(800.0 * 800 - 50 * 50) - 4000 - 2000) / 30;
  EXPECT_NEAR(result.replans[0].at_s, met_s + 7, 2.5);
  ASSERT_EQ(detour.changes.size(), 1u);
  EXPECT_EQ(detour.changes[0].layer, "unknown");
  EXPECT_TRUE(std::any_of(result.track.begin(), result.track.end(),
                          [](const auto& at) { return at.second == Vec3(17000, 13000, 500); }));
}

TEST(Flight, ReplanThatBreaksARuleIsNotFlownAndSaysSo) {
  FlightScene scene;
  scene.hide(layer("unknown", post(17000, 15050, 800)));
  scene.follow_alone();
  Detour back_first({4000, 15000, 500});  // a turn on the spot
  scene.setup.replanner = &back_first;
  scene.setup.replan_step = "route";
  scene.setup.route_request.limits.max_turn_horizontal = radians(30);
  const FlightResult result = fly(scene.setup);
  EXPECT_EQ(result.status, RunStatus::collided) << result.message;
  ASSERT_FALSE(result.replans.empty());
  for (const Replan& replan : result.replans) {
    EXPECT_EQ(replan.status, RunStatus::rejected);
    EXPECT_NE(replan.message.find("the judge found"), std::string::npos) << replan.message;
    EXPECT_NE(replan.message.find("turn"), std::string::npos) << replan.message;
  }
  EXPECT_NE(result.message.find("the last replan, by 'route', was not flown: the judge found"),
            std::string::npos)
      << result.message;
}

TEST(Flight, ReplansAtAnyChangeWhereAskedTo) {
  for (const ReplanWhen when : {ReplanWhen::unsafe, ReplanWhen::any_change}) {
    FlightScene scene;
    scene.hide(layer("aside", post(17000, 17500, 800)));
    Detour detour({20000, 14000, 500});
    scene.setup.replanner = &detour;
    scene.setup.when = when;
    const FlightResult result = fly(scene.setup);
    expect_flown(result, 0);
    EXPECT_EQ(result.replans.size(), when == ReplanWhen::any_change ? 1u : 0u);
  }
}

TEST(Flight, PilotMayFlyAllTheWay) {
  FlightScene scene;
  scene.setup.always = true;
  const FlightResult result = fly(scene.setup);
  expect_flown(result, 1);
  EXPECT_EQ(result.handovers.size(), 1u);
  EXPECT_EQ(result.handovers[0].at_s, 0);
}

TEST(Flight, EndsWhenItsTimeDoes) {
  FlightScene scene;
  scene.setup.max_time_s = 100;
  const FlightResult result = fly(scene.setup);
  EXPECT_EQ(result.status, RunStatus::not_reached);
  EXPECT_FALSE(result.reached);
  EXPECT_EQ(result.message.find("timed out after 100 s (max_time_s) at ("), 0U) << result.message;
}

TEST(Flight, TwoFlightsAreEqual) {
  FlightScene scene;
  scene.hide(layer("unknown", post(17000, 15050, 800)));
  scene.hide_moving({12000, 15000, 500}, 333, {-3, 12, 0}, 300);
  EXPECT_EQ(fly(scene.setup).track, fly(scene.setup).track);
}

TEST(Flight, RefusesARouteFromElsewhere) {
  FlightScene scene;
  scene.setup.route.edit().front().y() += 1;
  EXPECT_THROW(fly(scene.setup), Error);
}
}  // namespace
}  // namespace altiplan::host::flight_test
