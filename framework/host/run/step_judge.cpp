// SPDX-License-Identifier: Apache-2.0
#include "host/run/pipeline_run.hpp"

#include <algorithm>

#include "host/base/machine_fault.hpp"
#include "host/judge/judge.hpp"

namespace altiplan::host {

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
      step.check = judge(step.route, request, mission_.via, mission_.runways);
      if (task_) {
        if (auto unflown = task_->violation(step.route, request)) {
          step.check->violations.push_back(*std::move(unflown));
        }
      }
    }
    step.measures = measure(step.route, request);
    step.metrics = measured(step.route, request, mission_.metrics);
    step.cost = price(step.route, request, mission_.via);
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

void Run::returns_step(const StepEntry& entry) {
  StepResult step = begin_attempt(entry, std::nullopt);
  const auto began = Clock::now();
  enter("judging the returns (" + entry.path + ") by layers and constraints");
  try {
    if (!options_.judge_returns) {
      throw Error("this program judges no returns: call `altiplan run`");
    }
    ReturnsVerdict verdict = options_.judge_returns(config_, unordered_, result_, entry);
    step.accepted = verdict.passes;
    step.status = verdict.passes ? RunStatus::solved : RunStatus::rejected;
    step.reason = verdict.passes ? Reason::none : Reason::constraint;
    step.message = std::move(verdict.message);
    step.returns = std::move(verdict.json);
  } catch (const MachineFault&) {
    throw;  // not a failure of the step
  } catch (const std::exception& error) {
    step.reason = reason_of(error);
    step.message = std::string("judging the returns threw: ") + error.what();
  }
  if (const std::string changed = leave(); !changed.empty()) {
    step.accepted = false;
    step.status = RunStatus::failed;
    step.reason = Reason::process_changed;
    step.message = "judging the returns, a layer or constraint " + changed;
  }
  step.time_s = seconds_since(began);
  const std::lock_guard lock(mutex_);
  result_.steps.back() = std::move(step);
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
}  // namespace altiplan::host
