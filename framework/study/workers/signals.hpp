// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>

namespace altiplan::study {

/// During its lifetime signals are read from a descriptor instead of interrupting.
class Signals {
 public:
  Signals() {
    sigset_t caught;
    sigemptyset(&caught);
    for (const int signal : {SIGCHLD, SIGINT, SIGTERM, SIGHUP}) {
      sigaddset(&caught, signal);
    }
    ::sigprocmask(SIG_BLOCK, &caught, &before_);
    struct sigaction standard {};
    standard.sa_handler = SIG_DFL;  // if ignored, children could not be reaped
    ::sigaction(SIGCHLD, &standard, &child_before_);
    file_ = ::signalfd(-1, &caught, SFD_CLOEXEC | SFD_NONBLOCK);
    ::prctl(PR_GET_CHILD_SUBREAPER, &reaper_before_);
    ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  }
  ~Signals() {
    ::close(file_);
    ::prctl(PR_SET_CHILD_SUBREAPER, reaper_before_);
    ::sigaction(SIGCHLD, &child_before_, nullptr);
    ::sigprocmask(SIG_SETMASK, &before_, nullptr);
  }
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  /// Waits for a child to end, or for the time; true if a signal requests the end of the pool.
  bool wait(double seconds) const {
    pollfd ready{file_, POLLIN, 0};
    ::poll(&ready, 1, std::max(0, int(seconds * 1000 + 0.999)));
    bool stop = false;
    signalfd_siginfo info{};
    while (::read(file_, &info, sizeof info) == sizeof info) {
      stop = stop || info.ssi_signo != SIGCHLD;
    }
    return stop;
  }

 private:
  sigset_t before_{};
  struct sigaction child_before_ {};
  int file_ = -1;
  int reaper_before_ = 0;
};
}  // namespace altiplan::study
