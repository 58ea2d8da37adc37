// SPDX-License-Identifier: Apache-2.0
#include "host/run/pipeline_run.hpp"

#include <algorithm>

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
