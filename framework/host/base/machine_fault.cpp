// SPDX-License-Identifier: Apache-2.0
#include "host/base/machine_fault.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace altiplan::host {
namespace {

constexpr std::array kOfTheMachine = {EIO,    EMFILE, ENFILE, ENOSPC, ENOMEM,
                                      EAGAIN, EDQUOT, ESTALE, ENOLCK, ETIMEDOUT};

/// 0, or why the file cannot be read to its end.
int reading_error(const std::filesystem::path& file) {
  const int from = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (from < 0) {
    return errno;
  }
  std::array<char, 65536> buffer;
  ssize_t got = 0;
  do {
    got = ::read(from, buffer.data(), buffer.size());
  } while (got > 0 || (got < 0 && errno == EINTR));
  const int error = got < 0 ? errno : 0;
  ::close(from);
  return error;
}
}  // namespace

bool is_machine_fault(int error) { return std::ranges::count(kOfTheMachine, error) > 0; }

bool names_machine_fault(std::string_view message) {
  return std::ranges::any_of(
      kOfTheMachine, [&](int error) { return message.find(std::strerror(error)) != message.npos; });
}

void fail_to_use(const std::string& why) {
  if (names_machine_fault(why)) {
    throw MachineFault(why);
  }
  throw PluginError(why);
}

std::string unreadable(const std::filesystem::path& file, int error) {
  return file.string() + ": cannot be read: " + std::strerror(error);
}

std::string first_unreadable(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& file : files) {
    if (const int error = reading_error(file); error != 0) {
      return unreadable(file, error);
    }
  }
  return "";
}
}  // namespace altiplan::host
