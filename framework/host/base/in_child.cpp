// SPDX-License-Identifier: Apache-2.0
#include "host/base/in_child.hpp"

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <memory>
#include <new>

#include "host/base/machine_fault.hpp"

namespace altiplan::host {
namespace {

constexpr unsigned kPatienceSeconds = 20;

enum class Said { nothing, well, refused, machine_fault };

/// The child's report, in shared memory: unlike a write to a pipe it cannot get lost, which would
/// look as if the library had ended the process.
struct Report {
  Said said = Said::nothing;
  std::array<char, 1 << 16> text{};
};

void say(Report& report, Said said, std::string_view text) {
  std::copy_n(text.begin(), std::min(text.size(), report.text.size() - 1), report.text.begin());
  report.said = said;
}

[[noreturn]] void be_child(const std::string& prefix, const std::function<void()>& use,
                           Report& report) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::signal(SIGALRM, SIG_DFL);
  ::alarm(kPatienceSeconds);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);  // stdout is for results only
  try {
    use();
    report.said = Said::well;
  } catch (const MachineFault& fault) {
    say(report, Said::machine_fault, fault.what());
  } catch (const std::bad_alloc&) {
    say(report, Said::machine_fault, prefix + "cannot be examined: " + std::strerror(ENOMEM));
  } catch (const std::exception& error) {
    say(report, Said::refused, error.what());
  } catch (...) {
    say(report, Said::refused, "throws something that is not a std::exception");
  }
  ::_exit(0);
}

/// Describes how a child ended that left no report.
std::string ending(int status) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM) {
    return "did not load within " + std::to_string(kPatienceSeconds) + " s";
  }
  if (WIFSIGNALED(status)) {
    return std::string("loading it ends the process: ") + ::strsignal(WTERMSIG(status));
  }
  return "loading it ends the process with exit code " + std::to_string(WEXITSTATUS(status));
}

[[noreturn]] void fail(const std::string& prefix, const char* what) {
  throw MachineFault(prefix + "cannot be examined: no " + what + ": " + std::strerror(errno));
}

/// Forks a child and waits for its end.
int status_of_child(const std::function<void()>& run, const std::string& prefix) {
  const pid_t child = ::fork();
  if (child < 0) {
    fail(prefix, "process");
  }
  if (child == 0) {
    run();
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}
}  // namespace

void in_child(const std::string& prefix, const std::function<void()>& use) {
  void* const shared =
      ::mmap(nullptr, sizeof(Report), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) {
    fail(prefix, "memory");
  }
  const auto unmap = [](Report* report) { ::munmap(report, sizeof(Report)); };
  const std::unique_ptr<Report, decltype(unmap)> report(new (shared) Report);
  int status = 0;
  // SIGKILL usually comes from outside (the OOM killer), so it is retried: a library whose child is
  // killed every time is refused. Other machine faults may pass too.
  constexpr int kTries = 3;
  const auto may_pass = [&] {
    return report->said == Said::machine_fault ||
           (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  };
  for (int tries = 0; tries == 0 || (tries < kTries && may_pass()); ++tries) {
    *report = {};
    status = status_of_child([&] { be_child(prefix, use, *report); }, prefix);
  }
  if (WIFSIGNALED(status) || report->said == Said::nothing) {
    throw PluginError(prefix + ending(status));
  }
  if (report->said == Said::machine_fault) {
    throw MachineFault(report->text.data());
  }
  if (report->said == Said::refused) {
    throw PluginError(report->text.data());
  }
}
}  // namespace altiplan::host
