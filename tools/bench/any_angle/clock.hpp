// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>

namespace altiplan::bench {

/// Processor time of this thread: what other programs do to it is not counted.
inline double thread_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * double(now.tv_sec) + 1e-6 * double(now.tv_nsec);
}
}  // namespace altiplan::bench
