// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>

namespace altiplan::cli {

/// From now on SIGINT, SIGTERM and SIGHUP end the process with exit code 130, whatever it does, and
/// what is unfinished is undone: no half file, no temporary one. To be called once, at the start.
void catch_interrupts();

/// While it lives, a signal asks for a stop in place of ending the process: the step under way
/// ends, the result is written. A second signal ends the process; not within half a second, as
/// timeout(1) sends two. One at a time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// From now on a signal ends the process again. Where one has come, what is still done (printing
  /// to a pipe that nobody reads) has half a second.
  void finish();

  std::stop_token token() const;
  bool happened() const { return token().stop_requested(); }

 private:
  std::stop_source stop_;
};
}  // namespace altiplan::cli
