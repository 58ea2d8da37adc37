// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "host/mission/mission.hpp"
#include "host/run/along_task.hpp"
#include "host/run/along_via.hpp"
#include "host/run/pipeline.hpp"
#include "host/run/rollout.hpp"
#include "host/run/trace_file.hpp"
#include "host/run/watchdog.hpp"

namespace altiplan::host {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point began) {
  return std::chrono::duration<double>(Clock::now() - began).count();
}

/// One run of a pipeline: the top level is in pipeline.cpp, plan and smooth steps in
/// plan_and_smooth.cpp, the judging of their routes in step_judge.cpp, the flight in fly_step.cpp,
/// and how plugins are called in plugin_calls.cpp.
class Run {
 public:
  Run(const Config& config, const RunOptions& options);
  RunResult operator()();

 private:
  bool interrupted() const { return options_.stop.stop_requested(); }

  /// Accepts a route that no step has planned.
  void take_route(const Route& route);
  /// Runs the step, then its alternatives, until one is accepted. Its id then refers to (`from`)
  /// the accepted route, or else to its input route.
  void attempt(const StepEntry& step);
  /// Adds the attempt to the result, so that the watchdog can report what was running.
  StepResult begin_attempt(const StepEntry& entry, std::optional<std::string> instead_of);
  bool one_attempt(const StepEntry& entry, std::optional<std::string> instead_of);
  static void set_budget(Budget& budget, const StepEntry& entry);
  /// The time that the step may take, by the name that changes it.
  std::string time_budget(const StepEntry& entry) const;
  /// The mission's request with the step's budget, random stream and trace.
  Request request_for(const StepEntry& entry, std::uint64_t index);
  /// Sets the plugin now at work, for the watchdog and the crash report.
  void name_caller(std::string who);
  /// The same for work without a budget: under the watchdog, with the timeout of the options.
  void enter(std::string who, std::optional<double> memory_mb = std::nullopt);
  /// Arms the watchdog; the token is stopped at once if the user has interrupted.
  std::stop_token arm(double seconds, std::optional<double> memory_mb);
  /// Ends the work begun by enter or request_for; returns what the plugin changed in the process,
  /// "" if nothing.
  std::string leave();
  /// The same, but throws PluginError if the plugin changed anything.
  void expect_left_alone();
  /// "the planner 'astar' (steps.0)"
  std::string named(const StepEntry& entry) const;
  /// Runs a plugin's work under the watchdog, timed; records its exceptions in the step.
  void guarded(const StepEntry& entry, StepResult& step,
               const std::function<PlanResult(const Request&)>& work);
  static void take_answer(StepResult& step, PlanResult answer);

  /// A planner, or a local planner to roll out, kept for the sessions that use it.
  struct PlanPlugin {
    std::unique_ptr<Planner> planner;
    std::unique_ptr<LocalPlanner> local_planner;
    bool is_anytime() const { return planner && planner->traits().anytime; }
    PlanPart part() const {
      return [this](const Request& request) {
        return plan_in_winds(request, is_anytime(), [this](const Request& in_one_wind) {
          return planner ? planner->plan(in_one_wind) : roll_out(*local_planner, in_one_wind);
        });
      };
    }
  };
  const PlanPlugin& make_plan(const StepEntry& entry);
  /// A session from the request's start: the planner's own if it supports sessions.
  std::unique_ptr<Session> begin_session(const PlanPlugin& made, const Request& request);
  /// Orders the scenario's task once; from then on the mission has its start, goal and via points.
  /// Returns why there is no order, or nothing.
  std::optional<PlanResult> order_task(const Request& request);
  /// Plans sections: with a task those between its passes.
  PlanPart part_of(const PlanPlugin& made) const;
  /// True if a flight continues the session of that plan step.
  bool flown_with(const std::string& id) const;
  void plan(const StepEntry& entry, StepResult& step);
  /// The first plan of a run that finds no route names the constraints that refuse a leg of no
  /// length at the start or the goal: the reason is often theirs.
  PlanResult explained(PlanResult result, const Request& request);
  void smooth(const StepEntry& entry, StepResult& step);
  /// Smooths the sections between via points, which stay.
  PlanResult between_via(const Smoother& smoother, const Route& before, const Request& request);
  /// Index of the step whose route is the input of `entry`.
  std::size_t input_of(const StepEntry& entry) const;
  /// Judges and measures; layers and constraints that throw fail the step.
  void judge_step(StepResult& step, const Request& request);
  static void take_verdict(StepResult& step);
  /// Judges the returns of the accepted route.
  void returns_step(const StepEntry& entry);

