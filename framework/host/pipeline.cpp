// SPDX-License-Identifier: Apache-2.0
#include "host/pipeline.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <mutex>

#include "host/along_via.hpp"
#include "host/events.hpp"
#include "host/mission.hpp"
#include "host/rollout.hpp"
#include "host/trace_file.hpp"
#include "host/watchdog.hpp"

namespace altiplan::host {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point began) {
  return std::chrono::duration<double>(Clock::now() - began).count();
}

class Run {
 public:
  Run(const Config& config, const RunOptions& options)
      : config_(config),
        options_(options),
        watchdog_([this](const std::string& why) { give_up(why); }) {
    if (options.trace) {
      trace_ = std::make_unique<TraceFile>(*options.trace);
      result_.trace = options.trace->string();
    }
  }

  RunResult operator()() {
    mission_ = build_mission(config_, options_.threads);
    result_.frame = mission_.truth.frame();
    result_.setup_time_s = mission_.setup_time_s;
    result_.notes = mission_.notes;
    result_.warnings = mission_.warnings;
    for (const StepEntry& step : config_.steps) {
      if (step.verb != Verb::plan && !result_.standing) {
        break;
      }
      if (step.verb == Verb::fly) {
        fly_step(step);
      } else {
        attempt(step);
      }
    }
    conclude();
    if (trace_) {
      trace_->close();
    }
    return std::move(result_);
  }

 private:
  /// The step, then its alternatives, until one stands.
  void attempt(const StepEntry& step) {
    if (one_attempt(step, std::nullopt)) {
      return;
    }
    for (const StepEntry& other : step.otherwise) {
      if (one_attempt(other, step.id)) {
        return;
      }
    }
  }

  bool one_attempt(const StepEntry& entry, std::optional<std::string> instead_of) {
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
    if (entry.verb == Verb::plan) {
      plan(entry, step);
    } else {
      smooth(entry, step);
    }
    const std::lock_guard lock(mutex_);
    result_.steps.back() = step;
    if (step.stands) {
      result_.standing = result_.steps.size() - 1;
    }
    return step.stands;
  }

