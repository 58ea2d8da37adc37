// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "host/config/config.hpp"
#include "host/flight/flown_vehicle.hpp"
#include "host/mission/mission.hpp"
#include "host/run/process_guard.hpp"
#include "host/run/run_result.hpp"
#include "host/run/watchdog.hpp"

namespace altiplan::host {

/// A flight with a vehicle of its own time, along a route that is given.
struct RealFlight {
  Route route;
  FlownVehicle& vehicle;
};

inline constexpr std::uintmax_t kDefaultTraceMb = 64;

/// How far the running step is, for another thread.
struct RunProgress {
  SearchProgress search;
  std::atomic<double> flown_s{0};  ///< of a flight, in its time

  void begin_step();
};

/// Of the returns of a route, as `check --returns` judges them.
struct ReturnsVerdict {
  bool passes = false;
  std::string message;
  std::string json;  ///< "": no mission is made of the route, which has no returns
};

struct RunOptions {
  int threads = 1;
  std::optional<std::filesystem::path> out;  ///< the file that the result is written to
  std::optional<std::filesystem::path> trace;
  std::uintmax_t trace_limit_mb = kDefaultTraceMb;
  /// Called from the watchdog's thread with the result so far if a step never stops; must not
  /// return.
  std::function<void(const RunResult&)> on_stuck;
  std::stop_token stop;  ///< requested by an interruption
  /// Called before each call of a plugin with the result to report if that call ends the process,
  /// with CrashReport::kCause in its message.
  std::function<void(const RunResult&)> on_call;
  ProcessGuard* process = nullptr;  ///< guards the process state; unguarded if null
  /// Timeout of steps without `within_s` and of work without a budget: constructors, judging.
  double timeout_s = kDefaultStepSeconds;
  RunProgress* progress = nullptr;  ///< null where nobody watches
  /// Called with the mission once it is built, for who shows its world afterwards.
  std::function<void(const Mission&)> on_mission;
  /// Judges, for a step `returns`, the route that the result so far accepts, in the mission before
  /// a task's passes are ordered (host/gate/route_returns.hpp).
  std::function<ReturnsVerdict(const Config&, const Mission&, const RunResult&, const StepEntry&)>
      judge_returns;
  /// If set, no step is done but the first attempt of the flight, without a time budget.
  std::optional<RealFlight> real;
};

/// Runs a pipeline: every step with its alternatives, the judge after each, and the flight.
RunResult run(const Config& config, const RunOptions& options);
}  // namespace altiplan::host
