// SPDX-License-Identifier: Apache-2.0
#include "interrupt.hpp"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>

#include "guarded.hpp"

namespace altiplan::cli {

Interrupt::Interrupt() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  sigaddset(&signals_, SIGUSR1);  // ends the thread
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  thread_ = std::thread([this] {
    using Clock = std::chrono::steady_clock;
    Clock::time_point first;
    int signal = 0;
    while (sigwait(&signals_, &signal) == 0 && signal != SIGUSR1) {
      if (!happened_.exchange(true)) {
        first = Clock::now();
        stop_.request_stop();
      } else if (Clock::now() - first > std::chrono::milliseconds(500)) {
        _exit(kInterrupted);
      }
    }
  });
}

Interrupt::~Interrupt() {
  pthread_kill(thread_.native_handle(), SIGUSR1);
  thread_.join();
}
}  // namespace altiplan::cli