  /// The mission's request with the step's budget, stream and trace.
  Request request_for(const StepEntry& entry, std::uint64_t index) {
    Request request = mission_.request;
    request.random = mission_.request.random.sub("step:" + entry.id, index);
    request.trace = trace_.get();
    if (entry.within_s) {
      request.budget.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                   std::chrono::duration<double>(*entry.within_s));
    }
    if (entry.within_iterations) {
      request.budget.max_iterations = std::uint64_t(*entry.within_iterations);
    }
    if (entry.within_mb) {
      request.budget.max_memory_bytes = std::size_t(*entry.within_mb * 1e6);
    }
    request.budget.stop =
        watchdog_.arm(entry.within_s.value_or(kDefaultStepSeconds), entry.within_mb);
    interrupt_ = std::make_unique<std::stop_callback<std::function<void()>>>(
        options_.stop, [this] { watchdog_.stop_now(); });
    return request;
  }

  /// Runs a plugin's work under the watchdog, timed; what it throws ends up in the step.
  void guarded(const StepEntry& entry, StepResult& step,
               const std::function<PlanResult(const Request&)>& work) {
    Request request = request_for(entry, result_.steps.size());
    const auto began = Clock::now();
    PlanResult result;
    try {
      result = work(request);
    } catch (const ParameterError& error) {
      watchdog_.disarm();
      throw ConfigError(place_of_parameter(entry, error.key()), entry.path + ".with." + error.key(),
                        error.what());
    } catch (const std::exception& error) {
      result = PlanResult{};
      result.message = error.what();
    }
    step.time_s = seconds_since(began);
    watchdog_.disarm();
    if (watchdog_.out_of_memory() && result.status != Status::solved) {
      result.message = "stopped: it used more memory than its within_mb";
    }
    step.status = result.status;
    step.message = std::move(result.message);
    step.counters = std::move(result.counters);
    step.budget_hit = result.budget_hit;
    step.proved = result.proved;
    step.route = std::move(result.route);
  }

  /// A planner, or a local planner that is rolled out, kept for the sessions that use it.
  struct PlanPlugin {
    std::unique_ptr<Planner> planner;
    std::unique_ptr<LocalPlanner> local_planner;
    PlanPart part() const {
      return [this](const Request& request) {
        return planner ? planner->plan(request) : roll_out(*local_planner, request);
      };
    }
  };

  const PlanPlugin& make_plan(const StepEntry& entry) {
    auto made = std::make_unique<PlanPlugin>();
    if (config_.registry->offering("planner", entry.plugin) == nullptr) {
      made->local_planner = make(entry, &PluginEntry::local_planner);
    } else {
      made->planner = make(entry, &PluginEntry::planner);
    }
    plan_plugins_.push_back(std::move(made));
    return *plan_plugins_.back();
  }

  /// A session from the request's start: the planner's own, where it can have one.
  std::unique_ptr<Session> begin_session(const PlanPlugin& made, const Request& request) {
    if (made.planner && mission_.via.empty()) {
      return made.planner->begin(request);
    }
    return std::make_unique<FreshVia>(request, mission_.via, made.part());
  }

  void plan(const StepEntry& entry, StepResult& step) {
    const auto began = Clock::now();
    const PlanPlugin& made = make_plan(entry);
    step.setup_time_s = seconds_since(began);
    const bool goes_on =
        std::any_of(config_.steps.begin(), config_.steps.end(), [&](const StepEntry& other) {
          return other.fly.replan.text == entry.id && other.verb == Verb::fly;
        });
    guarded(entry, step, [&](const Request& request) {
      if (!goes_on) {
        return plan_along(request, mission_.via, made.part());
      }
      sessions_[entry.id] = begin_session(made, request);
      return sessions_[entry.id]->result();
    });
    judge_step(step, mission_.request);
  }

  void smooth(const StepEntry& entry, StepResult& step) {
    const auto began = Clock::now();
    const std::unique_ptr<Smoother> smoother = make(entry, &PluginEntry::smoother);
    step.setup_time_s = seconds_since(began);
    const Route& before = input_of(entry).route;
    guarded(entry, step,
            [&](const Request& request) { return between_via(*smoother, before, request); });
    judge_step(step, mission_.request);
    if (!step.stands) {
      step.message += step.message.empty() ? "" : "; ";
      step.message += "the route stays as it was";
    }
  }

  /// Smooths the pieces between via points, which stay.
  PlanResult between_via(const Smoother& smoother, const Route& before, const Request& request) {
    std::vector<std::size_t> cuts = via_indices(before, mission_.via);
    std::vector<Goal> fixed;
    for (const std::size_t cut : cuts) {
      fixed.push_back({before[cut], 0});
    }
    cuts.push_back(before.size() - 1);
    std::size_t from = 0;
    std::size_t piece = 0;
    return plan_along(request, fixed, [&](const Request& part) {
      const Route raw(before.begin() + std::ptrdiff_t(from),
                      before.begin() + std::ptrdiff_t(cuts[piece]) + 1);
      from = cuts[piece++];
      return smoother.smooth(raw, part);
    });
  }

  /// The step whose route `entry` takes.
  const StepResult& input_of(const StepEntry& entry) const {
    if (entry.from) {
      for (const StepResult& step : result_.steps) {
        if (step.id == *entry.from && step.stands) {
          return step;
        }
      }
    }
    return result_.steps[*result_.standing];
  }

  void judge_step(StepResult& step, const Request& request) {
    if (step.route.empty()) {
      return;
    }
    step.measures = measure(step.route, request);
    if (step.status != Status::solved) {
      return;
    }
    step.check = judge(step.route, request, mission_.via);
    step.stands = step.check->ok();
    if (!step.stands) {
      step.status = blames_layer(*step.check) ? Status::failed : Status::rejected;
      step.message = "the judge found " + std::to_string(step.check->violations.size()) +
                     " violation" + (step.check->violations.size() == 1 ? "" : "s") +
                     "; the first, at waypoint " +
                     std::to_string(step.check->violations.front().at) + " (" +
                     step.check->violations.front().constraint +
                     "): " + step.check->violations.front().message;
    }
  }

  template <class Interface>
  std::unique_ptr<Interface> make(const StepEntry& entry,
                                  std::unique_ptr<Interface> (*PluginEntry::*maker)(const Value*)) {
    const char* kind = detail::Kind<Interface>::kName;
    try {
      return (plugin(*config_.registry, kind, entry.plugin).*maker)(&entry.with);
    } catch (const ConfigError&) {
      throw;
    } catch (const PluginError& error) {
      throw PluginError(std::string("the ") + kind + " '" + entry.plugin + "' (" + entry.path +
                        ") " + error.what());
    } catch (const ParameterError& error) {
      throw ConfigError(place_of_parameter(entry, error.key()), entry.path + ".with." + error.key(),
                        error.what());
    } catch (const Error& error) {
      throw ConfigError(entry.with.where, entry.path + ".with", error.what());
    }
  }

  static Location place_of_parameter(const StepEntry& entry, std::string_view key) {
    for (const Value::Entry& parameter : entry.with.entries) {
      if (parameter.key == key) {
        return parameter.where;
      }
    }
    return entry.where;
  }

  /// The flight; its alternatives are flown when it fails before the goal.
  void fly_step(const StepEntry& step) {
    fly_once(step, std::nullopt);
    for (const StepEntry& other : step.otherwise) {
      if (result_.flight->status == Status::solved) {
        return;
      }
      fly_once(other, step.id);
    }
  }

  void fly_once(const StepEntry& entry, std::optional<std::string> instead_of) {
    StepResult step;
    step.id = entry.id;
    step.verb = Verb::fly;
    step.plugin = entry.plugin;
    step.instead_of = std::move(instead_of);
    {
      const std::lock_guard lock(mutex_);
      result_.steps.push_back(step);
    }
    const auto began = Clock::now();
    FlightSetup setup;
    Request request = request_for(entry, result_.steps.size());
    request.limits = mission_.track_request.limits;
    request.constraints = mission_.track_request.constraints;
    setup.request = request;
    setup.route_request = mission_.request;
    setup.route_request.random = request.random;
    setup.route_request.budget.stop = request.budget.stop;
    setup.route = input_of(entry).route;
    setup.truth = mission_.truth;
    setup.events = build_events(config_, mission_);
    std::unique_ptr<LocalPlanner> pilot;
    if (entry.plugin != kFollowRoute) {
      pilot = make(entry, &PluginEntry::local_planner);
      setup.pilot = pilot.get();
      setup.pilot_name = entry.plugin;
    }
    setup.always = entry.fly.command == "always";
    setup.step_s = entry.fly.step_s;
    setup.when = entry.fly.when == "any_change" ? ReplanWhen::any_change : ReplanWhen::unsafe;
    setup.replan_latency_s = entry.fly.replan_latency_s;
    setup.max_time_s = entry.fly.max_time_s;
    std::vector<std::unique_ptr<Smoother>> smoothers;
    for (const SmootherEntry& smoother : entry.fly.smooth) {
      StepEntry as_step;
      as_step.plugin = smoother.plugin;
      as_step.with = smoother.parameters;
      as_step.path = entry.path + ".smooth";
      smoothers.push_back(make(as_step, &PluginEntry::smoother));
      setup.smoothers.push_back(smoothers.back().get());
    }
    find_replanner(entry, setup);
    step.setup_time_s = seconds_since(began);
    FlightResult flight = fly(setup);
    watchdog_.disarm();
    step.time_s = seconds_since(began) - step.setup_time_s;
    step.stands = flight.status == Status::solved;
    step.status = flight.status;
    step.message = flight.message;
    step.counters = flight.counters;
    const std::lock_guard lock(mutex_);
    result_.steps.back() = std::move(step);
    result_.flight = std::move(flight);
  }

  /// The session that goes on in flight: a plan step's, or one begun now.
  void find_replanner(const StepEntry& entry, FlightSetup& setup) {
    const Value& replan = entry.fly.replan;
    if (replan.kind == Value::Kind::map) {
      StepEntry planner;
      bind(planner, &replan, entry.path + ".replan");
      planner.path = entry.path + ".replan";
      sessions_[planner.path] = begin_session(make_plan(planner), setup.route_request);
      setup.replanner = sessions_[planner.path].get();
      setup.replan_step = planner.id;
      setup.replan_within_s = planner.within_s;
    } else if (!replan.text.empty()) {
      setup.replanner = sessions_.at(replan.text).get();
      setup.replan_step = replan.text;
    }
  }

  void conclude() {
    result_.budget_hit = std::any_of(result_.steps.begin(), result_.steps.end(),
                                     [](const StepResult& s) { return s.budget_hit; });
    if (!result_.standing) {
      const StepResult& last = result_.steps.back();
      result_.status = last.status;
      result_.message = last.id + ": " + last.message;
      return;
    }
    const std::string standing = result_.steps[*result_.standing].id;
    result_.status = result_.flight ? result_.flight->status : Status::solved;
    result_.message = "the route of '" + standing + "' stands" +
                      (result_.flight ? "; the flight: " + result_.flight->message : "");
  }

  /// On the watchdog's thread: the step that is under way never stopped.
  void give_up(const std::string& why) {
    const std::lock_guard lock(mutex_);
    if (!result_.steps.empty()) {
      StepResult& step = result_.steps.back();
      step.status = Status::failed;
      step.message = why;
    }
    result_.status = Status::failed;
    result_.message = (result_.steps.empty() ? "" : result_.steps.back().id + ": ") + why;
    options_.on_stuck(result_);
    std::abort();  // on_stuck does not return
  }

  const Config& config_;
  const RunOptions& options_;
  Mission mission_;
  std::mutex mutex_;  ///< guards result_ against the watchdog
  RunResult result_;
  std::unique_ptr<TraceFile> trace_;
  std::vector<std::unique_ptr<PlanPlugin>> plan_plugins_;
  std::map<std::string, std::unique_ptr<Session>> sessions_;  ///< by step
  Watchdog watchdog_;
  std::unique_ptr<std::stop_callback<std::function<void()>>> interrupt_;
};
}  // namespace

int RunResult::exit_code() const {
  if (status == Status::solved) {
    return 0;
  }
  const bool failed = std::any_of(steps.begin(), steps.end(), [](const StepResult& step) {
    return step.status == Status::failed;
  });
  return !standing && failed ? 4 : 1;
}

RunResult run(const Config& config, const RunOptions& options) { return Run(config, options)(); }
}  // namespace altiplan::host
