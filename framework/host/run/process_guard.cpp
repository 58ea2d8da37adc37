// SPDX-License-Identifier: Apache-2.0
#include "host/run/process_guard.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cfenv>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <locale>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "altiplan/error.hpp"
#include "host/base/output_file.hpp"

namespace altiplan::host {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kCatchSignals = false;  // a sanitizer has more to say about a crash
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kCatchSignals = false;
#else
constexpr bool kCatchSignals = true;
#endif
#else
constexpr bool kCatchSignals = true;
#endif

struct Fatal {
  int number;
  const char* cause;
};
constexpr std::array kFatal = {Fatal{SIGSEGV, "crashed (SIGSEGV)"},
                               Fatal{SIGBUS, "crashed (SIGBUS)"}, Fatal{SIGILL, "crashed (SIGILL)"},
                               Fatal{SIGFPE, "crashed (SIGFPE)"},
                               Fatal{SIGABRT, "aborted (SIGABRT)"}};
constexpr std::array kWatched = {SIGSEGV, SIGBUS,  SIGILL, SIGFPE,  SIGABRT, SIGINT,  SIGTERM,
                                 SIGPIPE, SIGCHLD, SIGHUP, SIGUSR1, SIGUSR2, SIGQUIT, SIGALRM};

/// All that a handler may need; there is one, as there is one process.
struct State {
  int out = -1;      ///< the true stdout
  int capture = -1;  ///< what is written to stdout meanwhile
  int folder = -1;
  ino_t capture_inode = 0;
  pid_t owner = ::getpid();  ///< a child that a plugin forks says nothing
  std::string locale;
  std::locale cxx_locale;
  std::fenv_t floating{};
  std::array<struct sigaction, kWatched.size()> actions{};
  std::atomic<const ProcessGuard::CrashReport*> words = nullptr;
  std::unique_ptr<const ProcessGuard::CrashReport> kept;
  std::unique_ptr<const ProcessGuard::CrashReport> before;  ///< a handler may still read it
  std::string file_beside;
  std::string kept_beside;  ///< a file that is still written
  std::string kept_place;
};
State* the_state = nullptr;

// What follows, up to the ProcessGuard, runs in signal handlers: system calls alone.

bool write_all(int to, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(to, text.data(), text.size());
    if (written <= 0 && errno != EINTR) {
      return false;
    }
    text.remove_prefix(written > 0 ? std::size_t(written) : 0);
  }
  return true;
}

bool write_with_cause(int to, std::string_view text, std::string_view cause) {
  // In JSON text the mark stands as an escape.
  constexpr std::string_view kEscaped = "\\u0001";
  while (!text.empty()) {
    const std::size_t escaped = text.find(kEscaped);
    const std::size_t plain = text.find(ProcessGuard::CrashReport::kCause);
    const std::size_t at = std::min(escaped, plain);
    if (!write_all(to, text.substr(0, at))) {
      return false;
    }
    if (at == text.npos) {
      return true;
    }
    if (!write_all(to, cause)) {
      return false;
    }
    text.remove_prefix(at + (at == escaped ? kEscaped.size() : 1));
  }
  return true;
}

bool drain(State& state) {
  char buffer[4096];
  bool any = false;
  ssize_t got = 0;
  ::lseek(state.capture, 0, SEEK_SET);
  while ((got = ::read(state.capture, buffer, sizeof buffer)) > 0) {
    write_all(STDERR_FILENO, {buffer, std::size_t(got)});
    any = true;
  }
  if (any && ::ftruncate(state.capture, 0) != 0) {
    return any;
  }
  return any;
}

