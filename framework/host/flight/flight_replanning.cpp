// SPDX-License-Identifier: Apache-2.0
#include "host/flight/flight_run.hpp"

#include <algorithm>
#include <chrono>

#include "host/judge/judge.hpp"

namespace altiplan::host {

void Flight::ask_replan() {
  if (setup_.replanner != nullptr && !replan_due_ && state_.time_s >= next_replan_) {
    replan_due_ = state_.time_s + setup_.replan_latency_s;
  }
}

void Flight::replan_when_due() {
  if (!replan_due_ || state_.time_s < *replan_due_) {
    return;
  }
  replan_due_.reset();
  next_replan_ = state_.time_s + std::max(10.0, setup_.replan_latency_s);
  Request request = setup_.route_request;
  request.start = state_;
  request.goal = request_.goal;
  request.world = world_.known();
  if (setup_.replan_within_s) {
    request.budget.deadline =
        Budget::Clock::now() + std::chrono::duration_cast<Budget::Clock::duration>(
                                   std::chrono::duration<double>(*setup_.replan_within_s));
  }
  const PlanResult plan = replan(request);
  if (plan.status != Status::solved) {
    return;
  }
  const CheckResult found = check(plan.route, request);
  if (found.ok()) {
    take_route(plan.route, request);
  } else {
    Replan& refused = result_.replans.back();
    refused.status = Status::rejected;
    refused.message = verdict_sentence(found, found.violations.front());
  }
}

PlanResult Flight::replan(const Request& request) {
  const auto began = std::chrono::steady_clock::now();
  PlanResult plan = setup_.replanner->update(state_, request.goal, request.world, replan_changes_,
                                             request.budget);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  replan_changes_.clear();
  result_.replans.push_back(
      {state_.time_s, setup_.replan_step, took.count(), plan.status, plan.message, plan.counters});
  return plan;
}

void Flight::take_route(Route route, const Request& request) {
  for (const Smoother* smoother : setup_.smoothers) {
    const PlanResult smooth = smoother->smooth(route, request);
    if (smooth.status == Status::solved && check(smooth.route, request).ok()) {
      route = smooth.route;
    }
  }
  path_ = FlightPath(route);
  progress_ = 0;
  stuck_ = 0;
  end_moved_ = false;
  world_.route_is_new();
  if (pilot_commands_ && !setup_.always) {
    hand_over(false, "a new route");
  }
}
}  // namespace altiplan::host
