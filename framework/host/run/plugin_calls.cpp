// SPDX-License-Identifier: Apache-2.0
#include "host/run/pipeline_run.hpp"

#include <cstdlib>

#include "altiplan/error.hpp"
#include "host/base/machine_fault.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {

// A plugin at work: within its budget, under the watchdog, its exceptions recorded.

Request Run::request_for(const StepEntry& entry, std::uint64_t index) {
  Request request = mission_.request;
  request.random = mission_.request.random.sub("step:" + entry.id, index);
  request.trace = trace_.get();
  set_budget(request.budget, entry);
  request.budget.progress = &progress_.search;
  name_caller(named(entry));
  if (trace_) {
    trace_->begin_search(progress_.search);
  }
  request.budget.stop = arm(entry.within_s.value_or(options_.timeout_s), entry.within_mb);
  return request;
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

std::string Run::time_budget(const StepEntry& entry) const {
  const double seconds = entry.within_s.value_or(options_.timeout_s);
  return (entry.within_s ? entry.path + ".within_s" : std::string("--timeout")) + " is " +
         with_digits(seconds, 6) + " s";
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

std::string Run::named(const StepEntry& entry) const {
  std::string kind = entry.verb == Verb::smooth ? "smoother" : "local_planner";
  if (entry.verb == Verb::plan && config_.registry->offering("planner", entry.plugin) != nullptr) {
    kind = "planner";
  }
  return (entry.verb == Verb::fly ? "the flight with the " : "the ") + kind + " '" + entry.plugin +
         "' (" + entry.path + ")";
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
  if (trace_ && mission_.via.empty() && !task_) {  // else that of a section
    step.first_route_s = trace_->first_route_s();
  }
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

ConfigError Run::at_its_key(const StepEntry& entry, const ParameterError& error) {
  Location where = entry.where;
  for (const Value::Entry& parameter : entry.with.entries) {
    if (parameter.key == error.key()) {
      where = parameter.where;
    }
  }
  return ConfigError(where, entry.path + ".with." + error.key(), error.what());
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
}  // namespace altiplan::host
