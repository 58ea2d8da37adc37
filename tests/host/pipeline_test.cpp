// SPDX-License-Identifier: Apache-2.0
#include "host/run/pipeline.hpp"

#include <regex>
#include <thread>

#include "files.hpp"

namespace altiplan::host::pipeline_test {
namespace {

using PipelineTest = testing::Files;

std::string told(const std::string& does, const std::string& more = "") {
  return "steps: [{plan: told, with: {does: " + does + "}" + more + "}]\n";
}
const std::string kWall = "environment: [{box: {min_m: [400, 300, 0], max_m: [500, 700, 1000]}}]\n";

TEST_F(PipelineTest, EveryWayToFailHasItsStatusAndExitCode) {
  const struct {
    const char* does;
    RunStatus status;
    int exit_code;
    const char* message;
  } cases[] = {
      {"straight", RunStatus::solved, 0, "route accepted (from 'told')"},
      {"knows_a_bound", RunStatus::solved, 0,
       "route accepted (from 'told'), at most 0.1252 % longer than the shortest of its search "
       "space"},
      {"no_route", RunStatus::no_route, 1, "told: walls all around"},
      {"throws", RunStatus::failed, 4, "told: threw: the attic is on fire"},
      {"throws_int", RunStatus::failed, 4, "threw something that is not a std::exception"},
      {"nan", RunStatus::failed, 4, "a coordinate that is not finite"},
      {"wrong_end", RunStatus::failed, 4, "ends 7.000000 m from the goal, outside its tolerance"},
      {"no_points", RunStatus::failed, 4, "reports solved but returns no route"},
      {"endless_turn", RunStatus::failed, 4, "of more than a hundred circles"},
      {"huge", RunStatus::rejected, 1, "m outside the volume"},
  };
  for (const auto& [does, status, exit_code, message] : cases) {
    const RunResult result = run(told(does));
    EXPECT_EQ(result.status, status) << does;
    EXPECT_EQ(result.exit_code(), exit_code) << does;
    EXPECT_HAS(result.message, message);
    ASSERT_EQ(result.steps.size(), 1U);
    EXPECT_EQ(result.steps[0].accepted, status == RunStatus::solved) << does;
  }
}

TEST_F(PipelineTest, TheJudgeRejectsARouteThroughAWall) {
  scenario(kWall);
  const RunResult result = run(told("straight"));
  EXPECT_EQ(result.status, RunStatus::rejected);
  EXPECT_EQ(result.exit_code(), 1);
  EXPECT_EQ(result.steps[0].route.size(), 2U) << "what the planner returned stays to be seen";
  EXPECT_HAS(result.message,
             "told: the judge found 1 violation, at waypoint 0 (clearance): lies up to");
  EXPECT_HAS(result.message, "m inside what 'box' blocks, where 0.00 m of clearance are needed");
}

TEST_F(PipelineTest, ImpossibleEndsAreInvalidForEveryKindOfPlanner) {
  scenario(kWall, "start: {at_m: [450, 500, 500]}\ngoal: {at_m: [900, 500, 500]}\n");
  for (const char* step : {"plan: told", "plan: keeping", "plan: told_pilot",
                           "plan: keeping}, {fly: route, replan: keeping"}) {
    const RunResult result = run("steps: [{" + std::string(step) + "}]\n");
    EXPECT_EQ(result.status, RunStatus::invalid_problem) << step << result.message;
    EXPECT_EQ(result.exit_code(), 1);
    EXPECT_HAS(result.message, "the start (450.00, 500.00, 500.00) cannot be flown");
  }
  scenario(kWall, "start: {at_m: [100, 500, 500]}\ngoal: {at_m: [900, 1500, 500]}\n");
  EXPECT_HAS(run("steps: [{plan: told_pilot}]\n").message, "the goal (900.00, 1500.00, 500.00)");
}

TEST_F(PipelineTest, ALayerThatContradictsItselfIsNamed) {
  scenario("environment: [{liar: {}, id: fable}]\n");
  const RunResult result = run(told("straight"));
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_EQ(result.exit_code(), 4);
  EXPECT_HAS(result.message, "the layer 'fable' (liar) contradicts itself");
  scenario("environment: [{liar: {does: throws}}]\n");
  const RunResult thrown = run(told("straight"));
  EXPECT_EQ(thrown.status, RunStatus::failed);
  EXPECT_EQ(thrown.exit_code(), 4);
  EXPECT_HAS(thrown.message, "the map is torn");
  scenario("environment: [{liar: {does: refuses}}]\n");
  EXPECT_HAS(refusal(told("straight")), "environment.0.liar) threw: the map is blank");
}

TEST_F(PipelineTest, ConstraintsOfBothFilesHold) {
  const std::string past = "steps: [{plan: told, with: {does: past, past_m: [500, 700, 500]}}]\n";
  EXPECT_EQ(run(past).status, RunStatus::solved);
  scenario("constraints: [{not_north: {max_y_m: 650}}]\n");
  const RunResult legs = run(past);
  EXPECT_EQ(legs.status, RunStatus::rejected);
  EXPECT_HAS(legs.message, "2 violations; the first, at waypoint 0 (not_north)");
  const RunResult both =
      run("constraints: [{not_north: {does: violations, max_y_m: 600}}]\n" + past);
  EXPECT_EQ(both.steps[0].check->violations.size(), 3U);
  EXPECT_EQ(both.steps[0].check->violations[2].at, 1U);
  EXPECT_EQ(both.steps[0].check->violations[2].message, "too far north");
  scenario("constraints: [{not_north: {max_y_m: 650, holds_for: track}}]\n");
  EXPECT_EQ(run(past).status, RunStatus::solved) << "a rule of tracks alone";
  scenario("constraints: [{not_north: {does: throws}}]\n");
  const RunResult thrown = run(past);
  EXPECT_EQ(thrown.exit_code(), 4);
  EXPECT_HAS(thrown.message, "the rule book is lost");
}

TEST_F(PipelineTest, AConstraintKnowsItsPlaceInTheWorld) {
  const std::string past = "steps: [{plan: told, with: {does: past, past_m: [500, 700, 500]}}]\n";
  const std::string here = "frame: {origin_lonlat: [8, 46]}\n";
  // 46.0063 degrees lie 700.3 m north of the origin, 46.0062 689.2 m.
  scenario(here + "constraints: [{south_of: {at_lonlat: [8.001, 46.0063, 0]}}]\n");
  EXPECT_EQ(run(past).status, RunStatus::solved);
  scenario(here + "constraints: [{south_of: {at_lonlat: [8.001, 46.0062, 0]}}]\n");
  EXPECT_EQ(run(past).status, RunStatus::rejected);
  scenario("constraints: [{south_of: {at_lonlat: [8.001, 46.0062, 0]}}]\n");
  EXPECT_HAS(refusal(past), "constraints.south_of: ");
}

TEST_F(PipelineTest, AlternativesAreTriedInOrderUntilOneStands) {
  const RunResult result =
      run("steps:\n"
          "  - plan: told\n    with: {does: throws}\n    else:\n"
          "      - {plan: told, with: {does: no_route}}\n"
          "      - {plan: told_pilot}\n"
          "      - {plan: told}\n");
  EXPECT_EQ(result.status, RunStatus::solved) << result.message;
  EXPECT_EQ(result.exit_code(), 0) << "a step failed, but a route stands";
  ASSERT_EQ(result.steps.size(), 3U);
  EXPECT_EQ(result.steps[0].id, "told");
  EXPECT_EQ(result.steps[0].instead_of, std::nullopt);
  EXPECT_EQ(result.steps[1].id, "told_2");
  EXPECT_EQ(result.steps[1].instead_of, "told");
  EXPECT_EQ(result.steps[2].id, "told_pilot");
  EXPECT_EQ(result.steps[2].instead_of, "told");
  EXPECT_EQ(result.accepted, 2U);
  EXPECT_EQ(run("steps: [{plan: told, with: {does: throws}, else: [{plan: told, with: "
                "{does: no_route}}]}]\n")
                .exit_code(),
            4);
}

TEST_F(PipelineTest, ASmootherThatDoesNotStandLeavesTheRoute) {
  scenario(kWall);
  const std::string plan = "  - {plan: told, with: {does: past, past_m: [450, 800, 500]}}\n";
  const RunResult cut = run("steps:\n" + plan +
                            "  - {smooth: told_smoother, with: {does: cuts}, id: cut}\n"
                            "  - {smooth: told_smoother, with: {does: moves_end}, id: shift}\n");
  EXPECT_EQ(cut.status, RunStatus::solved);
  EXPECT_EQ(cut.accepted, 0U);
  EXPECT_EQ(cut.steps[1].status, RunStatus::rejected);
  EXPECT_EQ(cut.steps[1].route.size(), 2U);
  EXPECT_HAS(cut.steps[1].message, "; the route stays as it was");
  EXPECT_EQ(cut.steps[2].status, RunStatus::failed);
  EXPECT_HAS(cut.steps[2].message, "first and last points must stay");
  EXPECT_EQ(cut.exit_code(), 0);
}

TEST_F(PipelineTest, FromTakesTheRouteThatTheStepLeft) {
  const std::string past = "with: {does: past, past_m: [500, ";
  const RunResult result =
      run("steps:\n"
          "  - {plan: told, id: a, " +
          past +
          "600, 500]}}\n"
          "  - {plan: told, id: b, with: {does: no_route}, else: [{plan: told, id: b2, " +
          past +
          "700, 500]}}]}\n"
          "  - {plan: told, id: c, " +
          past +
          "800, 500]}}\n"
          "  - {smooth: told_smoother, id: of_b, from: b}\n"
          "  - {smooth: told_smoother, id: bad, from: a, with: {does: moves_end}}\n"
          "  - {smooth: told_smoother, id: of_bad, from: bad}\n"
          "  - {smooth: told_smoother, id: of_c, from: c}\n"
          "  - {smooth: told_smoother, id: last}\n");
  const auto y = [&](std::size_t i) { return result.steps.at(i).route.at(1).y(); };
  EXPECT_EQ(result.steps[4].id, "of_b");
  EXPECT_EQ(y(4), 700) << "what stood instead of b";
  EXPECT_EQ(y(6), 600) << "bad left the route that it took";
  EXPECT_EQ(y(7), 800);
  EXPECT_EQ(y(8), 800) << "the last that stands";
}

TEST_F(PipelineTest, APlanAfterAFailedOneStillRuns) {
  const RunResult result =
      run("steps: [{plan: told, with: {does: no_route}}, {smooth: told_smoother}, {plan: told, id: "
          "b}]\n");
  EXPECT_EQ(result.status, RunStatus::solved);
  ASSERT_EQ(result.steps.size(), 2U) << "nothing to smooth";
  EXPECT_EQ(result.steps[1].id, "b");
}

TEST_F(PipelineTest, BudgetsEndAsTimedOut) {
  const RunResult counted = run(told("uses_budget", ", within_iterations: 500"));
  EXPECT_EQ(counted.status, RunStatus::timed_out);
  EXPECT_TRUE(counted.budget_hit);
  EXPECT_EQ(counted.exit_code(), 1);
  EXPECT_EQ(counted.steps[0].counters[0].value, 500);
  const RunResult timed = run(told("uses_budget", ", within_s: 0.05"));
  EXPECT_EQ(timed.status, RunStatus::timed_out) << "whether the clock or the watchdog ended it";
  EXPECT_TRUE(timed.budget_hit);
  const RunResult memory = run(told("allocates", ", within_mb: 20"));
  EXPECT_EQ(memory.status, RunStatus::timed_out);
  EXPECT_HAS(memory.message, "it used more memory than its within_mb");
}

TEST_F(PipelineTest, ABudgetOfIterationsIsThatOfTheWholeWay) {
  scenario("via: [{at_m: [300, 500, 500]}, {at_m: [500, 500, 500]}]\n");
  const RunResult enough = run(told("straight", ", within_iterations: 9"));
  EXPECT_EQ(enough.steps[0].counters[0].value, 9);
  EXPECT_EQ(enough.steps[0].route.size(), 4U);
  const RunResult spent = run(told("uses_budget", ", within_iterations: 500"));
  EXPECT_EQ(spent.status, RunStatus::timed_out);
  EXPECT_EQ(spent.steps[0].counters[0].value, 500);
  EXPECT_HAS(spent.message, "on the way to via point 0");
}

TEST_F(PipelineTest, ViaPointsArePassedAndStayWhenSmoothed) {
  scenario("via: [{at_m: [300, 700, 500]}, {at_m: [500, 200, 500], tolerance_m: 5}]\n");
  const RunResult result = run(
      "steps: [{plan: told}, {smooth: told_smoother, with: {does: cuts}}, {plan: told_pilot}]\n");
  const Polyline expected{{100, 500, 500}, {300, 700, 500}, {500, 200, 500}, {900, 500, 500}};
  EXPECT_EQ(result.status, RunStatus::solved) << result.message;
  EXPECT_EQ(result.steps[0].route, expected);
  EXPECT_EQ(result.steps[1].route, expected);
  EXPECT_EQ(result.steps[1].message,
            "to via point 0: nothing to smooth; to via point 1: nothing to smooth; to the goal: "
            "nothing to smooth");
  EXPECT_TRUE(result.steps[2].accepted) << result.steps[2].message;
  scenario("via: [{at_m: [300, 700, 500]}, {at_m: [500, 1200, 500]}]\n");
  const RunResult outside = run(told("straight"));
  EXPECT_EQ(outside.status, RunStatus::invalid_problem);
  EXPECT_HAS(outside.message, "via point 1 (500.00, 1200.00, 500.00) cannot be flown: ");
}

TEST_F(PipelineTest, RollsOutALocalPlanner) {
  const auto pilot = [&](const char* does, const char* more = "") {
    return run("steps: [{plan: told_pilot, with: {does: " + std::string(does) + "}" + more +
               "}]\n");
  };
  const RunResult straight = pilot("straight");
  EXPECT_EQ(straight.status, RunStatus::solved) << straight.message;
  EXPECT_EQ(straight.steps[0].counters[0].value, 54) << "800 m at 15 m/s";
  EXPECT_EQ(pilot("stuck").status, RunStatus::no_route);
  EXPECT_HAS(pilot("stuck").message, "the pilot is stuck: no way is open");
  EXPECT_EQ(pilot("hovers", ", within_iterations: 70").status, RunStatus::timed_out);
  for (const char* does : {"lies", "throws", "throws_int", "nan", "no_pilot"}) {
    EXPECT_EQ(pilot(does).status, RunStatus::failed) << does;
    EXPECT_EQ(pilot(does).exit_code(), 4) << does;
  }
  EXPECT_HAS(pilot("lies").message, "it says arrived 800.000000 m from the goal");
}

TEST_F(PipelineTest, InterruptedStopsHere) {
  std::stop_source stop;
  stop.request_stop();
  RunOptions options;
  options.stop = stop.get_token();
  EXPECT_EQ(run(told("uses_budget"), options).status, RunStatus::cancelled);
  std::stop_source later;
  options.stop = later.get_token();
  std::jthread user([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    later.request_stop();
  });
  const RunResult result =
      run("steps: [{plan: told, with: {does: uses_budget}, else: [{plan: told}]}]\n", options);
  EXPECT_EQ(result.status, RunStatus::cancelled);
  EXPECT_EQ(result.steps.size(), 1U) << "no alternative to what the user stopped";
  EXPECT_EQ(result.steps[0].status, RunStatus::cancelled);
  EXPECT_FALSE(result.budget_hit);
  EXPECT_EQ(result.exit_code(), 1);
}

TEST_F(PipelineTest, AParameterThatDoesNotFitIsAnErrorAtItsKey) {
  EXPECT_EQ(refusal("steps:\n  - plan: told\n    with:\n      does: refuses_does\n"),
            "p.yaml:6:7: steps.0.with.does: this does not fit the problem");
  EXPECT_HAS(refusal("steps:\n  - plan: told\n  - fly: route\n    replan:\n"
                     "      {plan: told, with: {does: refuses_does}}\n"),
             "steps.1.replan.with.does: this does not fit the problem");
}

TEST_F(PipelineTest, TheTraceHoldsWhatTheStepsDid) {
  RunOptions options;
  options.trace = folder_ / "trace.jsonl";
  const RunResult result = run("steps: [{plan: told, id: 'say \"x\"'}]\n", options);
  EXPECT_EQ(result.trace, options.trace->string());
  std::ifstream file(*options.trace);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(std::regex_replace(text, std::regex("\"time_s\": [0-9.e-]+"), "\"time_s\": T"),
            "{\"altiplan_trace\": 1}\n"
            "{\"step\": \"say \\\"x\\\"\", \"kind\": \"expanded\", \"node\": 1, \"parent\": -1, "
            "\"at\": [100, 500, 500], \"value\": 2.5}\n"
            "{\"step\": \"say \\\"x\\\"\", \"kind\": \"rewired\", \"node\": 2, \"parent\": 1, "
            "\"at\": [900, 500, 500], \"value\": null}\n"
            "{\"step\": \"say \\\"x\\\"\", \"kind\": \"iteration\", \"node\": 1, \"parent\": -1, "
            "\"at\": [900, 500, 500], \"value\": 800, \"time_s\": T, \"expanded\": 0, "
            "\"mean\": 900, \"alive\": 3}\n");
  options.trace = folder_ / "nowhere/trace.jsonl";
  EXPECT_THROW(run("steps: [{plan: told}]\n", options), Error);
}
}  // namespace
}  // namespace altiplan::host::pipeline_test
