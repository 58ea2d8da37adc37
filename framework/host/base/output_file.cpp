// SPDX-License-Identifier: Apache-2.0
#include "host/base/output_file.hpp"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <utility>

#include "altiplan/error.hpp"

namespace altiplan::host {
namespace {

namespace fs = std::filesystem;

std::string cannot_write(const fs::path& place, const std::string& why) {
  return "cannot write '" + place.string() + "': " + why;
}

/// What is there in place of a file; "" where it is one.
const char* kind_of(mode_t mode) {
  return S_ISREG(mode)    ? ""
         : S_ISLNK(mode)  ? "a symbolic link"
         : S_ISDIR(mode)  ? "a folder"
         : S_ISFIFO(mode) ? "a pipe"
         : S_ISSOCK(mode) ? "a socket"
                          : "a device";
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
    return cannot_write(place, "it is no name of a file");
  }
  const fs::path folder = folder_of(place);
  if (::stat(folder.c_str(), &found) != 0) {
    return "cannot write into the folder '" + folder.string() + "': " + std::strerror(errno);
  }
  if (!S_ISDIR(found.st_mode)) {
    return "cannot write into the folder '" + folder.string() + "': " + std::strerror(ENOTDIR);
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

void write_file(const fs::path& file, const std::string& text) {
  OutputFile output(file);
  output.write(text);
  output.put_in_place();
}
}  // namespace altiplan::host
