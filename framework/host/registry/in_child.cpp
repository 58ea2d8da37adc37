// SPDX-License-Identifier: Apache-2.0
#include "host/registry/in_child.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "altiplan/error.hpp"

namespace altiplan::host {
namespace {

constexpr unsigned kPatienceSeconds = 20;
constexpr const char* kWell = "well";

[[noreturn]] void report(const std::function<void()>& use, int to) {
  std::string text = kWell;
  try {
    use();
  } catch (const std::exception& error) {
    text = error.what();
  } catch (...) {
    text = "throws something that is not a std::exception";
  }
  const ssize_t written = ::write(to, text.data(), text.size());
  ::_exit(written == static_cast<ssize_t>(text.size()) ? 0 : 1);
}

std::string read_all(int from) {
  std::string text;
  char buffer[1024];
  ssize_t got = 0;
  while ((got = ::read(from, buffer, sizeof buffer)) > 0 || (got < 0 && errno == EINTR)) {
    text.append(buffer, got > 0 ? static_cast<std::size_t>(got) : 0);
  }
  return text;
}

/// How a child ended that has not reported.
std::string ending(int status) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM) {
    return "did not load within " + std::to_string(kPatienceSeconds) + " s";
  }
  if (WIFSIGNALED(status)) {
    return std::string("loading it ends the process: ") + ::strsignal(WTERMSIG(status));
  }
  return "loading it ends the process with exit code " + std::to_string(WEXITSTATUS(status));
}
}  // namespace

void in_child(const std::string& prefix, const std::function<void()>& use) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    throw Error(std::string("no pipe for examining a library: ") + std::strerror(errno));
  }
  const pid_t child = ::fork();
  if (child < 0) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw Error(std::string("no process for examining a library: ") + std::strerror(errno));
  }
  if (child == 0) {
    ::signal(SIGALRM, SIG_DFL);
    ::alarm(kPatienceSeconds);
    ::dup2(STDERR_FILENO, STDOUT_FILENO);  // results alone stand on stdout
    report(use, ends[1]);
  }
  ::close(ends[1]);
  const std::string text = read_all(ends[0]);
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status) || text.empty()) {
    throw PluginError(prefix + ending(status));
  }
  if (text != kWell) {
    throw PluginError(text);
  }
}
}  // namespace altiplan::host
