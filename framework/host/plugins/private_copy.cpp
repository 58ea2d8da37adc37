// SPDX-License-Identifier: Apache-2.0
#include "host/plugins/private_copy.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "altiplan/error.hpp"
#include "host/base/machine_fault.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;
namespace {

/// This process's folder name in /proc, which may differ from getpid().
fs::path path_of(int descriptor) {
  std::error_code error;
  const fs::path process = fs::read_symlink("/proc/self", error);
  return "/proc" / process / "fd" / std::to_string(descriptor);
}

/// True if everything was copied; otherwise errno holds the reason.
bool copy(int from, int to) {
  constexpr std::size_t kChunk = std::size_t{1} << 30;
  ssize_t got = 0;
  while ((got = ::sendfile(to, from, nullptr, kChunk)) > 0 || (got < 0 && errno == EINTR)) {
  }
  return got == 0;
}

/// True if nobody can change the file any more; otherwise errno holds the reason.
bool seal(int file) {
  constexpr int kSeals = F_SEAL_WRITE | F_SEAL_GROW | F_SEAL_SHRINK | F_SEAL_SEAL;
  constexpr int kTries = 20;
  for (int n = 0; n < kTries; ++n) {
    if (::fcntl(file, F_ADD_SEALS, kSeals) == 0) {
      return true;
    }
    if (errno != EBUSY && errno != EINTR) {
      return false;
    }
    // On a loaded machine the kernel itself may hold a page of it for a while.
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}
}  // namespace

PrivateCopy::PrivateCopy(const fs::path& file) {
  const auto fail = [&](const char* what, int error) {
    fail_to_use(file.string() + what + std::strerror(error), error);
  };
  formats::Descriptor from(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (from.number() < 0) {
    fail(" cannot be opened: ", errno);
  }
  struct stat status;
  if (::fstat(from.number(), &status) != 0) {
    fail(" cannot be read: ", errno);
  }
  if (!S_ISREG(status.st_mode)) {
    throw Error(file.string() + " is not a regular file");
  }
  const std::string name = file.filename().string().substr(0, 200);
  formats::Descriptor to(::memfd_create(name.c_str(), MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (to.number() < 0 || !copy(from.number(), to.number()) || !seal(to.number())) {
    if (errno == EFBIG) {  // RLIMIT_FSIZE applies to memory files too: fall back to the file itself
      descriptor_ = std::move(from);
      return;
    }
    fail(" cannot be copied into memory: ", errno);
  }
  descriptor_ = std::move(to);
}

fs::path PrivateCopy::path() const { return path_of(descriptor_.number()); }

fs::path PrivateCopy::path_to_load() {
  // A previously loaded plugin may have closed the descriptor.
  static std::mutex mutex;
  static std::set<fs::path>& loaded = *new std::set<fs::path>;
  const std::lock_guard lock(mutex);
  while (!loaded.insert(path()).second) {
    const int old = descriptor_.number();
    descriptor_ = formats::Descriptor(::fcntl(old, F_DUPFD_CLOEXEC, old + 1));
    if (descriptor_.number() < 0) {
      const int error = errno;
      fail_to_use(std::string("no descriptor for a library: ") + std::strerror(error), error);
    }
  }
  return path();
}
}  // namespace altiplan::host
