// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

#include "altiplan/error.hpp"
#include "host/base/machine_fault.hpp"
#include "host/base/run_status.hpp"
#include "study/report/scenes.hpp"

namespace altiplan::study::report {
namespace {

constexpr char kMade = 'm';
constexpr char kFailed = 'f';
constexpr char kNotGiven = 'n';  // by the machine
constexpr char kEnd = '.';
constexpr std::size_t kMaxBytes = 64'000'000;

/// Memory too, whoever has asked for it.
bool is_of_machine(const std::exception& error) {
  return dynamic_cast<const host::MachineFault*>(&error) != nullptr ||
         host::reason_of(error) == Reason::out_of_memory;
}

void write_all(int to, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(to, text.data(), text.size());
    if (written < 0 && errno != EINTR) {
      ::_exit(1);
    }
    text.remove_prefix(written > 0 ? std::size_t(written) : 0);
  }
}

[[noreturn]] void be_child(const std::function<std::string()>& make, int to) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // Whatever a plugin prints is not for the report's reader.
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    ::dup2(nothing, standard);
  }
  std::string text;
  try {
    text = kMade + make();
  } catch (const std::exception& error) {
    text = (is_of_machine(error) ? kNotGiven : kFailed) + std::string(error.what());
  } catch (...) {
    text = std::string(1, kFailed) + "something that is not a std::exception was thrown";
  }
  write_all(to, text + kEnd);
  ::_exit(0);
}

/// All that comes until the end or the time is over.
std::string read_within(int from, unsigned seconds, bool& late) {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + std::chrono::seconds(seconds);
  std::string text;
  char buffer[65536];
  while (text.size() < kMaxBytes) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd ready{from, POLLIN, 0};
    late = left <= 0;
    if (late || (::poll(&ready, 1, int(left)) < 0 && errno != EINTR)) {
      break;
    }
    if (ready.revents == 0) {
      continue;
    }
    const ssize_t got = ::read(from, buffer, sizeof buffer);
    if (got == 0 || (got < 0 && errno != EINTR)) {
      break;
    }
    text.append(buffer, got > 0 ? std::size_t(got) : 0);
  }
  return text;
}

std::string ending(int status) {
  if (WIFSIGNALED(status)) {
    return std::string("building it ends the process: ") + ::strsignal(WTERMSIG(status));
  }
  return "building it ends the process with exit code " + std::to_string(WEXITSTATUS(status));
}
}  // namespace

std::string made_in_child(const std::function<std::string()>& make, unsigned seconds) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    throw host::MachineFault(std::string("no pipe for a scene: ") + std::strerror(errno));
  }
  const pid_t child = ::fork();
  if (child < 0) {
    const int error = errno;
    ::close(ends[0]);
    ::close(ends[1]);
    throw host::MachineFault(std::string("no process for a scene: ") + std::strerror(error));
  }
  if (child == 0) {
    ::close(ends[0]);
    be_child(make, ends[1]);
  }
  ::setpgid(child, child);  // whoever comes first
  ::close(ends[1]);
  bool late = false;
  const std::string text = read_within(ends[0], seconds, late);
  ::close(ends[0]);
  // Before it is waited for: until then its group's number is nobody else's.
  const bool whole = text.size() >= 2 && text.back() == kEnd;
  if (!whole && late) {
    ::kill(-child, SIGKILL);
  }
  siginfo_t ended{};
  while (::waitid(P_PID, id_t(child), &ended, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
  }
  ::kill(-child, SIGKILL);  // what it may have left behind
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!whole) {
    if (late) {
      throw SceneLate("it was not built within " + std::to_string(seconds) + " s");
    }
    throw Error(ending(status));
  }
  const std::string content = text.substr(1, text.size() - 2);
  if (text.front() == kNotGiven) {
    throw host::MachineFault(content);
  }
  if (text.front() != kMade) {
    throw Error(content);
  }
  return content;
}
}  // namespace altiplan::study::report
