// SPDX-License-Identifier: Apache-2.0
#include "host/run/watchdog.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace altiplan::host {
namespace {

/// Resident memory of this process, MiB.
double resident_mb() {
  long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    long all = 0;
    if (std::fscanf(file, "%ld %ld", &all, &pages) != 2) {
      pages = 0;
    }
    std::fclose(file);
  }
  return double(pages) * double(sysconf(_SC_PAGESIZE)) / double(1 << 20);
}
}  // namespace

Watchdog::Watchdog(std::function<void(const std::string&)> crash_report,
                   std::function<double()> held_mb)
    : crash_report_(std::move(crash_report)),
      held_mb_(std::move(held_mb)),
      thread_([this](const std::stop_token& done) { watch(done); }) {}

Watchdog::~Watchdog() {
  thread_.request_stop();
  changed_.notify_all();
}

double Watchdog::memory_mb() const { return resident_mb() + (held_mb_ ? held_mb_() : 0); }

std::stop_token Watchdog::arm(double seconds, std::optional<double> memory_mb) {
  const std::lock_guard lock(mutex_);
  stop_ = std::stop_source();
  stop_at_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                std::chrono::duration<double>(std::min(seconds, 1e8)));
  memory_mb_ = memory_mb;
  memory_at_start_mb_ = memory_mb ? this->memory_mb() : 0;
  stopped_ = false;
  out_of_memory_ = false;
  interrupted_ = false;
  armed_ = true;
  ++step_;
  changed_.notify_all();
  return stop_.get_token();
}

void Watchdog::disarm() {
  const std::lock_guard lock(mutex_);
  armed_ = false;
  changed_.notify_all();
}

void Watchdog::stop_now() {
  const std::lock_guard lock(mutex_);
  interrupted_ = true;
  stop_at_ = Clock::now();
  interrupted_at_ = interrupted_at_.value_or(stop_at_);
  changed_.notify_all();
}

Watchdog::Clock::time_point Watchdog::due() const {
  const auto after = [](Clock::time_point from, double seconds) {
    return from +
           std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  };
  return !stopped_      ? stop_at_
         : interrupted_ ? after(*interrupted_at_, kInterruptedSeconds)
                        : after(stopped_at_, kGraceSeconds);
}

void Watchdog::watch(const std::stop_token& done) {
  constexpr auto kMemoryPoll = std::chrono::milliseconds(20);
  std::unique_lock lock(mutex_);
  while (!done.stop_requested()) {
    if (!armed_) {
      changed_.wait(lock, done, [this] { return armed_; });
      continue;
    }
    Clock::time_point wake = due();
    if (memory_mb_) {
      wake = std::min(wake, Clock::now() + kMemoryPoll);
    }
    const std::uint64_t step = step_;
    changed_.wait_until(lock, done, wake, [&] { return !armed_ || step_ != step || due() < wake; });
    if (!armed_ || step_ != step || done.stop_requested()) {
      continue;
    }
    const auto now = Clock::now();
    const double grown = memory_mb_ ? memory_mb() - memory_at_start_mb_ : 0;
    if (memory_mb_ && grown > *memory_mb_) {
      if (!out_of_memory_) {
        out_of_memory_ = true;
        stopped_ = true;
        stopped_at_ = now;
        stop_.request_stop();
      } else if (grown > 2 * *memory_mb_ + 64) {  // it does not stop: before the machine suffers
        crash_report_("used more memory than its within_mb and did not stop when told to");
      }
    }
    if (!stopped_ && now >= stop_at_) {
      stopped_ = true;
      stopped_at_ = now;
      stop_.request_stop();
    } else if (stopped_ && now >= due()) {
      crash_report_(out_of_memory_
                      ? "used more memory than its within_mb and did not stop when told to"
                  : interrupted_ ? "did not stop within half a second of the interruption"
                                 : "did not stop within two seconds of the end of its time");
    }
  }
}
}  // namespace altiplan::host