  template <class Interface>
  std::unique_ptr<Interface> make(const StepEntry& entry,
                                  std::unique_ptr<Interface> (*PluginEntry::*maker)(const Value*)) {
    const char* kind = detail::kKind<Interface>;
    const std::string who =
        std::string("the ") + kind + " '" + entry.plugin + "' (" + entry.path + ")";
    enter(who + ": its constructor", entry.within_mb);
    try {
      auto made = (plugin(*config_.registry, kind, entry.plugin).*maker)(&entry.with);
      if (made == nullptr) {
        throw PluginError("made no object");
      }
      expect_left_alone();
      return made;
    } catch (const ConfigError&) {
      throw;
    } catch (const PluginError& error) {
      throw PluginError(who + " " + error.what(), error.reason());
    } catch (const ParameterError& error) {
      throw at_its_key(entry, error);
    } catch (const Error& error) {
      throw ConfigError(entry.with.where, entry.path + ".with", error.what());
    }
  }
  static ConfigError at_its_key(const StepEntry& entry, const ParameterError& error);
  /// Flies the route; the alternatives are flown if it fails before the goal.
  void fly_step(const StepEntry& step);
  void fly_once(const StepEntry& entry, std::optional<std::string> instead_of);
  /// Plugins of a flight, kept while it lasts.
  struct FlightPlugins {
    std::unique_ptr<LocalPlanner> pilot;
    std::vector<std::unique_ptr<Smoother>> smoothers;
  };
  FlightSetup flight_setup(const StepEntry& entry, FlightPlugins& plugins);
  /// The plan step that continues in flight, or the one written out under `replan`.
  std::optional<StepEntry> replan_entry(const StepEntry& entry) const;
  /// Sets the session: a plan step's, or one begun now.
  void find_replanner(const StepEntry& entry, const StepEntry& planner, const PlanPlugin* made,
                      FlightSetup& setup);
  static std::string session_key(const StepEntry& entry, const StepEntry& planner);
  /// The plan step, or alternative, of that id; the configuration check ensures that it exists.
  const StepEntry& plan_entry(const std::string& id) const;
  void conclude();
  /// Called on the watchdog's thread: the running step never stopped.
  void give_up(const std::string& why);

  const Config& config_;
  const RunOptions& options_;
  RunProgress own_progress_;
  RunProgress& progress_;  ///< the caller's, or its own
  Mission mission_;
  Mission unordered_;                 ///< before its task is ordered
  std::optional<TaskSections> task_;  ///< once it is ordered
  bool ends_explained_ = false;
  std::mutex mutex_;  ///< guards result_ and caller_ against the watchdog
  std::string caller_;
  RunResult result_;
  std::map<std::string, std::size_t> left_by_;  ///< index of the step whose route an id refers to
  std::vector<FlightEvent> events_;
  std::unique_ptr<TraceFile> trace_;
  std::vector<std::unique_ptr<PlanPlugin>> plan_plugins_;
  std::map<std::string, std::unique_ptr<Session>> sessions_;  ///< by step
  Watchdog watchdog_;
  std::stop_callback<std::function<void()>> interrupt_;  // last: calls the watchdog
};
}  // namespace altiplan::host
