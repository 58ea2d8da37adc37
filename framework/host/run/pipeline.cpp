// SPDX-License-Identifier: Apache-2.0
#include "host/run/pipeline.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"
#include "altiplan/measures.hpp"
#include "host/base/words.hpp"
#include "host/energy/way_home.hpp"
#include "host/flight/events.hpp"
#include "host/judge/judge.hpp"
#include "host/run/pipeline_run.hpp"

namespace altiplan::host {
namespace {

/// How much longer the route may be than the shortest, where the planner knows that.
std::string proved_gap(const StepResult& step) {
  for (const Counter& counter : step.counters) {
    if (counter.name == "bound_mm" && counter.value > 0) {
      const double over = 1000 * length(step.route) / double(counter.value) - 1;
      const double percent = std::max(std::ceil(1e6 * over) / 1e4, 0.0);  // no less than it is
      return ", at most " + with_digits(percent, 6) +
             " % longer than the shortest of its search space";
    }
  }
  return "";
}
}  // namespace

Run::Run(const Config& config, const RunOptions& options)
    : config_(config),
      options_(options),
      progress_(options.progress != nullptr ? *options.progress : own_progress_),
      watchdog_([this](const std::string& why) { give_up(why); },
                [&options] { return options.process ? options.process->kept_mb() : 0; }),
      interrupt_(options.stop, [this] { watchdog_.stop_now(); }) {
  if (options.out) {
    result_.folder = std::filesystem::absolute(*options.out).lexically_normal().parent_path();
  }
  if (options.trace) {
    trace_ = std::make_unique<TraceFile>(*options.trace, options.trace_limit_mb * 1'000'000);
    result_.trace = options.trace->string();
    if (options.process != nullptr) {
      options.process->keep_as_it_is(trace_->file().beside(), trace_->file().absolute_place());
    }
  }
}

RunResult Run::operator()() {
  mission_ = build_mission(config_, options_.threads, [this](const std::string& who) {
    expect_left_alone();
    if (!who.empty()) {
      enter(who);
    }
  });
  if (options_.on_mission) {
    options_.on_mission(mission_);
  }
  unordered_ = mission_;
  result_.frame = mission_.truth.frame();
  result_.objective = mission_.request.objective;
  result_.vehicle = mission_.request.vehicle;
  result_.setup_time_s = mission_.setup_time_s;
  result_.notes = mission_.notes;
  result_.warnings.insert(result_.warnings.end(), mission_.warnings.begin(),
                          mission_.warnings.end());
  if (config_.steps.back().verb == Verb::fly) {
    enter("the events of the scenario");
    events_ = build_events(config_, mission_);  // report their errors before planning
    expect_left_alone();
  }
  if (options_.real) {
    take_route(options_.real->route);
  }
  for (const StepEntry& step : config_.steps) {
    if (interrupted()) {
      break;
    }
    if (options_.real && step.verb != Verb::fly) {
      continue;
    }
    if (step.verb != Verb::plan && !result_.accepted) {
      continue;  // there is no input route
    }
    if (step.verb == Verb::fly) {
      fly_step(step);
    } else if (step.verb == Verb::returns) {
      returns_step(step);
    } else {
      attempt(step);
    }
  }
  conclude();
  if (trace_) {
    if (trace_->left_out() > 0) {
      result_.warnings.push_back(
          "the trace is full at " + std::to_string(options_.trace_limit_mb) +
          " MB: " + std::to_string(trace_->left_out()) +
          " events are left out; --trace-limit sets how many MB it may take");
    }
    try {
      trace_->close();
    } catch (const Error& error) {  // do not lose the result
      result_.trace_error = error.what();
    }
  }
  return std::move(result_);
}

void Run::take_route(const Route& route) {
  StepResult given;
  given.id = "result";
  given.accepted = true;
  given.status = RunStatus::solved;
  given.route = route;
  given.measures = measure(route, mission_.request);
  given.metrics = measured(route, mission_.request, mission_.metrics);
  given.check = judge(route, mission_.request, mission_.via, mission_.runways);
  given.cost = price(route, mission_.request, mission_.via);
  result_.steps.push_back(std::move(given));
  result_.accepted = 0;
}

void Run::conclude() {
  if (result_.accepted) {
    result_.point_of_no_return_s =
        point_of_no_return(result_.steps[*result_.accepted].route, mission_.request);
  }
  result_.budget_hit = std::any_of(result_.steps.begin(), result_.steps.end(),
                                   [](const StepResult& s) { return s.budget_hit; });
  if (interrupted()) {
    result_.status = RunStatus::cancelled;
    result_.message = "interrupted";
    if (result_.accepted) {
      result_.message += "; route accepted (from '" + result_.steps[*result_.accepted].id + "')";
    }
    return;
  }
  if (!result_.accepted) {
    const StepResult& last = result_.steps.back();
    result_.status = last.status;
    result_.reason = last.reason;
    result_.message = last.id + ": " + last.message;
    return;
  }
  const StepResult& accepted = result_.steps[*result_.accepted];
  result_.status = result_.flight ? result_.flight->status : RunStatus::solved;
  result_.reason = result_.flight ? result_.flight->reason : Reason::none;
  result_.message = "route accepted (from '" + accepted.id + "')" + proved_gap(accepted) +
                    (result_.flight ? "; the flight: " + result_.flight->message : "");
  for (const StepResult& step : result_.steps) {
    if (step.verb == Verb::returns && !step.accepted) {
      result_.message += "; " + step.id + ": " + step.message;
      if (result_.status == RunStatus::solved) {
        result_.status = step.status;
        result_.reason = step.reason;
      }
    }
  }
}

int RunResult::exit_code() const {
  if (status == RunStatus::solved) {
    return 0;
  }
  const bool failed = std::any_of(steps.begin(), steps.end(), [](const StepResult& step) {
    return step.status == RunStatus::failed;
  });
  return !accepted && (failed || status == RunStatus::failed) ? 4 : 1;
}

void RunProgress::begin_step() {
  search.expanded = search.open = search.iteration = 0;
  search.best = kInfinity;
  flown_s = 0;
}

RunResult run(const Config& config, const RunOptions& options) { return Run(config, options)(); }
}  // namespace altiplan::host
