// SPDX-License-Identifier: Apache-2.0
#include "host/flight/flight_run.hpp"

#include <algorithm>
#include <chrono>

#include "altiplan/error.hpp"

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
  const Route route = replan(request);
  if (route.empty()) {
    return;
  }
  const CheckResult found = check(route, request);
  if (found.ok()) {
    take_route(route, request);
  } else {
    Replan& refused = result_.replans.back();
    refused.status = RunStatus::rejected;
    refused.reason = Reason::constraint;
    refused.message = verdict_sentence(found, found.violations.front());
  }
}

Route Flight::replan(const Request& request) {
  const auto began = std::chrono::steady_clock::now();
  Replan report;
  report.at_s = state_.time_s;
  report.step = setup_.replan_step;
  Route route;
  try {
    PlanResult plan = setup_.replanner->update(state_, request.goal, request.world, replan_changes_,
                                               request.budget);
    report.status = run_status(plan.status);
    report.reason = plan.reason;
    report.message = std::move(plan.message);
    report.counters = std::move(plan.counters);
    if (plan.status == PlanStatus::solved) {
      route = std::move(plan.route);
    }
  } catch (const PluginError& error) {  // the flight continues without a new route
    report.reason = error.reason();
    report.message = error.what();
  }
  report.time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  replan_changes_.clear();
  result_.replans.push_back(std::move(report));
  return route;
}

void Flight::take_route(Route route, const Request& request) {
  for (const Smoother* smoother : setup_.smoothers) {
    try {
      const PlanResult smooth = smoother->smooth(route, request);
      if (smooth.status == PlanStatus::solved && check(smooth.route, request).ok()) {
        route = smooth.route;
      }
    } catch (const PluginError&) {  // the route stays unchanged
    }
  }
  route_.path = FlightPath(route);
  route_.restart();
  stuck_ = 0;
  end_moved_ = false;
  world_.route_is_new();
  if (pilot_commands_ && !setup_.always && targets_.empty()) {
    hand_over(false, "a new route");
  }
}
}  // namespace altiplan::host
