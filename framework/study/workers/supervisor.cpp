// SPDX-License-Identifier: Apache-2.0
#include "study/workers/supervisor.hpp"

#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "altiplan/error.hpp"

namespace altiplan::study {
namespace {

/// Waits for the parent's farewell or its end.
[[noreturn]] void keep_watch(const WorkFolder& folder, int leash) {
  ::setsid();
  sigset_t all;
  sigfillset(&all);
  ::sigprocmask(SIG_BLOCK, &all, nullptr);
  const int low = std::min(leash, folder.lock());
  const int high = std::max(leash, folder.lock());
  if (low > 0) {
    ::close_range(0, unsigned(low) - 1, 0);
  }
  if (low + 1 < high) {
    ::close_range(unsigned(low) + 1, unsigned(high) - 1, 0);
  }
  ::close_range(unsigned(high) + 1, ~0U, 0);
  char farewell = 0;
  ssize_t got = 0;
  while ((got = ::read(leash, &farewell, 1)) < 0 && errno == EINTR) {
  }
  if (got <= 0) {
    folder.processes().kill();
  }
  ::_exit(0);
}
}  // namespace

Supervisor::Supervisor(const WorkFolder& folder) : folder_(folder) { start(); }

void Supervisor::start() {
  int ends[2];
  leash_ = -1;
  process_ = -1;
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    throw Error(std::string("no socket to the supervisor of the workers: ") + std::strerror(errno));
  }
  process_ = ::fork();
  if (process_ == 0) {
    keep_watch(folder_, ends[0]);
  }
  const int error = errno;
  ::close(ends[0]);
  if (process_ < 0) {
    ::close(ends[1]);
    throw Error(std::string("no process for the supervisor of the workers: ") + std::strerror(error));
  }
  leash_ = ends[1];
}

void Supervisor::replace() {
  ::close(leash_);
  start();
}

Supervisor::~Supervisor() {
  if (process_ < 0) {
    return;  // the machine had none to replace the one that has ended
  }
  const char farewell = '.';
  if (::send(leash_, &farewell, 1, MSG_NOSIGNAL) == 1) {  // else it is gone already
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  } else {
    ::waitpid(process_, nullptr, WNOHANG);
  }
  ::close(leash_);
}
}  // namespace altiplan::study
