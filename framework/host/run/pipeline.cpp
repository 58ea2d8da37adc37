// SPDX-License-Identifier: Apache-2.0
#include "host/run/pipeline.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "altiplan/error.hpp"
#include "host/base/machine_fault.hpp"
#include "host/flight/events.hpp"
#include "host/run/pipeline_run.hpp"

namespace altiplan::host {

Run::Run(const Config& config, const RunOptions& options)
    : config_(config),
      options_(options),
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
  result_.frame = mission_.truth.frame();
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
  given.check = judge(route, mission_.request, mission_.via);
  result_.steps.push_back(std::move(given));
  result_.accepted = 0;
}

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
  if (options_.progress != nullptr) {
    options_.progress->begin_step();
  }
  return step;
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
    step.message = "time budget exhausted: " + time_budget(entry) + " (" + step.message + ")";
  }
  const std::lock_guard lock(mutex_);
  result_.steps.back() = step;
  if (step.accepted) {
    result_.accepted = result_.steps.size() - 1;
  }
  return step.accepted;
}

std::string Run::time_budget(const StepEntry& entry) const {
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%g s", entry.within_s.value_or(options_.timeout_s));
  return (entry.within_s ? entry.path + ".within_s" : std::string("--timeout")) + " is " + seconds;
}

void Run::set_budget(Budget& budget, const StepEntry& entry) {
  if (entry.within_s) {
    budget.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                         std::chrono::duration<double>(*entry.within_s));
  }
  if (entry.within_iterations) {
    budget.max_iterations = std::uint64_t(*entry.within_iterations);
  }
  if (entry.within_mb) {
    budget.max_memory_bytes = std::size_t(*entry.within_mb * double(1 << 20));
  }
}

void Run::name_caller(std::string who) {
  const std::lock_guard lock(mutex_);
  caller_ = std::move(who);
  if (!options_.on_call) {
    return;
  }
  RunResult ended = result_;
  ended.status = RunStatus::failed;
  ended.reason = Reason::process_ended;
  ended.message = caller_ + " " + ProcessGuard::CrashReport::kCause;
  if (!ended.steps.empty()) {
    ended.steps.back().status = RunStatus::failed;
    ended.steps.back().reason = Reason::process_ended;
    ended.steps.back().message = ended.message;
    ended.message = ended.steps.back().id + ": " + ended.message;
  }
  options_.on_call(ended);
}

void Run::enter(std::string who, std::optional<double> memory_mb) {
  name_caller(std::move(who));
  arm(options_.timeout_s, memory_mb);
}

std::stop_token Run::arm(double seconds, std::optional<double> memory_mb) {
  std::stop_token token = watchdog_.arm(seconds, memory_mb);
  if (interrupted()) {
    watchdog_.stop_now();
  }
  return token;
}

std::string Run::leave() {
  watchdog_.disarm();
  if (options_.process == nullptr || caller_.empty()) {
    return "";
  }
  const std::string changed = options_.process->restore();
  if (options_.process->pass_on_output()) {
    const std::string warning = caller_ + " wrote to stdout; its output is on stderr";
    const std::lock_guard lock(mutex_);
    if (result_.warnings.empty() || result_.warnings.back() != warning) {
      result_.warnings.push_back(warning);
    }
  }
  return changed.empty()
             ? ""
             : "violated the contract of every plugin: it changed " + changed + " of the process";
}

void Run::expect_left_alone() {
  if (const std::string changed = leave(); !changed.empty()) {
    throw PluginError(caller_ + " " + changed);
  }
}

std::string Run::named(const StepEntry& entry) const {
  std::string kind = entry.verb == Verb::smooth ? "smoother" : "local_planner";
  if (entry.verb == Verb::plan && config_.registry->offering("planner", entry.plugin) != nullptr) {
    kind = "planner";
  }
  return (entry.verb == Verb::fly ? "the flight with the " : "the ") + kind + " '" + entry.plugin +
         "' (" + entry.path + ")";
}

