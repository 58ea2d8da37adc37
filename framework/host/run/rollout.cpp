// SPDX-License-Identifier: Apache-2.0
#include "host/run/rollout.hpp"

#include <string>
#include <utility>

#include "altiplan/error.hpp"
#include "altiplan/planner.hpp"
#include "host/flight/track_judge.hpp"

namespace altiplan::host {
namespace {

/// A pilot that neither arrives nor gives up is stopped after this many steps, whatever its budget.
constexpr std::uint64_t kMaxSteps = 1'000'000;
constexpr double kStepSeconds = 1;

/// Checks what Pilot::step cannot: a step is no faster than the vehicle, and `arrived` is at the
/// goal.
void expect_lawful(const PilotStep& step, const Observation& seen, const Request& request) {
  const double run = (step.next.position - seen.state.position).norm();
  const double dt = step.next.time_s - seen.state.time_s;
  if (run > request.vehicle.max_speed() * dt * (1 + 1e-6) + kLengthTolerance) {
    throw PluginError(
        "the pilot violated the contract of its interface: a step faster than the vehicle",
        Reason::contract);
  }
  if (step.outcome == PilotStep::Outcome::arrived && !request.goal.reached_at(step.next.position)) {
    throw PluginError("the pilot violated the contract of its interface: it says arrived " +
                          std::to_string((step.next.position - request.goal.position).norm()) +
                          " m from the goal",
                      Reason::contract);
  }
}

/// The result for ends that are impossible, or that no local planner knows.
std::optional<PlanResult> refused_ends(const Request& request) {
  std::optional<PlanResult> refused = impossible_ends(request);
  if (!refused && (request.start.loiter || request.goal.loiter)) {
    refused.emplace();
    refused->status = PlanStatus::invalid_problem;
    refused->reason = request.start.loiter ? Reason::start : Reason::goal;
    refused->message = std::string("the ") + name(refused->reason) +
                       " is a loiter circle, which local planners do not support";
    refused->counters = {{"expanded", 0}};
  }
  return refused;
}
}  // namespace

PlanResult roll_out(const LocalPlanner& planner, const Request& request) {
  if (auto refused = refused_ends(request)) {
    return *std::move(refused);
  }
  const std::unique_ptr<Pilot> pilot = planner.begin(request);
  BudgetWatch watch(request.budget);
  const Vec3 rest[] = {request.goal.position};
  PlanResult result;
  Observation seen;
  seen.state = request.start;
  seen.local_target = request.goal.position;
  seen.goal = request.goal;
  seen.rest = rest;
  seen.world = request.world.get();
  seen.max_dt_s = kStepSeconds;
  result.route = {request.start.position};
  std::uint64_t steps = 0;
  result.status = PlanStatus::timed_out;
  result.message = "the budget ended before the pilot arrived";
  while (true) {
    if (request.goal.reached_at(seen.state.position)) {
      result.status = PlanStatus::solved;
      result.message = "arrived after " + std::to_string(steps) + " steps";
      break;
    }
    if (watch.spent(steps)) {
      result.budget_hit = true;
      result.reason =
          steps >= request.budget.max_iterations ? Reason::iterations : Reason::deadline;
      if (watch.cancelled()) {
        result.reason = Reason::none;
        result.status = PlanStatus::cancelled;
        result.message = "stopped before the pilot arrived";
      }
      break;
    }
    if (steps == kMaxSteps) {
      result.status = PlanStatus::no_route;
      result.message = "the pilot did not arrive in " + std::to_string(steps) + " steps";
      break;
    }
    const PilotStep step = pilot->step(seen);
    ++steps;
    if (step.outcome == PilotStep::Outcome::stuck) {
      result.status = PlanStatus::no_route;
      result.reason = Reason::stuck;
      result.message = "the pilot is stuck: " + std::string(step.why);
      break;
    }
    expect_lawful(step, seen, request);
    if (step.next.position != seen.state.position) {
      result.route.push_back(step.next.position);
    }
    seen.state = step.next;
  }
  result.counters = pilot->counters();
  result.counters.insert(result.counters.begin(), {"expanded", std::int64_t(steps)});
  return result;
}
}  // namespace altiplan::host
