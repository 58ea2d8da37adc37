// SPDX-License-Identifier: Apache-2.0
#include "host/base/output_file.hpp"

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <utility>
#include <vector>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "host/base/utf8.hpp"

namespace altiplan::host {
namespace {

namespace fs = std::filesystem;

std::string cannot_write(const fs::path& place, const std::string& why) {
  return "cannot write '" + place.string() + "': " + why;
}

/// The kind of a path that is not a regular file; "" for a regular file.
const char* kind_of(mode_t mode) {
  return S_ISREG(mode)    ? ""
         : S_ISLNK(mode)  ? "a symbolic link"
         : S_ISDIR(mode)  ? "a folder"
         : S_ISFIFO(mode) ? "a pipe"
         : S_ISSOCK(mode) ? "a socket"
                          : "a device";
}

/// True if the folder is in /proc or /sys.
bool is_of_the_kernel(const fs::path& folder) {
  struct statfs found {};
  return ::statfs(folder.c_str(), &found) == 0 &&
         (found.f_type == PROC_SUPER_MAGIC || found.f_type == SYSFS_MAGIC);
}

fs::path folder_of(const fs::path& place) {
  return place.has_parent_path() ? place.parent_path() : fs::path(".");
}
}  // namespace

fs::path name_beside(const fs::path& place) {
  constexpr std::size_t kLongest = 200;  // of the 255 bytes that a name may have
  std::uint64_t number = 0;
  if (::getrandom(&number, sizeof number, GRND_NONBLOCK) != ssize_t(sizeof number)) {
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME, &now);
    number = std::uint64_t(now.tv_sec) * 1'000'000'000 + std::uint64_t(now.tv_nsec) +
             std::uint64_t(::getpid());
  }
  char suffix[32];
  std::snprintf(suffix, sizeof suffix, ".%016llx.partial", static_cast<unsigned long long>(number));
  return folder_of(place) / (place.filename().string().substr(0, kLongest) + suffix);
}

std::string output_problem(const fs::path& place) {
  if (place.empty()) {
    return "expected a file name, found nothing";
  }
  struct stat found {};
  if (::lstat(place.c_str(), &found) == 0) {
    if (const std::string kind = kind_of(found.st_mode); !kind.empty()) {
      return cannot_write(place, "it is " + kind + ", expected the name of a file" +
                                     (S_ISLNK(found.st_mode) ? ", not of a link to it" : ""));
    }
    if (::access(place.c_str(), W_OK) != 0) {
      return cannot_write(place, std::strerror(errno));
    }
  } else if (errno != ENOENT && errno != ENOTDIR) {
    return cannot_write(place, std::strerror(errno));
  }
  if (!place.has_filename()) {
    return cannot_write(place, "it is not a file name");
  }
  const fs::path folder = folder_of(place);
  if (::stat(folder.c_str(), &found) != 0) {
    const int reason = errno;
    return "cannot write into the folder '" + folder.string() + "': " + std::strerror(reason) +
           (reason == ENOENT ? formats::nearest_beside(folder.string(), true) : "");
  }
  if (!S_ISDIR(found.st_mode)) {
    return "cannot write into the folder '" + folder.string() + "': " + std::strerror(ENOTDIR);
  }
  if (is_of_the_kernel(folder)) {  // access() would let root write there
    return "cannot write into the folder '" + folder.string() +
           "': it is on a kernel file system, which holds no files";
  }
  return ::access(folder.c_str(), W_OK | X_OK) == 0
             ? ""
             : "cannot write into the folder '" + folder.string() + "': " + std::strerror(errno);
}

OutputFile::OutputFile(fs::path place) : place_(std::move(place)) {
  if (const std::string why = output_problem(place_); !why.empty()) {
    throw Error(why);
  }
  absolute_place_ = fs::absolute(place_);
  struct stat before {};
  const bool is_there = ::lstat(absolute_place_.c_str(), &before) == 0;
  if (!is_there && errno != ENOENT) {
    fail(errno);  // its permissions are to be kept
  }
  const auto lock = uninterrupted();
  do {
    beside_ = name_beside(absolute_place_);
    descriptor_ =
        ::open(beside_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && (errno == EEXIST || errno == EINTR));
  if (descriptor_ < 0) {
    fail(errno);
  }
  unfinished_.emplace([file = beside_] { ::unlink(file.c_str()); });
  if (is_there && ::fchmod(descriptor_, before.st_mode & 0777) != 0) {
    const int error = errno;
    ::close(descriptor_);
    fail(error);
  }
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

void OutputFile::fail(int error) { throw Error(cannot_write(place_, std::strerror(error))); }

void OutputFile::write(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor_, text.data(), text.size());
    if (written < 0 && errno != EINTR) {
      fail(errno);
    }
    text.remove_prefix(written > 0 ? std::size_t(written) : 0);
  }
}

void OutputFile::put_in_place() {
  if (::fsync(descriptor_) != 0 || ::close(std::exchange(descriptor_, -1)) != 0) {
    fail(errno);
  }
  const auto lock = uninterrupted();
  if (::rename(beside_.c_str(), absolute_place_.c_str()) != 0) {
    fail(errno);
  }
  unfinished_->is_finished();
}

namespace {

/// 0, or the errno of an incomplete write.
int written(int to, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(to, text.data(), text.size());
    if (count < 0 && errno != EINTR) {
      return errno;
    }
    text.remove_prefix(count > 0 ? std::size_t(count) : 0);
  }
  return 0;
}

/// The errors of systems without unnamed files (O_TMPFILE), or without /proc to link them.
bool is_unsupported(int error) {
  return error == EOPNOTSUPP || error == EISDIR || error == EINVAL || error == ENOENT ||
         error == EPERM || error == EXDEV;
}

/// Writes a file that has no name until it is complete, so that a killed process leaves nothing
/// behind. Returns 0 or the errno.
int write_unnamed(const fs::path& place, std::string_view text) {
  struct stat before {};
  const bool is_there = ::lstat(place.c_str(), &before) == 0;
  if (!is_there && errno != ENOENT) {
    return errno;  // its permissions are to be kept
  }
  const int file = ::open(folder_of(place).c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
  if (file < 0) {
    return errno;
  }
  int error = written(file, text);
  const auto then = [&](auto&& step) { error = error == 0 && step() != 0 ? errno : error; };
  then([&] { return is_there ? ::fchmod(file, before.st_mode & 0777) : 0; });
  then([&] { return ::fsync(file); });
  const std::string name = "/proc/self/fd/" + std::to_string(file);
  const fs::path beside = name_beside(place);
  const auto lock = uninterrupted();
  then([&] {
    return ::linkat(AT_FDCWD, name.c_str(), AT_FDCWD, beside.c_str(), AT_SYMLINK_FOLLOW);
  });
  const bool is_named = error == 0;
  error = ::close(file) != 0 && error == 0 ? errno : error;
  then([&] { return ::rename(beside.c_str(), place.c_str()); });
  if (is_named && error != 0) {
    ::unlink(beside.c_str());
  }
  return error;
}
}  // namespace

void write_file(const fs::path& file, const std::string& text) {
  if (output_problem(file).empty()) {
    const int error = write_unnamed(file, text);
    if (error == 0) {
      return;
    }
    if (!is_unsupported(error)) {
      throw Error(cannot_write(file, std::strerror(error)));
    }
  }
  OutputFile output(file);
  output.write(text);
  output.put_in_place();
}
}  // namespace altiplan::host
