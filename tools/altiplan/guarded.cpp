// SPDX-License-Identifier: Apache-2.0
#include "guarded.hpp"

#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>

#include "altiplan/error.hpp"
#include "host/base/utf8.hpp"

namespace altiplan::cli {
namespace {

int code_of(const char* program, const std::function<int()>& action) {
  try {
    return action();
  } catch (const ConfigError& error) {
    for (const Problem& problem : error.problems()) {
      std::cerr << host::printable(problem.text(), true) << '\n';
    }
    return kBadFile;
  } catch (const PluginError& error) {
    std::cerr << program << ": " << host::printable(error.what(), true) << '\n';
    return kBadPlugin;
  } catch (const Error& error) {
    std::cerr << program << ": " << host::printable(error.what(), true) << '\n';
    return kBadFile;
  } catch (const std::filesystem::filesystem_error& error) {
    std::cerr << program << ": " << host::printable(error.path1().string()) << ": "
              << error.code().message() << '\n';
    return kBadFile;
  } catch (const std::bad_alloc&) {
    std::cerr << program << ": out of memory: free memory or reduce the task\n";
    return kInternal;
  } catch (const std::system_error& error) {
    const bool no_thread = error.code() == std::errc::resource_unavailable_try_again;
    std::cerr << program << (no_thread ? ": cannot start a thread: " : ": ") << error.what()
              << '\n';
    return kInternal;
  } catch (const std::exception& error) {
    std::cerr << program << ": internal error: " << error.what() << '\n';
    return kInternal;
  }
}

/// True if stdout is a pipe or socket whose reader has closed it.
bool reader_is_gone() {
  pollfd out{STDOUT_FILENO, 0, 0};
  return ::poll(&out, 1, 0) == 1 && (out.revents & (POLLERR | POLLHUP)) != 0;
}
}  // namespace

int guarded(const char* program, const std::function<int()>& action) {
  const int code = code_of(program, action);
  std::cout.flush();
  if (!std::cout || std::ferror(stdout) != 0) {
    if (reader_is_gone()) {  // as in `| head`: not an error
      std::signal(SIGPIPE, SIG_DFL);
      std::raise(SIGPIPE);
    }
    std::cerr << program << ": cannot write to stdout\n";
    return code == kDone ? kBadFile : code;
  }
  return code;
}
}  // namespace altiplan::cli
