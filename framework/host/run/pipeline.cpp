// SPDX-License-Identifier: Apache-2.0
#include "host/run/pipeline.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <mutex>

#include "host/run/along_via.hpp"
#include "host/run/events.hpp"
#include "host/run/mission.hpp"
#include "host/run/rollout.hpp"
#include "host/run/trace_file.hpp"
#include "host/run/watchdog.hpp"

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
    if (config_.steps.back().verb == Verb::fly) {
      events_ = build_events(config_, mission_);  // what is wrong with them is said before planning
    }
    for (const StepEntry& step : config_.steps) {
      if (interrupted()) {
        break;
      }
      if (step.verb != Verb::plan && !result_.standing) {
        continue;  // there is no route to work on
      }
      if (step.verb == Verb::fly) {
        fly_step(step);
      } else {
        attempt(step);
      }
    }
    conclude();
    if (trace_) {
      try {
        trace_->close();
      } catch (const Error& error) {  // the result is not lost with it
        result_.trace_error = error.what();
      }
    }
    return std::move(result_);
  }

 private:
  bool interrupted() const { return options_.stop.stop_requested(); }

  /// The step, then its alternatives, until one stands. What it leaves is the route that `from`
  /// finds under its id: its own, or the one that it was to work on.
  void attempt(const StepEntry& step) {
    std::optional<std::size_t> leaves;
    if (step.verb == Verb::smooth) {
      leaves = input_of(step);
    }
    bool stands = one_attempt(step, std::nullopt);
    for (auto other = step.otherwise.begin();
         other != step.otherwise.end() && !stands && !interrupted(); ++other) {
      stands = one_attempt(*other, step.id);
    }
    if (stands) {
      leaves = result_.standing;
      left_by_[result_.steps.back().id] = *leaves;
    }
    if (leaves) {
      left_by_[step.id] = *leaves;
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
    if (step.status == Status::cancelled &&
        !interrupted()) {  // the watchdog's stop, not the user's
      step.status = Status::timed_out;
      step.budget_hit = true;
      if (!watchdog_.out_of_memory()) {
        step.message = "its time was used up (" + step.message + ")";
      }
    }
    const std::lock_guard lock(mutex_);
    result_.steps.back() = step;
    if (step.stands) {
      result_.standing = result_.steps.size() - 1;
    }
    return step.stands;
  }

  static void set_budget(Budget& budget, const StepEntry& entry) {
    if (entry.within_s) {
      budget.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(*entry.within_s));
    }
    if (entry.within_iterations) {
      budget.max_iterations = std::uint64_t(*entry.within_iterations);
    }
    if (entry.within_mb) {
      budget.max_memory_bytes = std::size_t(*entry.within_mb * 1e6);
    }
  }

  /// The mission's request with the step's budget, stream and trace.
  Request request_for(const StepEntry& entry, std::uint64_t index) {
    Request request = mission_.request;
    request.random = mission_.request.random.sub("step:" + entry.id, index);
    request.trace = trace_.get();
    set_budget(request.budget, entry);
    request.budget.stop =
        watchdog_.arm(entry.within_s.value_or(kDefaultStepSeconds), entry.within_mb);
    interrupt_ = std::make_unique<std::stop_callback<std::function<void()>>>(
        options_.stop, [this] { watchdog_.stop_now(); });
    return request;
  }

  /// Runs a plugin's work under the watchdog, timed; what it throws ends up in the step.
  void guarded(const StepEntry& entry, StepResult& step,
               const std::function<PlanResult(const Request&)>& work) {
    const Request request = request_for(entry, result_.steps.size());
    const auto began = Clock::now();
    PlanResult result;
    try {
      result = work(request);
    } catch (const ParameterError& error) {
      throw at_its_key(entry, error);
    } catch (const std::exception& error) {
      result = PlanResult{};
      result.message = std::string("threw: ") + error.what();
    } catch (...) {
      result = PlanResult{};
      result.message = "threw something that is not a std::exception";
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

  /// Whether a flight goes on with the session of that plan step.
  bool flown_with(const std::string& id) const {
    const StepEntry& last = config_.steps.back();
    const auto names_it = [&](const StepEntry& step) { return step.fly.replan.text == id; };
    return names_it(last) || std::any_of(last.otherwise.begin(), last.otherwise.end(), names_it);
  }

  void plan(const StepEntry& entry, StepResult& step) {
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

  void smooth(const StepEntry& entry, StepResult& step) {
    const auto began = Clock::now();
    const std::unique_ptr<Smoother> smoother = make(entry, &PluginEntry::smoother);
    step.setup_time_s = seconds_since(began);
    const Route& before = result_.steps[input_of(entry)].route;
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

  /// Index of the step whose route `entry` takes.
  std::size_t input_of(const StepEntry& entry) const {
    const auto named = entry.from ? left_by_.find(*entry.from) : left_by_.end();
    return named != left_by_.end() ? named->second : *result_.standing;
  }

  /// Judges and measures; layers and constraints that throw fail the step.
  void judge_step(StepResult& step, const Request& request) {
    if (step.route.empty() || !std::all_of(step.route.begin(), step.route.end(), is_finite)) {
      return;
    }
    try {
      step.measures = measure(step.route, request);
      if (step.status == Status::solved) {
        step.check = judge(step.route, request, mission_.via);
        take_verdict(step);
      }
    } catch (const std::exception& error) {
      step.status = Status::failed;
      step.message = std::string("judging the route, a layer or constraint threw: ") + error.what();
    } catch (...) {
      step.status = Status::failed;
      step.message = "judging the route, a layer or constraint threw";
    }
  }

  static void take_verdict(StepResult& step) {
    const std::vector<Violation>& found = step.check->violations;
    step.stands = found.empty();
    if (step.stands) {
      return;
    }
    const Violation* worst = blamed_layer(*step.check);
    step.status = worst != nullptr ? Status::failed : Status::rejected;
    if (worst == nullptr) {
      worst = &found.front();
    }
    step.message = "the judge found " + std::to_string(found.size()) + " violation" +
                   (found.size() == 1 ? "" : "s; the first") + ", at waypoint " +
                   std::to_string(worst->at) + " (" + worst->constraint + "): " + worst->message;
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
      throw at_its_key(entry, error);
    } catch (const Error& error) {
      throw ConfigError(entry.with.where, entry.path + ".with", error.what());
    }
  }

  static ConfigError at_its_key(const StepEntry& entry, const ParameterError& error) {
    Location where = entry.where;
    for (const Value::Entry& parameter : entry.with.entries) {
      if (parameter.key == error.key()) {
        where = parameter.where;
      }
    }
    return ConfigError(where, entry.path + ".with." + error.key(), error.what());
  }

  /// The flight; its alternatives are flown when it fails before the goal.
  void fly_step(const StepEntry& step) {
    fly_once(step, std::nullopt);
    for (const StepEntry& other : step.otherwise) {
      if (result_.flight->status == Status::solved || interrupted()) {
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
    if (trace_) {
      trace_->begin_step(entry.id);
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
    setup.route_request.trace = request.trace;
    setup.route = result_.steps[input_of(entry)].route;
    setup.truth = mission_.truth;
    setup.events = events_;
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
    FlightResult flight;
    try {
      flight = fly(setup);
    } catch (const ParameterError& error) {
      throw at_its_key(entry, error);
    }
    watchdog_.disarm();
    step.time_s = seconds_since(began) - step.setup_time_s;
    if (flight.status == Status::cancelled && !interrupted()) {
      step.budget_hit = true;
      flight.status = Status::not_reached;
      flight.message = (watchdog_.out_of_memory() ? "the step's memory was used up: "
                                                  : "the step's computing time ended: ") +
                       flight.message;
    }
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
    StepEntry planner;
    if (replan.kind == Value::Kind::map) {
      bind(planner, &replan, entry.path + ".replan");
      planner.path = entry.path + ".replan";
      planner.where = replan.where;
    } else if (replan.text.empty()) {
      return;
    } else {
      planner = plan_entry(replan.text);
    }
    setup.replan_step = planner.id;
    setup.replan_within_s = planner.within_s;
    set_budget(setup.route_request.budget, planner);
    std::unique_ptr<Session>& session = sessions_[replan.text.empty() ? planner.path : planner.id];
    if (session == nullptr) {  // also of an alternative that was not needed
      try {
        session = begin_session(make_plan(planner), setup.route_request);
      } catch (const ParameterError& error) {
        throw at_its_key(planner, error);
      }
    }
    setup.replanner = session.get();
  }

  /// The plan step, or alternative, of that id; the configuration has made sure that there is one.
  const StepEntry& plan_entry(const std::string& id) const {
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

  void conclude() {
    result_.budget_hit = std::any_of(result_.steps.begin(), result_.steps.end(),
                                     [](const StepResult& s) { return s.budget_hit; });
    if (interrupted()) {
      result_.status = Status::cancelled;
      result_.message = "interrupted";
      if (result_.standing) {
        result_.message += "; the route of '" + result_.steps[*result_.standing].id + "' stands";
      }
      return;
    }
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
  std::map<std::string, std::size_t> left_by_;  ///< index of the step whose route an id stands for
  std::vector<FlightEvent> events_;
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
