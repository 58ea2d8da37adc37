// SPDX-License-Identifier: Apache-2.0
// Targets that appear in flight, and vehicles that are not simulated.
#include "flight_scene.hpp"
#include "host/flight/track_judge.hpp"

namespace altiplan::host::reported_flight_test {
namespace {

FlightEvent target(const Vec3& at, double at_s) {
  FlightEvent event;
  event.kind = FlightEvent::Kind::visit;
  event.at_s = at_s;
  event.target = {at, 200};
  return event;
}

std::vector<std::string> rules(const CheckResult& check) {
  std::vector<std::string> names;
  for (const Violation& violation : check.violations) {
    names.push_back(violation.constraint);
  }
  return names;
}

using Names = std::vector<std::string>;

TEST(Visit, LeadsToTheTargetAndBackToTheRoute) {
  FlightScene scene;
  scene.setup.events = {target({15000, 19000, 500}, 100)};
  const FlightResult result = fly(scene.setup);
  expect_flown(result, 2);
  EXPECT_EQ(result.handovers.front().at_s, 100);
  EXPECT_EQ(result.handovers.front().why, "a target at (15000, 19000, 500)");
  EXPECT_LE(not_visited(scene.setup.events.front().target, result.track).value, 200);
  const TrackVerdict verdict = judge_track(result.track, scene.setup);
  EXPECT_TRUE(verdict.check.ok()) << rules(verdict.check).front();
}

TEST(Visit, NeedsALocalPlanner) {
  FlightScene scene;
  scene.follow_alone();
  scene.setup.events = {target({15000, 19000, 500}, 100)};
  const FlightResult result = fly(scene.setup);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_NE(result.message.find("no local planner"), std::string::npos) << result.message;
}

TEST(Visit, ATrackThatDoesNotIsReported) {
  FlightScene scene;
  const FlightResult straight = fly(scene.setup);
  scene.setup.events = {target({15000, 19000, 500}, 100)};
  EXPECT_EQ(rules(judge_track(straight.track, scene.setup).check), Names{"visit"});
}

/// Flies the route 3 m beside it and stops 3 m before its end, faster than the scenario's vehicle.
class Reported final : public FlownVehicle {
 public:
  bool is_commanded = false;
  bool is_released = false;
  bool may_command = true;
  double lost_at_s = kInfinity;

  State take_off(const Request& request, const RouteAhead& /*route*/, const State& first) override {
    speed_ = 1.2 * request.vehicle.speed_mps;
    State state = first;
    state.position += Vec3(1, 3, 0);
    return state;
  }
  bool takes_commands() const override { return may_command; }
  FlownTo follow(RouteAhead& route, const State& from, double duration,
                 const Report& report) override {
    if (from.time_s >= lost_at_s) {
      throw VehicleLost("the link is lost");
    }
    State now = from;
    now.time_s += duration;
    const double ahead = std::min(route.progress + speed_ * duration, route.path.length() - 3);
    now.position = route.path.at(ahead) + Vec3(0, 3, 0);
    now.velocity = (now.position - from.position) / duration;
    route.reference = route.path.length();
    route.advance(now, duration);
    report(now);
    return FlownTo::on_the_way;
  }
  FlownTo go(RouteAhead& /*route*/, const State& /*from*/, const State& command,
             const Report& report) override {
    is_commanded = true;
    report(command);
    return FlownTo::on_the_way;
  }
  void release() override { is_released = true; }

 private:
  double speed_ = 0;
};

/// As a run sets it up.
void fly_with(FlightScene& scene, Reported& vehicle) {
  scene.setup.vehicle = &vehicle;
  scene.setup.telemetry = true;
  scene.setup.request.goal = as_telemetry(scene.setup.request).goal;
}

TEST(ReportedFlight, IsJudgedWithoutWhatTheAutopilotLimits) {
  FlightScene scene;
  Reported vehicle;
  fly_with(scene, vehicle);
  const FlightResult result = fly(scene.setup);
  EXPECT_EQ(result.status, RunStatus::solved) << result.message;
  EXPECT_TRUE(vehicle.is_released);
  EXPECT_FALSE(vehicle.is_commanded);
  EXPECT_NEAR(result.cross_track_max_m.value_or(0), 3, 1e-9);
  EXPECT_TRUE(judge_track(result.track, scene.setup).check.ok());
  scene.setup.telemetry = false;
  const Names simulated = rules(judge_track(result.track, scene.setup).check);
  EXPECT_EQ(simulated.front(), "start");
}

TEST(ReportedFlight, IsCommandedWhereADangerIs) {
  FlightScene scene;
  Reported vehicle;
  fly_with(scene, vehicle);
  scene.hide(layer("hidden", post(15000, 15000, 300)));
  const FlightResult result = fly(scene.setup);
  expect_flown(result, 2);
  EXPECT_TRUE(vehicle.is_commanded);
}

TEST(ReportedFlight, OnlyNotesADangerWithoutThePermission) {
  FlightScene scene;
  Reported vehicle;
  vehicle.may_command = false;
  fly_with(scene, vehicle);
  scene.hide(layer("hidden", post(15000, 15000, 300)));
  const FlightResult result = fly(scene.setup);
  EXPECT_EQ(result.status, RunStatus::collided);
  EXPECT_FALSE(vehicle.is_commanded);
  ASSERT_EQ(result.handovers.size(), 1u);
  EXPECT_EQ(result.handovers.front().why,
            "the route ahead passes too close to 'hidden', but commands are not allowed");
}

TEST(ReportedFlight, KeepsTheTrackOfALostVehicle) {
  FlightScene scene;
  Reported vehicle;
  vehicle.lost_at_s = 50;
  fly_with(scene, vehicle);
  const FlightResult result = fly(scene.setup);
  EXPECT_EQ(result.status, RunStatus::not_reached);
  EXPECT_EQ(result.message, "the link is lost");
  EXPECT_EQ(result.track.back().first, 50);
  EXPECT_TRUE(vehicle.is_released);
}
}  // namespace
}  // namespace altiplan::host::reported_flight_test