/// As OutputFile writes, which a handler cannot call.
void write_file_with_cause(const ProcessGuard::CrashReport& words, std::string_view cause) {
  const char* beside = the_state->file_beside.c_str();
  const int file = ::open(beside, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (file < 0) {
    write_all(STDERR_FILENO, "altiplan: the result cannot be written\n");
    return;
  }
  const bool whole = write_with_cause(file, words.result, cause) && ::fsync(file) == 0;
  if (::close(file) != 0 || !whole || ::rename(beside, words.file.c_str()) != 0) {
    ::unlink(beside);
    write_all(STDERR_FILENO, "altiplan: the result cannot be written\n");
  }
}

[[noreturn]] void write_crash_report(const ProcessGuard::CrashReport& words, std::string_view cause) {
  State& state = *the_state;
  drain(state);
  write_with_cause(STDERR_FILENO, words.for_user, cause);
  if (words.on_stdout) {
    write_with_cause(state.out, words.result, cause);
  }
  if (!state.kept_beside.empty()) {
    ::rename(state.kept_beside.c_str(), state.kept_place.c_str());
  }
  if (!words.file.empty()) {
    write_file_with_cause(words, cause);
  }
  ::_exit(words.exit_code);
}

/// A copy of the process dies of the signal and leaves the core file, where one is wanted.
void leave_core(int number) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_CORE, &limit) != 0 || limit.rlim_cur == 0) {
    return;
  }
  const pid_t child = ::_Fork();
  if (child == 0) {
    ::signal(number, SIG_DFL);
    sigset_t only;
    sigemptyset(&only);
    sigaddset(&only, number);
    ::pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
    ::raise(number);
    ::_exit(0);
  }
  if (child > 0) {
    int status = 0;
    ::waitpid(child, &status, 0);
  }
}

void on_fatal(int number) {
  const ProcessGuard::CrashReport* words = the_state != nullptr && the_state->owner == ::getpid()
                                             ? the_state->words.exchange(nullptr)
                                             : nullptr;
  if (words == nullptr) {  // no run, or the crash report themselves crash
    ::signal(number, SIG_DFL);
    ::raise(number);  // comes when the handler returns
    return;
  }
  leave_core(number);
  for (const Fatal& fatal : kFatal) {
    if (fatal.number == number) {
      write_crash_report(*words, fatal.cause);
    }
  }
}

void on_exit() {
  if (the_state == nullptr || the_state->owner != ::getpid()) {
    return;
  }
  if (const ProcessGuard::CrashReport* words = the_state->words.exchange(nullptr)) {
    std::fflush(stdout);
    write_crash_report(*words, "ended the process by exit()");
  }
}

void catch_signals() {
  constexpr std::size_t kStackBytes = 64 * 1024;
  static std::array<char, kStackBytes> stack;
  stack_t alternate{};
  alternate.ss_sp = stack.data();
  alternate.ss_size = stack.size();
  ::sigaltstack(&alternate, nullptr);  // the stack may be what overflowed
  struct sigaction action {};
  action.sa_handler = on_fatal;
  action.sa_flags = SA_ONSTACK;
  sigemptyset(&action.sa_mask);
  for (const Fatal& fatal : kFatal) {
    ::sigaction(fatal.number, &action, nullptr);
  }
}

void stop_catching() {
  for (const Fatal& fatal : kFatal) {
    ::signal(fatal.number, SIG_DFL);
  }
}

/// How numbers are rounded, what traps, what is flushed to zero; not what happened since.
auto mode_of(const std::fenv_t& floating) {
#if defined(__x86_64__)
  return std::pair(floating.__mxcsr & 0xFFC0U, floating.__control_word);
#else
  return floating.__fpcr;
#endif
}

void add(std::string& all, const char* what) {
  all += (all.empty() ? "" : ", ") + std::string(what);
}
}  // namespace

