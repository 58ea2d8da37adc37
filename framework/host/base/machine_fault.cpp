// SPDX-License-Identifier: Apache-2.0
#include "host/base/machine_fault.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace altiplan::host {
namespace {

namespace fs = std::filesystem;

constexpr std::array kOfTheMachine = {EIO,    EMFILE, ENFILE, ENOSPC, ENOMEM,
                                      EAGAIN, EDQUOT, ESTALE, ENOLCK, ETIMEDOUT};

fs::file_status as_told(const fs::file_status& status, const fs::path& file,
                        const std::error_code& error) {
  if (is_machine_fault(error.value())) {
    throw MachineFault(unreadable(file, error.value()));
  }
  return status;
}
}  // namespace

bool is_machine_fault(int error) { return std::ranges::count(kOfTheMachine, error) > 0; }

fs::file_status status_of(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  return as_told(status, file, error);
}

fs::file_status link_status_of(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(file, error);
  return as_told(status, file, error);
}

bool is_there(const fs::path& file) { return fs::exists(status_of(file)); }

bool is_folder(const fs::path& file) { return fs::is_directory(status_of(file)); }

void fail_to_use(const std::string& why, int error) {
  if (is_machine_fault(error)) {
    throw MachineFault(why);
  }
  throw PluginError(why);
}

std::string unreadable(const fs::path& file, int error) {
  return file.string() + ": cannot be read: " + std::strerror(error);
}

int reading_error(const fs::path& file) {
  struct stat found {};
  if (::stat(file.c_str(), &found) != 0) {
    return errno;
  }
  if (!S_ISREG(found.st_mode)) {
    return 0;  // opening a device has side effects, and its data may be endless
  }
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

std::string first_unreadable(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    if (const int error = reading_error(file); error != 0) {
      return unreadable(file, error);
    }
  }
  return "";
}
}  // namespace altiplan::host
