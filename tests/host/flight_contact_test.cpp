// SPDX-License-Identifier: Apache-2.0
// What touches the vehicle ends the flight at once, whoever commands, and says how deep it lies
// inside.
#include <algorithm>
#include <set>

#include "altiplan/body.hpp"
#include "flight_scene.hpp"
#include "host/flight/track_judge.hpp"

namespace altiplan::host::flight_contact_test {
namespace {

constexpr double kAt = 200;  // s: when things happen
constexpr double kExact = 1e-6;

FlightEvent adding(Shape shape) {
  FlightEvent event;
  event.at_s = kAt;
  event.id = "pop_up";
  event.layer = layer("pop_up", std::move(shape), false);
  return event;
}

FlightEvent adding_mover(Shape shape, const Vec3& velocity, double since_s) {
  FlightEvent event;
  event.at_s = kAt;
  event.id = "pop_up";
  event.moving = MovingObstacle{"pop_up", std::move(shape), velocity, since_s, false};
  return event;
}

/// A wall that is moved, from 8 km aside, to where the vehicle is.
FlightEvent moving_in(FlightScene& scene, const Vec3& place) {
  const Vec3 away = place + Vec3(0, 8000, 0);
  scene.hide(layer("pop_up", BoxShape{{away - Vec3(100, 10, 300), away + Vec3(100, 30, 300)}}));
  FlightEvent event;
  event.kind = FlightEvent::Kind::move;
  event.at_s = kAt;
  event.id = "pop_up";
  event.vector = {0, -8000, 0};
  return event;
}

std::multiset<std::string> broken_in(const CheckResult& check) {
  std::multiset<std::string> names;
  for (const Violation& violation : check.violations) {
    names.insert(violation.constraint);
  }
  return names;
}

void expect_judged_alike(const FlightResult& flown, const FlightSetup& setup) {
  const TrackVerdict verdict = judge_track(flown.track, setup);
  EXPECT_EQ(broken_in(verdict.check), broken_in(flown.check));
  EXPECT_EQ(verdict.collisions, flown.collisions);
  EXPECT_EQ(verdict.reached, flown.reached);
}

void expect_met_at_once(const FlightSetup& setup, const Vec3& place, double depth) {
  const FlightResult result = fly(setup);
  EXPECT_EQ(result.status, RunStatus::collided) << result.message;
  EXPECT_EQ(result.collisions, 1);
  EXPECT_FALSE(result.reached);
  EXPECT_FALSE(result.check.ok());
  EXPECT_NE(result.message.find("'pop_up'"), std::string::npos) << result.message;
  EXPECT_GE(result.track.back().first, kAt - 1e-9);
  EXPECT_LT(result.track.back().first, kAt + 1);
  EXPECT_NEAR((result.track.back().second - place).norm(), 0, kExact);
  EXPECT_NEAR(result.min_separation_m.value(), -depth, kExact);
  expect_judged_alike(result, setup);
}

/// Each event over the vehicle with how deep it then lies inside.
void expect_all_met(const std::function<void(FlightScene&)>& commanded) {
  FlightScene undisturbed;
  commanded(undisturbed);
  const FlightResult before = fly(undisturbed.setup);
  const auto [time_s, place] = *std::find_if(before.track.begin(), before.track.end(),
                                             [](const auto& at) { return at.first >= kAt - 1e-9; });
  const Vec3 aside = place + Vec3(0, 10, 0);
  const std::vector<std::pair<FlightEvent, double>> cases = {
      {adding(Sphere{place, 40}), 40},
      {adding(Sphere{aside, 40}), 30},
      {adding(Sphere{aside, 11}), 1},
      {adding(Sphere{aside, 9}), -1},  // the vehicle's body alone touches it
      {adding(Cylinder{aside.x(), aside.y(), 60}), 50},
      {adding_mover(Sphere{aside, 40}, {0, 0, 0}, time_s), 30},
      {adding_mover(Sphere{aside, 40}, {500, 0, 0}, time_s), 30},
      {adding_mover(BoxShape{{place - Vec3(50, 20, 30), place + Vec3(50, 60, 80)}}, {0, 0, 9},
                    time_s),
       20}};
  for (std::size_t n = 0; n < cases.size(); ++n) {
    SCOPED_TRACE(n);
    FlightScene scene;
    commanded(scene);
    scene.setup.events = {cases[n].first};
    expect_met_at_once(scene.setup, place, cases[n].second);
  }
  FlightScene scene;
  commanded(scene);
  scene.setup.events = {moving_in(scene, place)};
  expect_met_at_once(scene.setup, place, 10);
}

TEST(FlightContact, AWallThatTheBodyAloneTouches) {
  for (const double gap : {14.0, 16.0}) {
    SCOPED_TRACE(gap);
    FlightScene scene;
    scene.follow_alone();
    scene.setup.request.vehicle.body = std::make_shared<Body>(
        Body{{box_part({10, 30, 2}, {0, 0, 0})}});  // 30 m wide: 15 m to each side
    const Vec3 near(8000, 15000 + gap, 500);
    scene.hide(layer("wall", BoxShape{{near, near + Vec3(20, 5, 20)}}));
    const FlightResult result = fly(scene.setup);
    EXPECT_EQ(result.status, gap < 15 ? RunStatus::collided : RunStatus::solved) << result.message;
    EXPECT_EQ(result.collisions, gap < 15 ? 1 : 0);
    expect_judged_alike(result, scene.setup);
  }
}

TEST(FlightContact, APopUpOverTheVehicleThatFollowsTheRoute) {
  expect_all_met([](FlightScene& scene) { scene.follow_alone(); });
}

TEST(FlightContact, APopUpOverTheVehicleThatAPilotMayCommand) {
  expect_all_met([](FlightScene&) {});
}

TEST(FlightContact, APopUpOverTheVehicleThatAPilotCommands) {
  for (const char* pilot : {"apf", "velocity_field"}) {
    SCOPED_TRACE(pilot);
    const auto commands = testing::make_local_planner(pilot);
    expect_all_met([&](FlightScene& scene) {
      scene.setup.pilot = commands.get();
      scene.setup.pilot_name = pilot;
      scene.setup.always = true;
    });
  }
}

TEST(FlightContact, TakeOffInsideSomething) {
  for (const bool moves : {false, true}) {
    FlightScene scene;
    if (moves) {
      scene.hide_moving({2000, 15010, 500}, 0, {0, 200, 0}, 40);
    } else {
      scene.hide(layer("unknown", Sphere{{2000, 15010, 500}, 40}));
    }
    const FlightResult result = fly(scene.setup);
    EXPECT_EQ(result.status, RunStatus::collided);
    EXPECT_EQ(result.collisions, 1);
    EXPECT_EQ(result.track.size(), 1u);
    EXPECT_NEAR(result.min_separation_m.value(), -30, kExact);
    expect_judged_alike(result, scene.setup);
  }
}

TEST(FlightContact, TheSeparationIsTheDepthOfTheTrack) {
  FlightScene scene;
  scene.hide(layer("wall", BoxShape{{{17003, 14000, 0}, {17103, 16000, 4000}}}));
  scene.follow_alone();
  const FlightResult result = fly(scene.setup);
  ASSERT_EQ(result.status, RunStatus::collided);
  EXPECT_NEAR(result.min_separation_m.value(), 17003 - result.track.back().second.x(), kExact);
  EXPECT_LT(result.min_separation_m.value(), -1);
  EXPECT_EQ(result.min_separation_m, result.measures.min_clearance_m);
  expect_judged_alike(result, scene.setup);
}

TEST(FlightContact, TheDepthInAMoverIsThatOfTheRelativeMotion) {
  // Meets the vehicle from the side, 12 m off, in the middle of a step.
  FlightScene scene;
  scene.hide_moving({8015, 15000, 512}, kAt + 0.5, {30, 400, 0}, 40);
  scene.follow_alone();
  const FlightResult result = fly(scene.setup);
  ASSERT_EQ(result.status, RunStatus::collided);
  EXPECT_NEAR(result.min_separation_m.value(), 12 - 40, kExact);
  expect_judged_alike(result, scene.setup);
}

TEST(FlightContact, WhatComesDownOnTheGoalIsMetThere) {
  FlightScene scene;
  scene.follow_alone();
  const double arrives = 26000.0 / 30;
  scene.setup.events = {adding(Sphere{scene.setup.request.goal.position, 40})};
  scene.setup.events[0].at_s = arrives - 0.1;
  const FlightResult met = fly(scene.setup);
  EXPECT_EQ(met.status, RunStatus::collided) << met.message;
  EXPECT_FALSE(met.reached);
  EXPECT_NEAR(met.min_separation_m.value(), -40, kExact);
  expect_judged_alike(met, scene.setup);
  scene.setup.events[0].at_s = arrives + 0.1;
  EXPECT_EQ(fly(scene.setup).status, RunStatus::solved);
}

TEST(FlightContact, APopUpIsMetAtTheNextPointOfTheTrack) {
  // The route has a point every 0.2 s; the step is 1 s.
  FlightScene scene;
  scene.follow_alone();
  scene.setup.route.edit().clear();
  for (int k = 0; k <= 26000 / 6; ++k) {
    scene.setup.route.edit().emplace_back(2000 + 6 * k, 15000, 500);
  }
  scene.setup.route.push_back(scene.setup.request.goal.position);
  const double due_s = kAt + 0.3;
  const double met_s = kAt + 0.4;
  scene.setup.events = {adding(Sphere{{2000 + 30 * met_s, 15000, 500}, 40})};
  scene.setup.events[0].at_s = due_s;
  const FlightResult result = fly(scene.setup);
  EXPECT_EQ(result.status, RunStatus::collided) << result.message;
  EXPECT_NEAR(result.track.back().first, met_s, kExact);
  EXPECT_NEAR(result.min_separation_m.value(), -40, kExact);
  expect_judged_alike(result, scene.setup);
}

/// Waits where it is.
class HoveringPlanner final : public LocalPlanner {
  struct HoveringPilot final : Pilot {
    PilotStep do_step(const Observation& seen) override {
      return {{seen.state.time_s + seen.max_dt_s, seen.state.position, {0, 0, 0}},
              PilotStep::Outcome::flying,
              "hovers"};
    }
    double do_reach_m() const override { return 200; }
  };
  std::unique_ptr<Pilot> do_begin(const Request&) const override {
    return std::make_unique<HoveringPilot>();
  }
};

TEST(FlightContact, AMoverMeetsAVehicleThatHovers) {
  FlightScene scene;
  const HoveringPlanner hovering;
  scene.setup.pilot = &hovering;
  scene.setup.always = true;
  scene.setup.max_time_s = 300;
  scene.setup.request.limits.min_leg = 1;
  const FlightResult alone = fly(scene.setup);
  EXPECT_EQ(alone.status, RunStatus::not_reached);
  EXPECT_EQ(alone.collisions, 0);
  EXPECT_NEAR(alone.track.back().first, 300, 1);
  expect_judged_alike(alone, scene.setup);
  EXPECT_EQ(judge_track(alone.track, scene.setup).check.violations.size(), 1u) << "the goal alone";
  scene.hide_moving({2000, 15000, 512}, 100.5, {0, 400, 0}, 40);
  const FlightResult result = fly(scene.setup);
  EXPECT_EQ(result.status, RunStatus::collided) << result.message;
  EXPECT_NEAR(result.min_separation_m.value(), -28, kExact);
  expect_judged_alike(result, scene.setup);
}
}  // namespace
}  // namespace altiplan::host::flight_contact_test
