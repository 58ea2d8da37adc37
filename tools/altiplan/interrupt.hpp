// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <csignal>
#include <stop_token>
#include <thread>

namespace altiplan::cli {

/// Turns SIGINT and SIGTERM into a stop token: the step under way ends, the result is written.
/// A second signal ends the process at once; not within half a second, as timeout(1) sends two.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return stop_.get_token(); }
  bool happened() const { return happened_; }

 private:
  sigset_t signals_;
  std::stop_source stop_;
  std::atomic<bool> happened_ = false;
  std::thread thread_;
};
}  // namespace altiplan::cli
