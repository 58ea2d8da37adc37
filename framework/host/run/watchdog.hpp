// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

namespace altiplan::host {

/// Stops a step that exceeds its budget. While armed, it fires the stop token when the time is over
/// (or the process has grown by more memory than allowed); if the step has not returned two seconds
/// later, it calls `crash_report`, which does not return. After an interruption by the user it
/// waits for half a second.
class Watchdog {
 public:
  /// `crash_report` receives the reason; `held_mb` returns memory that does not count as resident.
  explicit Watchdog(std::function<void(const std::string&)> crash_report,
                    std::function<double()> held_mb = {});
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Watches until disarm. The token stops the step when time or memory is exhausted.
  std::stop_token arm(double seconds, std::optional<double> memory_mb);
  void disarm();
  /// Stops the step as if its time were over, for an interruption. Steps armed later get the rest
  /// of the half second.
  void stop_now();
  /// True if the last step was stopped for its memory use.
  bool out_of_memory() const { return out_of_memory_; }

 private:
  void watch(const std::stop_token& done);
  double memory_mb() const;
  using Clock = std::chrono::steady_clock;
  /// The time to stop the step or, if already stopped, to give it up.
  Clock::time_point due() const;

  std::function<void(const std::string&)> crash_report_;
  std::function<double()> held_mb_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  bool armed_ = false;
  std::uint64_t step_ = 0;  ///< number of arm calls
  Clock::time_point stop_at_;
  std::optional<double> memory_mb_;
  double memory_at_start_mb_ = 0;
  bool stopped_ = false;
  Clock::time_point stopped_at_;
  bool out_of_memory_ = false;
  bool interrupted_ = false;
  std::optional<Clock::time_point> interrupted_at_;  ///< the first time
  std::stop_source stop_;
  std::jthread thread_;  // last: starts when everything else is constructed
};

/// Timeout of a step without a time budget.
inline constexpr double kDefaultStepSeconds = 60;
/// Grace period after the budget before the process is ended.
inline constexpr double kGraceSeconds = 2;
/// The same after an interruption: everything ends within a second.
inline constexpr double kInterruptedSeconds = 0.5;
}  // namespace altiplan::host
