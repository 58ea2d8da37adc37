// SPDX-License-Identifier: Apache-2.0
#include <exception>

#include "altiplan/error.hpp"
#include "host/flight/flight.hpp"
#include "host/flight/track_judge.hpp"
#include "host/run/pipeline_run.hpp"

namespace altiplan::host {
namespace {

/// Stands in for a session that could not begin: each replan reports the reason.
class BrokenSession final : public Session {
 public:
  // It is kept, not thrown: NOLINTNEXTLINE(bugprone-throw-keyword-missing)
  explicit BrokenSession(std::exception_ptr error) : error_(std::move(error)) {}

 private:
  const PlanResult& do_result() const override { std::rethrow_exception(error_); }
  const PlanResult& do_update(const State&, const Goal&, std::shared_ptr<const World>,
                              std::span<const Change>, const Budget&) override {
    std::rethrow_exception(error_);
  }

  std::exception_ptr error_;
};
}  // namespace

void Run::fly_step(const StepEntry& step) {
  if (options_.real) {
    StepEntry only = step;
    only.within_s.reset();
    fly_once(only, std::nullopt);
    return;
  }
  fly_once(step, std::nullopt);
  for (const StepEntry& other : step.otherwise) {
    if (result_.flight->status == RunStatus::solved || interrupted()) {
      return;
    }
    fly_once(other, step.id);
  }
}

FlightSetup Run::flight_setup(const StepEntry& entry, FlightPlugins& plugins) {
  FlightSetup setup;
  if (entry.plugin != kFollowRoute) {
    plugins.pilot = make(entry, &PluginEntry::local_planner);
    setup.pilot = plugins.pilot.get();
    setup.pilot_name = entry.plugin;
  }
  for (const SmootherEntry& smoother : entry.fly.smooth) {
    StepEntry as_step;
    as_step.plugin = smoother.plugin;
    as_step.with = smoother.parameters;
    as_step.path = entry.path + ".smooth";
    plugins.smoothers.push_back(make(as_step, &PluginEntry::smoother));
    setup.smoothers.push_back(plugins.smoothers.back().get());
  }
  const std::optional<StepEntry> planner = replan_entry(entry);
  const PlanPlugin* made =
      planner && !sessions_.contains(session_key(entry, *planner)) ? &make_plan(*planner) : nullptr;
  Request request = request_for(entry, result_.steps.size());
  request.limits = mission_.track_request.limits;
  request.constraints = mission_.track_request.constraints;
  request.budget.progress = nullptr;  // a pilot's searches are short: the flight's time tells more
  setup.flown_s = options_.progress != nullptr ? &options_.progress->flown_s : nullptr;
  setup.request = request;
  setup.route_request = mission_.request;
  setup.route_request.random = request.random;
  setup.route_request.budget.stop = request.budget.stop;
  setup.route_request.trace = request.trace;
  setup.route = result_.steps[input_of(entry)].route;
  setup.truth = mission_.truth;
  setup.events = events_;
  setup.always = entry.fly.command == "always";
  setup.step_s = entry.fly.step_s;
  setup.when = entry.fly.when == "any_change" ? ReplanWhen::any_change : ReplanWhen::unsafe;
  setup.replan_latency_s = entry.fly.replan_latency_s;
  setup.max_time_s = entry.fly.max_time_s;
  if (planner) {
    find_replanner(entry, *planner, made, setup);
  }
  if (options_.real) {
    setup.vehicle = &options_.real->vehicle;
    setup.telemetry = true;
    setup.request.goal = as_telemetry(setup.request).goal;
  }
  return setup;
}

void Run::fly_once(const StepEntry& entry, std::optional<std::string> instead_of) {
  StepResult step = begin_attempt(entry, std::move(instead_of));
  const auto began = Clock::now();
  FlightPlugins plugins;
  const FlightSetup setup = flight_setup(entry, plugins);
  step.setup_time_s = seconds_since(began);
  FlightResult flight;
  try {
    flight = fly(setup);
    flight.metrics = measured(flight.track, mission_.track_request, mission_.metrics);
  } catch (const ParameterError& error) {
    throw at_its_key(entry, error);
  }
  if (const std::string changed = leave(); !changed.empty()) {
    flight.status = RunStatus::failed;
    flight.reason = Reason::process_changed;
    flight.message = named(entry) + " " + changed;
  }
  step.time_s = seconds_since(began) - step.setup_time_s;
  if (flight.status == RunStatus::cancelled && !interrupted()) {
    step.budget_hit = true;
    flight.status = RunStatus::not_reached;
    flight.reason = watchdog_.out_of_memory() ? Reason::memory : Reason::deadline;
    flight.message =
        (watchdog_.out_of_memory() ? "memory budget exhausted: "
                                   : "time budget exhausted: " + time_budget(entry) + ": ") +
        flight.message;
  }
  step.accepted = flight.status == RunStatus::solved;
  step.status = flight.status;
  step.reason = flight.reason;
  step.message = flight.message;
  step.counters = flight.counters;
  const std::lock_guard lock(mutex_);
  result_.steps.back() = std::move(step);
  result_.flight = std::move(flight);
}

std::optional<StepEntry> Run::replan_entry(const StepEntry& entry) const {
  const Value& replan = entry.fly.replan;
  if (replan.kind == Value::Kind::map) {
    StepEntry planner;
    bind(planner, &replan, entry.path + ".replan");
    planner.path = entry.path + ".replan";
    planner.where = replan.where;
    return planner;
  }
  return replan.text.empty() ? std::nullopt : std::optional(plan_entry(replan.text));
}

std::string Run::session_key(const StepEntry& entry, const StepEntry& planner) {
  return entry.fly.replan.text.empty() ? planner.path : planner.id;
}

void Run::find_replanner(const StepEntry& entry, const StepEntry& planner, const PlanPlugin* made,
                         FlightSetup& setup) {
  setup.replan_step = planner.id;
  setup.replan_within_s = planner.within_s;
  set_budget(setup.route_request.budget, planner);
  std::unique_ptr<Session>& session = sessions_[session_key(entry, planner)];
  if (made != nullptr) {  // also for an alternative that was not needed
    try {
      session = begin_session(*made, setup.route_request);
    } catch (const ParameterError& error) {
      throw at_its_key(planner, error);
    } catch (const PluginError&) {
      session = std::make_unique<BrokenSession>(std::current_exception());
    }
  }
  setup.replanner = session.get();
}

const StepEntry& Run::plan_entry(const std::string& id) const {
  for (const StepEntry& step : config_.steps) {
    for (const StepEntry& other : step.otherwise) {
      if (other.id == id) {
        return other;
      }
    }
    if (step.id == id) {
      return step;
    }
  }
  throw Error("there is no plan step '" + id + "'");
}
}  // namespace altiplan::host
