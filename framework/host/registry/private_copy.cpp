// SPDX-License-Identifier: Apache-2.0
#include "host/registry/private_copy.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "altiplan/error.hpp"
#include "host/base/machine_fault.hpp"

namespace altiplan::host {
namespace fs = std::filesystem;
namespace {

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) {
      ::close(number_);
    }
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return number_; }
  int release() { return std::exchange(number_, -1); }

 private:
  int number_;
};

/// The process by the number that its /proc knows, which need not be that of getpid.
fs::path path_of(int descriptor) {
  std::error_code error;
  const fs::path process = fs::read_symlink("/proc/self", error);
  return "/proc" / process / "fd" / std::to_string(descriptor);
}

/// Whether all went over; else errno says why not.
bool copy(int from, int to) {
  constexpr std::size_t kChunk = std::size_t{1} << 30;
  ssize_t got = 0;
  while ((got = ::sendfile(to, from, nullptr, kChunk)) > 0 || (got < 0 && errno == EINTR)) {
  }
  return got == 0;
}
}  // namespace

PrivateCopy::PrivateCopy(const fs::path& file) {
  const auto fail = [&](const char* what, int error) {
    fail_to_use(file.string() + what + std::strerror(error));
  };
  Descriptor from(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (from.get() < 0) {
    fail(" cannot be opened: ", errno);
  }
  struct stat status;
  if (::fstat(from.get(), &status) != 0) {
    fail(" cannot be read: ", errno);
  }
  if (!S_ISREG(status.st_mode)) {
    throw Error(file.string() + " is not a regular file");
  }
  const std::string name = file.filename().string().substr(0, 200);
  Descriptor to(::memfd_create(name.c_str(), MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (to.get() < 0 || !copy(from.get(), to.get()) ||
      ::fcntl(to.get(), F_ADD_SEALS, F_SEAL_WRITE | F_SEAL_GROW | F_SEAL_SHRINK | F_SEAL_SEAL) !=
          0) {
    if (errno == EFBIG) {  // RLIMIT_FSIZE counts memory too: the file itself has to do
      descriptor_ = from.release();
      return;
    }
    fail(" cannot be copied into memory: ", errno);
  }
  descriptor_ = to.release();
}

PrivateCopy::~PrivateCopy() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

PrivateCopy::PrivateCopy(PrivateCopy&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

fs::path PrivateCopy::path() const { return path_of(descriptor_); }

fs::path PrivateCopy::path_to_load() {
  // A plugin may have closed the descriptor of a library that was loaded before.
  static std::mutex mutex;
  static std::set<fs::path>& loaded = *new std::set<fs::path>;
  const std::lock_guard lock(mutex);
  while (!loaded.insert(path()).second) {
    const Descriptor old(descriptor_);
    descriptor_ = ::fcntl(old.get(), F_DUPFD_CLOEXEC, old.get() + 1);
    if (descriptor_ < 0) {
      fail_to_use(std::string("no descriptor for a library: ") + std::strerror(errno));
    }
  }
  return path();
}
}  // namespace altiplan::host
