// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "host/judge/judge.hpp"
#include "host/run/pipeline_run.hpp"

namespace altiplan::host {

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
  return std::make_unique<FreshVia>(request, mission_.via, made.part());
}

bool Run::flown_with(const std::string& id) const {
  const StepEntry& last = config_.steps.back();
  const auto names_it = [&](const StepEntry& step) { return step.fly.replan.text == id; };
  return names_it(last) || std::any_of(last.otherwise.begin(), last.otherwise.end(), names_it);
}

void Run::plan(const StepEntry& entry, StepResult& step) {
  const auto began = Clock::now();
  const PlanPlugin& made = make_plan(entry);
  step.setup_time_s = seconds_since(began);
  guarded(entry, step, [&](const Request& request) {
    if (!flown_with(entry.id)) {
      return plan_along(request, mission_.via, made.part());
    }
    sessions_[entry.id] = begin_session(made, request);
    return sessions_[entry.id]->result();
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
    fixed.push_back({before[cut], 0});
  }
  cuts.push_back(before.size() - 1);
  std::size_t from = 0;
  std::size_t piece = 0;
  std::string told;  // one message per section: a smoother sees only its own
  PlanResult whole = plan_along(request, fixed, [&](const Request& part) {
    PlanResult result = smoother.smooth(before.part(from, cuts[piece]), part);
    if (!result.message.empty()) {
      told += (told.empty() ? "to " : "; to ") +
              (piece == fixed.size() ? "the goal" : "via point " + std::to_string(piece)) + ": " +
              result.message;
    }
    from = cuts[piece++];
    return result;
  });
  if (!fixed.empty() && whole.status == PlanStatus::solved) {
    whole.message = std::move(told);
  }
  return whole;
}

void Run::judge_step(StepResult& step, const Request& request) {
  if (step.route.empty() || !std::all_of(step.route.begin(), step.route.end(), is_finite)) {
    return;
  }
  std::string asked;
  for (const Layer& layer : request.world->layers()) {
    asked += (asked.empty() ? "" : ", ") + layer.id;
  }
  for (const NamedConstraint& constraint : request.constraints) {
    asked += (asked.empty() ? "" : ", ") + constraint.name;
  }
  enter("judging the route of '" + step.id + "' by layers and constraints (" + asked + ")");
  try {
    if (step.status == RunStatus::solved) {  // first: the judge knows the cause
      step.check = judge(step.route, request, mission_.via);
    }
    step.measures = measure(step.route, request);
    if (step.check) {
      take_verdict(step);
    }
  } catch (const std::exception& error) {
    step.status = RunStatus::failed;
    step.reason = reason_of(error);
    step.message = std::string("judging the route, a layer or constraint threw: ") + error.what();
  } catch (...) {
    step.status = RunStatus::failed;
    step.reason = Reason::threw;
    step.message = "judging the route, a layer or constraint threw";
  }
  if (const std::string changed = leave(); !changed.empty()) {
    step.accepted = false;
    step.status = RunStatus::failed;
    step.reason = Reason::process_changed;
    step.message = "judging the route, a layer or constraint " + changed;
  }
}

void Run::take_verdict(StepResult& step) {
  const std::vector<Violation>& found = step.check->violations;
  step.accepted = found.empty();
  if (step.accepted) {
    return;
  }
  const Violation* worst = violated_layer(*step.check);
  step.status = worst != nullptr ? RunStatus::failed : RunStatus::rejected;
  step.reason = worst != nullptr ? Reason::contract : Reason::constraint;
  if (worst == nullptr) {
    worst = &found.front();
  }
  step.message = verdict_sentence(*step.check, *worst);
}

ConfigError Run::at_its_key(const StepEntry& entry, const ParameterError& error) {
  Location where = entry.where;
  for (const Value::Entry& parameter : entry.with.entries) {
    if (parameter.key == error.key()) {
      where = parameter.where;
    }
  }
  return ConfigError(where, entry.path + ".with." + error.key(), error.what());
}
}  // namespace altiplan::host
