// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>

namespace altiplan::bench {

inline double clock_ms(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return 1e3 * double(now.tv_sec) + 1e-6 * double(now.tv_nsec);
}

/// A plan's time by two clocks.
struct Time {
  double wall_ms = 0;
  double processor_ms = 0;  ///< of all threads: what other programs do to it is not counted

  static Time now() { return {clock_ms(CLOCK_MONOTONIC), clock_ms(CLOCK_PROCESS_CPUTIME_ID)}; }
  Time since(const Time& before) const {
    return {wall_ms - before.wall_ms, processor_ms - before.processor_ms};
  }
};
}  // namespace altiplan::bench
