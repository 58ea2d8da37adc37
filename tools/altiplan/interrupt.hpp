// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>

namespace altiplan::cli {

/// From now on SIGINT, SIGTERM and SIGHUP end the process with exit code 130 and remove partial and
/// temporary files. Call once, at the start.
void catch_interrupts();

/// During its lifetime a signal requests a stop instead of ending the process: the current step
/// ends and the result is written. A second signal ends the process, unless it arrives within half
/// a second, since timeout(1) sends two. At most one instance at a time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// From now on a signal ends the process again. If one has arrived, the remaining work (such as
  /// printing to a pipe that nobody reads) has half a second.
  void finish();

  std::stop_token token() const;
  bool happened() const { return token().stop_requested(); }

 private:
  std::stop_source stop_;
};
}  // namespace altiplan::cli