ProcessGuard::ProcessGuard() {
  auto state = std::make_unique<State>();
  std::fflush(stdout);
  state->out = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);  // none where the caller has closed it
  if (state->out < 0 && errno != EBADF) {
    throw std::system_error(errno, std::generic_category(), "cannot set stdout apart");
  }
  state->capture = ::memfd_create("altiplan stdout", MFD_CLOEXEC);
  state->folder = ::open(".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  struct stat captured {};
  if (state->capture < 0 || ::fcntl(state->capture, F_SETFL, O_APPEND) != 0 ||
      ::fstat(state->capture, &captured) != 0 || ::dup2(state->capture, STDOUT_FILENO) < 0) {
    throw std::system_error(errno, std::generic_category(), "cannot set stdout apart");
  }
  state->capture_inode = captured.st_ino;
  state->locale = std::setlocale(LC_ALL, nullptr);
  state->cxx_locale = std::locale();
  std::fegetenv(&state->floating);
  static const int kRegistered = std::atexit(on_exit);
  if (kRegistered != 0) {
    throw Error("cannot register what to do at exit");
  }
  the_state = state.release();
  if (kCatchSignals) {
    catch_signals();
  }
  for (std::size_t i = 0; i < kWatched.size(); ++i) {
    ::sigaction(kWatched[i], nullptr, &the_state->actions[i]);
  }
}

ProcessGuard::~ProcessGuard() {
  the_state->words = nullptr;
  restore();
  pass_on_output();
  const std::unique_ptr<State> state(std::exchange(the_state, nullptr));
  if (kCatchSignals) {
    stop_catching();
  }
  if (state->out >= 0) {
    ::dup2(state->out, STDOUT_FILENO);
    ::close(state->out);
  } else {
    ::close(STDOUT_FILENO);
  }
  ::close(state->capture);
  ::close(state->folder);
}

std::string ProcessGuard::restore() {
  State& state = *the_state;
  std::string changed;
  if (const char* now = std::setlocale(LC_ALL, nullptr);
      now == nullptr || state.locale != now || std::locale() != state.cxx_locale) {
    std::locale::global(state.cxx_locale);
    std::setlocale(LC_ALL, state.locale.c_str());
    add(changed, "the locale");
  }
  struct stat here {};
  struct stat there {};
  if (state.folder >= 0 && ::fstat(state.folder, &there) == 0 &&
      ::stat(".", &here) == 0 &&  // else the system fails, not the plugin
      (here.st_ino != there.st_ino || here.st_dev != there.st_dev)) {
    if (::fchdir(state.folder) == 0) {
      add(changed, "the working folder");
    }
  }
  std::fenv_t floating{};
  std::fegetenv(&floating);
  if (std::fegetround() != FE_TONEAREST || mode_of(floating) != mode_of(state.floating)) {
    std::fesetenv(&state.floating);
    add(changed, "the floating-point mode");
  }
  bool signals = false;
  for (std::size_t i = 0; i < kWatched.size(); ++i) {
    struct sigaction now {};
    ::sigaction(kWatched[i], nullptr, &now);
    if (now.sa_handler != state.actions[i].sa_handler) {
      ::sigaction(kWatched[i], &state.actions[i], nullptr);
      signals = true;
    }
  }
  if (signals) {
    add(changed, "a signal handler");
  }
  struct stat out {};
  const bool is_closed = ::fstat(STDOUT_FILENO, &out) != 0 && errno == EBADF;
  if (is_closed || (out.st_ino != 0 && out.st_ino != state.capture_inode)) {
    ::dup2(state.capture, STDOUT_FILENO);
    add(changed, "stdout");
  }
  return changed;
}

int ProcessGuard::true_stdout() const { return the_state->out; }

double ProcessGuard::kept_mb() const {
  struct stat captured {};
  return ::fstat(the_state->capture, &captured) == 0 ? double(captured.st_size) / double(1 << 20)
                                                     : 0;
}

bool ProcessGuard::pass_on_output() {
  std::fflush(stdout);
  struct stat captured {};
  return ::fstat(the_state->capture, &captured) == 0 && captured.st_size > 0 && drain(*the_state);
}

void ProcessGuard::set_crash_report(CrashReport words) {
  State& state = *the_state;
  state.words = nullptr;
  state.file_beside = words.file.empty() ? "" : name_beside(words.file).string();
  state.before = std::exchange(state.kept, std::make_unique<const CrashReport>(std::move(words)));
  state.words = state.kept.get();
}

void ProcessGuard::keep_as_it_is(std::string beside, std::string place) {
  the_state->kept_beside = std::move(beside);
  the_state->kept_place = std::move(place);
}
}  // namespace altiplan::host