Request Run::request_for(const StepEntry& entry, std::uint64_t index) {
  Request request = mission_.request;
  request.random = mission_.request.random.sub("step:" + entry.id, index);
  request.trace = trace_.get();
  set_budget(request.budget, entry);
  if (options_.progress != nullptr) {
    request.budget.progress = &options_.progress->search;
  }
  name_caller(named(entry));
  request.budget.stop = arm(entry.within_s.value_or(options_.timeout_s), entry.within_mb);
  return request;
}

void Run::guarded(const StepEntry& entry, StepResult& step,
                  const std::function<PlanResult(const Request&)>& work) {
  const Request request = request_for(entry, result_.steps.size());
  const auto began = Clock::now();
  step.status = RunStatus::failed;
  try {
    take_answer(step, work(request));
    // At the deadline the watchdog's stop can reach the plugin before its own look at the clock.
    if (step.status == RunStatus::solved && request.budget.stop.stop_requested() &&
        !interrupted()) {
      step.budget_hit = true;
    }
    if (step.status == RunStatus::timed_out && request.budget.deadline &&
        Clock::now() >= *request.budget.deadline) {
      step.reason = Reason::deadline;
    }
  } catch (const ParameterError& error) {
    throw at_its_key(entry, error);
  } catch (const MachineFault&) {
    throw;  // not a failure of the step
  } catch (const PluginError& error) {
    step.reason = error.reason();
    step.message = error.what();
  } catch (const std::exception& error) {
    step.reason = reason_of(error);
    step.message = std::string("threw: ") + error.what();
  } catch (...) {
    step.reason = Reason::threw;
    step.message = "threw something that is not a std::exception";
  }
  step.time_s = seconds_since(began);
  if (const std::string changed = leave(); !changed.empty()) {
    step.status = RunStatus::failed;
    step.reason = Reason::process_changed;
    step.message = changed;
  }
  if (watchdog_.out_of_memory() && step.status != RunStatus::solved) {
    step.reason = Reason::memory;
    step.message = "stopped: it used more memory than its within_mb";
  }
  if (step.message.empty() && step.status != RunStatus::solved) {
    step.message = "the plugin gave no reason";
  }
}

void Run::take_answer(StepResult& step, PlanResult answer) {
  step.status = run_status(answer.status);
  step.reason = answer.reason;
  step.message = std::move(answer.message);
  step.counters = std::move(answer.counters);
  step.budget_hit = answer.budget_hit;
  step.proved = answer.proved;
  step.route = std::move(answer.route);
}

std::size_t Run::input_of(const StepEntry& entry) const {
  const auto named = entry.from ? left_by_.find(*entry.from) : left_by_.end();
  return named != left_by_.end() ? named->second : *result_.accepted;
}

void Run::conclude() {
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
  const std::string accepted = result_.steps[*result_.accepted].id;
  result_.status = result_.flight ? result_.flight->status : RunStatus::solved;
  result_.reason = result_.flight ? result_.flight->reason : Reason::none;
  result_.message = "route accepted (from '" + accepted + "')" +
                    (result_.flight ? "; the flight: " + result_.flight->message : "");
}

void Run::give_up(const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (!result_.steps.empty()) {
    StepResult& step = result_.steps.back();
    step.status = interrupted() ? RunStatus::cancelled : RunStatus::failed;
    step.reason = Reason::never_stopped;
    step.message = caller_ + " " + why;
  }
  result_.message =
      (result_.steps.empty() ? "" : result_.steps.back().id + ": ") + caller_ + " " + why;
  result_.status = RunStatus::failed;
  result_.reason = Reason::never_stopped;
  if (interrupted()) {
    conclude();
  }
  if (trace_) {  // incomplete: the step may still write to it
    std::error_code ignored;
    std::filesystem::rename(trace_->file().beside(), trace_->file().absolute_place(), ignored);
  }
  options_.on_stuck(result_);
  std::abort();  // on_stuck does not return
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
