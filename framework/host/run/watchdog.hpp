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

/// Ends a step that outstays its welcome. While armed, it fires the stop token when the time is
/// over (or the process has grown by more memory than allowed), and two seconds later, when the
/// step has still not returned, it calls `crash_report`, which does not return. A user who interrupts
/// waits for half a second.
class Watchdog {
 public:
  /// `crash_report` gets the sentence that says why; `held_mb` tells of memory that does not count as
  /// resident.
  explicit Watchdog(std::function<void(const std::string&)> crash_report,
                    std::function<double()> held_mb = {});
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Watches until disarm. The token stops the step when time or memory is used up.
  std::stop_token arm(double seconds, std::optional<double> memory_mb);
  void disarm();
  /// Stops the step as if its time were over: it was interrupted. What is armed again after that
  /// has what is left of the half second.
  void stop_now();
  /// Whether the last step was stopped for its memory.
  bool out_of_memory() const { return out_of_memory_; }

 private:
  void watch(const std::stop_token& done);
  double memory_mb() const;
  using Clock = std::chrono::steady_clock;
  /// When the step is stopped, or given up where it has been.
  Clock::time_point due() const;

  std::function<void(const std::string&)> crash_report_;
  std::function<double()> held_mb_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  bool armed_ = false;
  std::uint64_t step_ = 0;  ///< counts arm
  Clock::time_point stop_at_;
  std::optional<double> memory_mb_;
  double memory_at_start_mb_ = 0;
  bool stopped_ = false;
  Clock::time_point stopped_at_;
  bool out_of_memory_ = false;
  bool interrupted_ = false;
  std::optional<Clock::time_point> interrupted_at_;  ///< for the first time
  std::stop_source stop_;
  std::jthread thread_;  // last: starts when all else is there
};

/// How long a step without a time budget may take.
inline constexpr double kDefaultStepSeconds = 60;
/// What a step has after its budget before the process is ended.
inline constexpr double kGraceSeconds = 2;
/// The same after an interruption: all ends within a second.
inline constexpr double kInterruptedSeconds = 0.5;
}  // namespace altiplan::host
