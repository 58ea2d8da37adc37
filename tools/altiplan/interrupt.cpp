// SPDX-License-Identifier: Apache-2.0
#include "interrupt.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "guarded.hpp"
#include "host/base/unfinished.hpp"

namespace altiplan::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};
constexpr auto kPatience = std::chrono::milliseconds(500);

/// A signal handler must not clean up: it wakes a thread that does.
struct State {
  int event = -1;
  pid_t owner = 0;
  std::mutex mutex;
  std::stop_source* cooperative = nullptr;   ///< stop source of the current Interrupt
  std::optional<Clock::time_point> first;    ///< time of the first stop request
  std::optional<Clock::time_point> ends_at;  ///< deadline after finish()
};
State* the_state = nullptr;  // lives as long as the process

void on_signal(int number) {
  const int error = errno;
  if (::getpid() != the_state->owner) {  // a forked child before its exec
    ::signal(number, SIG_DFL);
    ::raise(number);
    errno = error;
    return;
  }
  const std::uint64_t one = 1;
  if (::write(the_state->event, &one, sizeof one) != ssize_t(sizeof one)) {
    ::_exit(kInterrupted);
  }
  errno = error;
}

[[noreturn]] void end_process() {
  host::undo_unfinished();
  constexpr std::string_view kWords = "altiplan: interrupted\n";
  // Do not wait for a stalled reader of stderr.
  pollfd ready{STDERR_FILENO, POLLOUT, 0};
  if (::poll(&ready, 1, 0) > 0 && (ready.revents & POLLOUT) != 0) {
    const ssize_t written = ::write(STDERR_FILENO, kWords.data(), kWords.size());
    static_cast<void>(written);
  }
  ::_exit(kInterrupted);
}

/// Requests a stop if an Interrupt is alive, otherwise ends the process.
void take_signal() {
  std::unique_lock lock(the_state->mutex);
  if (the_state->cooperative == nullptr) {
    end_process();
  }
  if (the_state->first) {
    if (Clock::now() - *the_state->first > kPatience) {
      end_process();
    }
    return;
  }
  the_state->first = Clock::now();
  std::stop_source stop = *the_state->cooperative;
  lock.unlock();
  stop.request_stop();
}

[[noreturn]] void watch() {
  while (true) {
    bool has_begun = false;
    {
      const std::lock_guard lock(the_state->mutex);
      has_begun = the_state->first.has_value();
      if (the_state->ends_at && Clock::now() >= *the_state->ends_at) {
        end_process();
      }
    }
    constexpr int kLookEveryMs = 50;
    pollfd ready{the_state->event, POLLIN, 0};
    std::uint64_t count = 0;
    if (::poll(&ready, 1, has_begun ? kLookEveryMs : -1) > 0 &&
        ::read(the_state->event, &count, sizeof count) == ssize_t(sizeof count)) {
      take_signal();
    }
  }
}
}  // namespace

void catch_interrupts() {
  the_state = new State;
  the_state->event = ::eventfd(0, EFD_CLOEXEC);
  the_state->owner = ::getpid();
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);  // the thread handles none
  bool is_watched = the_state->event >= 0;
  try {
    if (is_watched) {
      std::thread(watch).detach();
    }
  } catch (const std::system_error&) {
    is_watched = false;
  }
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (!is_watched) {
    return;  // signals keep their default action
  }
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int number : kSignals) {
    struct sigaction now {};
    ::sigaction(number, nullptr, &now);
    if (number != SIGHUP || now.sa_handler != SIG_IGN) {  // nohup(1)
      ::sigaction(number, &action, nullptr);
    }
  }
}

Interrupt::Interrupt() {
  const std::lock_guard lock(the_state->mutex);
  the_state->cooperative = &stop_;
}

Interrupt::~Interrupt() { finish(); }

void Interrupt::finish() {
  const std::lock_guard lock(the_state->mutex);
  if (std::exchange(the_state->cooperative, nullptr) != nullptr && the_state->first) {
    the_state->ends_at = Clock::now() + kPatience;
  }
}

std::stop_token Interrupt::token() const { return stop_.get_token(); }
}  // namespace altiplan::cli
