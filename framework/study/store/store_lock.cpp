// SPDX-License-Identifier: Apache-2.0
#include "study/store/store_lock.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "altiplan/error.hpp"

namespace altiplan::study {
namespace {

/// A lock of the open file description. The system does not report its owner: the length of the
/// lock encodes the process id.
struct flock range_for(pid_t process) {
  constexpr off_t kBeyondAllStores = off_t(1) << 62;
  struct flock range {};
  range.l_type = F_WRLCK;
  range.l_whence = SEEK_SET;
  range.l_start = kBeyondAllStores;
  range.l_len = off_t(process) + 1;
  return range;
}

/// The owner of the lock: "process 4711", or "".
std::string writer_of(int descriptor) {
  struct flock held = range_for(0);
  const bool is_known = ::fcntl(descriptor, F_OFD_GETLK, &held) == 0 && held.l_type != F_UNLCK;
  return is_known ? "process " + std::to_string(held.l_len - 1) : "";
}

std::string why_not_locked(int descriptor, int error) {
  if (error != EAGAIN && error != EACCES) {
    return std::string("cannot be locked: ") + std::strerror(error);
  }
  const std::string writer = writer_of(descriptor);
  return "is being written by " + (writer.empty() ? "another process" : writer) +
         ", under this name or another: wait until it ends, or give another --out";
}
}  // namespace

StoreLock::StoreLock(const std::filesystem::path& file)
    : descriptor_(::open(file.c_str(), O_RDWR | O_CLOEXEC)) {
  struct flock range = range_for(::getpid());
  if (descriptor_.number() < 0 || ::fcntl(descriptor_.number(), F_OFD_SETLK, &range) != 0) {
    const int error = errno;
    const std::string why = descriptor_.number() < 0
                                ? std::string("cannot be opened: ") + std::strerror(error)
                                : why_not_locked(descriptor_.number(), error);
    throw Error("the database '" + file.string() + "' " + why);
  }
}

void expect_no_writer(const std::filesystem::path& file) {
  const formats::Descriptor store(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  const std::string writer = store.number() < 0 ? "" : writer_of(store.number());
  if (!writer.empty()) {
    throw Error("the database '" + file.string() + "' is being written by " + writer +
                ": wait until it ends, since it will add runs");
  }
}
}  // namespace altiplan::study
