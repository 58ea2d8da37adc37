// SPDX-License-Identifier: Apache-2.0
#include "host/run/pipeline_run.hpp"

#include <algorithm>
#include <utility>

#include "altiplan/measures.hpp"
#include "host/mission/runways.hpp"

namespace altiplan::host {

void Run::attempt(const StepEntry& step) {
  std::optional<std::size_t> leaves;
  if (step.verb == Verb::smooth) {
    leaves = input_of(step);
  }
  bool accepted = one_attempt(step, std::nullopt);
  for (auto other = step.otherwise.begin();
       other != step.otherwise.end() && !accepted && !interrupted(); ++other) {
    accepted = one_attempt(*other, step.id);
  }
  if (accepted) {
    leaves = result_.accepted;
    left_by_[result_.steps.back().id] = *leaves;
  }
  if (leaves) {
    left_by_[step.id] = *leaves;
  }
}

bool Run::one_attempt(const StepEntry& entry, std::optional<std::string> instead_of) {
  StepResult step = begin_attempt(entry, std::move(instead_of));
  if (entry.verb == Verb::plan) {
    plan(entry, step);
  } else {
    smooth(entry, step);
  }
  if (step.status == RunStatus::cancelled &&
      !interrupted()) {  // stopped by the watchdog, not by the user
    step.status = RunStatus::timed_out;
    step.reason = watchdog_.out_of_memory() ? Reason::memory : Reason::deadline;
    step.budget_hit = true;
  }
  if (step.status == RunStatus::timed_out && step.reason == Reason::deadline) {
    // The plugin was told to stop: nobody else cancelled it.
    constexpr std::string_view kCancelled = "cancelled: ";
    const std::string how = step.message.starts_with(kCancelled)
                                ? step.message.substr(kCancelled.size())
                                : step.message;
    step.message = "time budget exhausted: " + time_budget(entry) + " (" + how + ")";
  }
  const std::lock_guard lock(mutex_);
  result_.steps.back() = step;
  if (step.accepted) {
    result_.accepted = result_.steps.size() - 1;
  }
  return step.accepted;
}

StepResult Run::begin_attempt(const StepEntry& entry, std::optional<std::string> instead_of) {
  StepResult step;
  step.id = entry.id;
  step.verb = entry.verb;
  step.plugin = entry.plugin;
  step.instead_of = std::move(instead_of);
  {
    const std::lock_guard lock(mutex_);
    result_.steps.push_back(step);
  }
  if (trace_) {
    trace_->begin_step(entry.id);
  }
  progress_.begin_step();
  return step;
}

std::size_t Run::input_of(const StepEntry& entry) const {
  const auto named = entry.from ? left_by_.find(*entry.from) : left_by_.end();
  return named != left_by_.end() ? named->second : *result_.accepted;
}

const Run::PlanPlugin& Run::make_plan(const StepEntry& entry) {
  auto made = std::make_unique<PlanPlugin>();
  if (config_.registry->offering("planner", entry.plugin) == nullptr) {
    made->local_planner = make(entry, &PluginEntry::local_planner);
  } else {
    made->planner = make(entry, &PluginEntry::planner);
  }
  plan_plugins_.push_back(std::move(made));
  return *plan_plugins_.back();
}

std::unique_ptr<Session> Run::begin_session(const PlanPlugin& made, const Request& request) {
  if (made.planner && mission_.via.empty()) {
    return made.planner->begin(request);
  }
  return std::make_unique<FreshVia>(request, mission_.via, part_of(made), made.is_anytime());
}

PlanPart Run::part_of(const PlanPlugin& made) const {
  if (task_) {
    return task_->part(made.part());
  }
  return [this, part = made.part()](const Request& request) {
    PlanResult result;
    if (auto line = runway_section(mission_, request.start.position, request.goal.position)) {
      result.status = PlanStatus::solved;
      result.route = Route(*std::move(line));
      return result;
    }
    if (!mission_.runways.has_any()) {
      return part(request);
    }
    Request exact = request;  // where a runway's line begins
    exact.goal.tolerance_m = exact.goal.heading ? 0 : exact.goal.tolerance_m;
    return part(exact);
  };
}

std::optional<PlanResult> Run::order_task(const Request& request) {
  TaskOrder order = order_of_task(mission_, request.budget);
  if (order.status != PlanStatus::solved) {
    PlanResult failed;
    failed.status = order.status;
    failed.reason = order.reason;
    failed.message = "the task has no order: " + order.message;
    failed.counters = std::move(order.counters);
    failed.budget_hit = order.budget_hit;
    return failed;
  }
  task_.emplace(std::move(order), mission_.ends, mission_.request);
  for (Request* mission : {&mission_.request, &mission_.track_request}) {
    mission->start.position = task_->start();
    mission->goal.position = task_->goal();
  }
  mission_.via = task_->via(mission_.request);
  const std::lock_guard lock(mutex_);
  result_.task = OrderedTask{task_->order().passes, task_->flights(mission_.request),
                             task_->order().time_s, task_->order().bound_s};
  return std::nullopt;
}

bool Run::flown_with(const std::string& id) const {
  const StepEntry& last = config_.steps.back();
  const auto names_it = [&](const StepEntry& step) { return step.fly.replan.text == id; };
  return names_it(last) || std::any_of(last.otherwise.begin(), last.otherwise.end(), names_it);
}

PlanResult Run::explained(PlanResult result, const Request& request) {
  const bool failed =
      result.status == PlanStatus::no_route || result.status == PlanStatus::timed_out;
  if (!failed || std::exchange(ends_explained_, true)) {
    return result;
  }
  std::string refused;  // before what the search counted, which it explains
  for (const auto& [end, p] :
       {std::pair("start", request.start.position), std::pair("goal", request.goal.position)}) {
    for (const NamedConstraint& named : request.constraints) {
      if (!named.admits_all && !named.admits({std::nullopt, p, p, request.world.get()})) {
        refused += "the constraint '" + named.name + "' refuses the " + end + " itself; ";
      }
    }
  }
  result.message = refused + result.message;
  return result;
}

void Run::plan(const StepEntry& entry, StepResult& step) {
  const auto began = Clock::now();
  const PlanPlugin& made = make_plan(entry);
  step.setup_time_s = seconds_since(began);
  guarded(entry, step, [&](const Request& given) {
    Request request = given;
    if (mission_.task && !task_) {
      if (auto failed = order_task(request)) {
        return *std::move(failed);
      }
    }
    if (task_) {
      request.start.position = task_->start();
      request.goal.position = task_->goal();
    }
    if (!flown_with(entry.id)) {
      PlanResult result = plan_along(request, mission_.via, made.is_anytime(), part_of(made));
      result.budget_hit = result.budget_hit || (task_ && task_->order().budget_hit);
      return explained(std::move(result), request);
    }
    sessions_[entry.id] = begin_session(made, request);
    return explained(sessions_[entry.id]->result(), request);
  });
  judge_step(step, mission_.request);
}

void Run::smooth(const StepEntry& entry, StepResult& step) {
  const auto began = Clock::now();
  const std::unique_ptr<Smoother> smoother = make(entry, &PluginEntry::smoother);
  step.setup_time_s = seconds_since(began);
  const Route& before = result_.steps[input_of(entry)].route;
  guarded(entry, step,
          [&](const Request& request) { return between_via(*smoother, before, request); });
  judge_step(step, mission_.request);
  if (!step.accepted) {
    step.message += step.message.empty() ? "" : "; ";
    step.message += "the route stays as it was";
  }
}

PlanResult Run::between_via(const Smoother& smoother, const Route& before, const Request& request) {
  std::vector<std::size_t> cuts = via_indices(before, mission_.via);
  std::vector<Goal> fixed;
  for (const std::size_t cut : cuts) {
    fixed.push_back({before[cut], 0, mission_.via[fixed.size()].heading});
  }
  cuts.push_back(before.size() - 1);
  Request in_flight = request;  // in the winds that the route meets
  double end_s = request.start.time_s;
  for (std::size_t i = 0; i < before.leg_count(); ++i) {
    end_s += leg_duration(before.leg(i), end_s, request);
  }
  std::erase_if(in_flight.wind.changes,
                [&](const Wind::Change& change) { return change.from_s > end_s; });
  std::size_t from = 0;
  std::size_t piece = 0;
  std::string messages;  // one message per section: a smoother sees only its own
  PlanResult whole = plan_along(in_flight, fixed, false, [&](const Request& part) {
    const Route section = before.part(from, cuts[piece]);
    PlanResult result;
    const bool is_stop = section.leg_count() == 1 && section.leg(0).waits();  // of a task
    if (is_stop || runway_section(mission_, section.front(), section.back())) {
      result.status = PlanStatus::solved;
      result.route = section;
    } else {
      result = smoother.smooth(section, part);
    }
    if (!result.message.empty()) {
      messages += (messages.empty() ? "to " : "; to ") +
                  (piece == fixed.size() ? "the goal" : "via point " + std::to_string(piece)) +
                  ": " + result.message;
    }
    from = cuts[piece++];
    return result;
  });
  if (!fixed.empty() && whole.status == PlanStatus::solved) {
    whole.message = std::move(messages);
  }
  return whole;
}
}  // namespace altiplan::host
