// SPDX-License-Identifier: Apache-2.0
#include "link/guardian.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <exception>

#include "host/base/machine_fault.hpp"

namespace altiplan::link {
namespace {

constexpr char kCommanding = 'c';
constexpr char kStandDown = 's';

/// It outlives an interruption of the terminal's whole group, and keeps no reader of the output
/// waiting.
void detach() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    ::signal(number, SIG_IGN);
  }
  if (const int null = ::open("/dev/null", O_RDWR | O_CLOEXEC); null >= 0) {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
      ::dup2(null, stream);
    }
  }
}

[[noreturn]] void watch(int pipe, const std::function<void()>& hold, Time max_silence) {
  bool is_commanding = false;
  std::array<char, 256> words;
  while (true) {
    pollfd ready{pipe, POLLIN, 0};
    const int timeout = is_commanding ? static_cast<int>(max_silence.count()) : -1;
    const int events = ::poll(&ready, 1, timeout);
    const ssize_t size = events > 0 ? ::read(pipe, words.data(), words.size()) : -1;
    if (size > 0) {
      is_commanding = words[static_cast<std::size_t>(size) - 1] == kCommanding;
    } else if ((events == 0 || size == 0) && is_commanding) {
      hold();
      is_commanding = false;
    }
    if (size == 0) {
      ::_exit(0);
    }
  }
}

[[noreturn]] void fail(const char* what) {
  throw host::MachineFault(std::string("no ") + what +
                           " to guard the vehicle: " + std::strerror(errno));
}
}  // namespace

Guardian::Guardian(const std::function<void()>& hold, Time max_silence) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    fail("pipe");
  }
  process_ = ::fork();
  if (process_ == 0) {
    ::close(ends[1]);
    detach();
    try {
      watch(ends[0], hold, max_silence);
    } catch (const std::exception&) {  // the link is gone too
    }
    ::_exit(1);
  }
  ::close(ends[0]);
  pipe_ = ends[1];
  if (process_ < 0) {
    ::close(pipe_);
    fail("process");
  }
}

Guardian::~Guardian() {
  ::close(pipe_);
  while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void Guardian::commanding() {
  const ssize_t written = ::write(pipe_, &kCommanding, 1);
  static_cast<void>(written);
}

void Guardian::stand_down() {
  const ssize_t written = ::write(pipe_, &kStandDown, 1);
  static_cast<void>(written);
}
}  // namespace altiplan::link
