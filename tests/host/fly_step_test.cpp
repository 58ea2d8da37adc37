// SPDX-License-Identifier: Apache-2.0
// The fly step of a pipeline: what the host hands to the flight, and what it makes of the outcome.
#include "files.hpp"
#include "host/flight/events.hpp"

namespace altiplan::host::fly_step_test {
namespace {

class FlyStepTest : public testing::Files {
 protected:
  RunResult fly(const std::string& keys, const std::string& plan = "plan: told") const {
    return run("steps: [{" + plan + "}, {" + keys + "}]\n");
  }
  std::vector<FlightEvent> events() const {
    const Config config = load_config(pipeline("steps: [{plan: told}]\n"), overrides_);
    return build_events(config, build_mission(config, 1));
  }
};

TEST_F(FlyStepTest, FollowsTheRoute) {
  const RunResult result = fly("fly: route");
  EXPECT_EQ(result.status, RunStatus::solved) << result.message;
  EXPECT_EQ(result.exit_code(), 0);
  EXPECT_TRUE(result.flight->reached);
  EXPECT_HAS(result.message, "route accepted (from 'told'); the flight: reached the goal");
  const RunResult from =
      run("steps: [{plan: told, id: a, with: {does: past, past_m: [500, 700, 500]}}, {plan: told}, "
          "{fly: route, from: a}]\n");
  EXPECT_GT(from.flight->measures.length_m, 890);
}

TEST_F(FlyStepTest, WhatIsNotKnownIsJudgedInFlight) {
  scenario(
      "environment:\n  - box: {min_m: [400, 400, 0], max_m: [410, 600, 1000]}\n    known: false\n");
  const RunResult result = fly("fly: route");
  EXPECT_TRUE(result.steps[0].accepted) << "the planner could not know";
  EXPECT_EQ(result.status, RunStatus::collided);
  EXPECT_EQ(result.exit_code(), 1);
  EXPECT_EQ(result.flight->collisions, 1);
  EXPECT_HAS(result.message, "collided with 'box'");
}

TEST_F(FlyStepTest, PilotsThatMisbehave) {
  for (const char* does : {"throws", "throws_int", "nan", "no_pilot"}) {
    const RunResult result =
        fly("fly: told_pilot, command: always, with: {does: " + std::string(does) + "}");
    EXPECT_EQ(result.status, RunStatus::failed) << does;
    EXPECT_EQ(result.exit_code(), 1) << "a route stands";
    EXPECT_FALSE(result.steps[1].accepted);
    EXPECT_HAS(result.message, "the flight with 'told_pilot' failed: ");
  }
  const RunResult stuck = fly("fly: told_pilot, command: always, with: {does: stuck}");
  EXPECT_EQ(stuck.status, RunStatus::not_reached);
  EXPECT_HAS(stuck.message, "no way is open; the fly step has no replan: with replan: ID");
}

TEST_F(FlyStepTest, AlternativesAreFlownUntilOneArrives) {
  const RunResult result =
      fly("fly: told_pilot, id: first, command: always, with: {does: stuck}, "
          "else: [{fly: told_pilot, command: always, with: {does: throws}}, {fly: route}, {fly: "
          "told_pilot}]");
  EXPECT_EQ(result.status, RunStatus::solved) << result.message;
  ASSERT_EQ(result.steps.size(), 4U);
  EXPECT_EQ(result.steps[1].status, RunStatus::not_reached);
  EXPECT_EQ(result.steps[2].status, RunStatus::failed);
  EXPECT_EQ(result.steps[3].plugin, "route");
  EXPECT_EQ(result.steps[3].instead_of, "first");
  EXPECT_TRUE(result.steps[3].accepted);
}

TEST_F(FlyStepTest, ReplansWithTheSessionOfAStep) {
  scenario("events: [{at_s: 20, move_goal: {at_m: [900, 800, 500]}}]\n");
  const RunResult own = fly("fly: route, replan: keeping", "plan: keeping");
  EXPECT_EQ(own.status, RunStatus::solved) << own.message;
  ASSERT_EQ(own.flight->replans.size(), 1U);
  EXPECT_EQ(own.flight->replans[0].step, "keeping");
  EXPECT_EQ(own.flight->replans[0].counters[1].value, 2) << "one session, called again";
  EXPECT_EQ(own.flight->track.back().second, Vec3(900, 800, 500));
  // A step's alternative that was not needed, a flight's alternative that replans, a planner of
  // the flight's own: each gets a session.
  const RunResult spare =
      fly("fly: route, replan: spare", "plan: told, else: [{plan: keeping, id: spare}]");
  EXPECT_EQ(spare.status, RunStatus::solved) << spare.message;
  EXPECT_EQ(spare.flight->replans.at(0).step, "spare");
  const RunResult late =
      fly("fly: told_pilot, command: always, with: {does: stuck}, "
          "else: [{fly: route, replan: told}]");
  EXPECT_EQ(late.status, RunStatus::solved) << late.message;
  EXPECT_EQ(late.flight->replans.size(), 1U);
  const RunResult fresh = fly("fly: route, replan: {plan: keeping}");
  EXPECT_EQ(fresh.status, RunStatus::solved) << fresh.message;
  EXPECT_EQ(fresh.flight->replans.at(0).step, "keeping");
}

TEST_F(FlyStepTest, AReplanKeepsTheViaPointsAhead) {
  scenario(
      "via: [{at_m: [300, 700, 500]}, {at_m: [600, 300, 500]}]\n"
      "events: [{at_s: 30, move_goal: {at_m: [900, 800, 500]}}]\n");
  const RunResult result = fly("fly: route, replan: told");
  EXPECT_EQ(result.status, RunStatus::solved) << result.message;
  EXPECT_EQ(result.flight->replans.size(), 1U);
  const auto passes = [&](const Vec3& p) {
    return std::count_if(result.flight->track.begin(), result.flight->track.end(),
                         [&](const auto& at) { return (at.second - p).norm() < 1e-3; });
  };
  EXPECT_EQ(passes({300, 700, 500}), 1) << "passed before, not again";
  EXPECT_EQ(passes({600, 300, 500}), 1);
}

TEST_F(FlyStepTest, TheEventsOfTheFileReachTheWorld) {
  const std::string box = "{box: {min_m: [400, 400, 0], max_m: [410, 600, 1000]}}";
  scenario("events: [{at_s: 5, add: " + box + ", id: wall}]\n");
  EXPECT_EQ(fly("fly: route").status, RunStatus::collided);
  scenario("events: [{at_s: 5, add: " + box + ", id: wall}, {at_s: 10, remove: wall}]\n");
  EXPECT_EQ(fly("fly: route").status, RunStatus::solved);
  scenario("events: [{when_near: {at_m: [300, 500, 500], within_m: 20}, add: " + box + "}]\n");
  EXPECT_EQ(fly("fly: route").status, RunStatus::collided);
  scenario(
      "environment: [{box: {min_m: [400, 600, 0], max_m: [410, 700, 1000]}, id: gate}]\n"
      "events: [{at_s: 5, move: {layer: gate, by_m: [0, -150, 0]}}]\n");
  EXPECT_EQ(fly("fly: route").status, RunStatus::collided);
  scenario("moving: [{sphere: {at_m: [500, 500, 500], radius_m: 9, velocity_mps: [0, 0, 0]}}]\n");
  EXPECT_EQ(fly("fly: route").status, RunStatus::collided);
  scenario(
      "moving: [{sphere: {at_m: [500, 500, 500], radius_m: 9, velocity_mps: [0, 0, 0]}}]\n"
      "events: [{at_s: 5, remove: sphere_1}]\n");
  EXPECT_EQ(fly("fly: route").status, RunStatus::solved);
}

TEST_F(FlyStepTest, CellsAreSetWhenTheEventsComeWhateverTheirOrderInTheFile) {
  // The way leads through the cells (x, 5, 5), at the time 10 s through (2, 5, 5).
  const auto flown = [&](const std::string& events) {
    scenario("environment: [{cells: {}}]\nevents: [" + events + "]\n",
             "start: {at_m: [100, 550, 550]}\ngoal: {at_m: [900, 550, 550]}\n");
    const RunResult result = fly("fly: route");
    EXPECT_TRUE(result.status == RunStatus::solved || result.status == RunStatus::collided)
        << result.message;
    return result.status;
  };
  const std::string block = "{at_s: 5, set_cells: {layer: cells, cells: [[4, 5, 5], [6, 5, 5]]}}";
  const std::string clear =
      "{at_s: 10, set_cells: {layer: cells, blocked: false, cells: [[4, 5, 5], [6, 5, 5]]}}";
  const std::string beside = "{at_s: 8, set_cells: {layer: cells, cells: [[4, 1, 1]]}}";
  EXPECT_EQ(flown(block), RunStatus::collided);
  EXPECT_EQ(flown(beside), RunStatus::solved);
  EXPECT_EQ(flown(block + ", " + beside + ", " + clear), RunStatus::solved);
  EXPECT_EQ(flown(clear + ", " + beside + ", " + block), RunStatus::solved);
  EXPECT_EQ(flown(block + ", " + beside), RunStatus::collided);
}

TEST_F(FlyStepTest, EventsThatCannotBeAreRefusedBeforeAnythingIsPlanned) {
  const std::string run = "steps: [{plan: told, with: {does: refuses_does}}, {fly: route}]\n";
  scenario(
      "environment: [{cells: {}}]\nevents: [{at_s: 3, set_cells: {layer: cells, cells: "
      "[[1, 2, 3], [10, 0, 0]]}}]\n");
  EXPECT_EQ(refusal(run),
            "s.yaml:6:10: events.0.set_cells.cells.1: the layer 'cells' has no such cell");
  scenario(
      "environment: [{cylinder: {at_m: [1, 1], radius_m: 1}}]\n"
      "events: [{at_s: 3, set_cells: {layer: cylinder, cells: [[1, 2, 3]]}}]\n");
  EXPECT_HAS(refusal(run), "the layer 'cylinder' has no cells");
  scenario(
      "events: [{at_s: 3, set_cells: {layer: late, cells: [[1, 2, 3]]}}, {at_s: 1, add: "
      "{cells: {}}, id: late}]\n");
  EXPECT_HAS(refusal(run), "this does not fit the problem")
      << " a layer that comes by a later line";
  ASSERT_EQ(events().size(), 2U);
  EXPECT_EQ(events()[0].box.max, Vec3(200, 300, 400));
  scenario("events: [{at_s: 3, move_goal: {at_cell: [1, 2, 3]}}]\n");
  EXPECT_HAS(refusal(run), "s.yaml:5:10: events.0: at_cell needs a layer");
  scenario(
      "events: [{at_s: 3, set_cells: {layer: late, cells: [[1, 2, 3]]}}, {at_s: 9, add: "
      "{cells: {}}, id: late}]\n");
  EXPECT_HAS(fly("fly: route").message, "event set_cells: there is no layer 'late' at that time");
}
}  // namespace
}  // namespace altiplan::host::fly_step_test
