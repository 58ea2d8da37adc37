// SPDX-License-Identifier: Apache-2.0
#include "study/workers/work_folder.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <functional>
#include <limits>
#include <thread>

#include "altiplan/error.hpp"
#include "host/base/machine_fault.hpp"
#include "study/workers/job_record.hpp"
#include "study/workers/process_tree.hpp"

namespace altiplan::study {
namespace {

namespace fs = std::filesystem;

/// Bits of the mark for the worker's number; the higher bits identify the folder.
constexpr std::uint64_t kWorkerBits = 0xFF'FFFF;

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

/// The owner of the lock, as written in the file: "4711 on name".
struct Holder {
  int process = 0;
  std::string host;
};
Holder holder(int lock) {
  std::array<char, 300> text{};
  Holder holder;
  if (::pread(lock, text.data(), text.size() - 1, 0) > 0) {
    const std::string written = text.data();
    holder.process = std::atoi(written.c_str());
    if (const std::size_t at = written.find(" on "); at != written.npos) {
      holder.host = written.substr(at + 4);
    }
  }
  return holder;
}

/// True if the parent has ended, so that its supervisor is about to end.
bool gone(const Holder& holder) {
  return holder.process > 0 && holder.host == host_name() && ::kill(holder.process, 0) != 0 &&
         errno == ESRCH;
}

[[noreturn]] void refuse(const fs::path& folder, const char* what, int error) {
  throw Error(folder.string() + ": " + what + ": " + std::strerror(error));
}

/// Also removes the folder, unless an earlier call has left records in it.
void remove_lock(const fs::path& folder) {
  std::error_code ignored;
  fs::remove(folder / "lock", ignored);
  fs::remove(folder, ignored);
}

/// A locked descriptor, or -1 if the previous owner of the lock removed the file.
int try_lock(const fs::path& folder) {
  using Clock = std::chrono::steady_clock;
  const fs::path file = folder / "lock";
  int lock = ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  const bool is_new = lock >= 0;
  if (errno == EEXIST && !is_new) {
    lock = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  }
  if (lock < 0) {
    refuse(folder, "cannot write to the work folder", errno);
  }
  const Clock::time_point until = Clock::now() + std::chrono::seconds(10);
  while (::flock(lock, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK && errno != EINTR) {
      const int error = errno;
      ::close(lock);
      if (is_new) {
        remove_lock(folder);
      }
      refuse(folder, "cannot lock the work folder", error);
    }
    const Holder by = holder(lock);
    if (Clock::now() > until || (by.process > 0 && !gone(by))) {
      ::close(lock);
      throw Error(folder.string() + ": in use by another process: " +
                  (by.process > 0 ? std::to_string(by.process) + " on " + by.host : "unknown"));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  struct stat locked {};
  struct stat there {};
  if (::fstat(lock, &locked) != 0 || (::stat(file.c_str(), &there) != 0 && errno != ENOENT)) {
    const int error = errno;
    ::close(lock);
    if (is_new) {
      remove_lock(folder);
    }
    refuse(folder, "cannot read the lock of the work folder", error);
  }
  if (locked.st_ino != there.st_ino || locked.st_dev != there.st_dev) {
    ::close(lock);
    return -1;
  }
  return lock;
}

void sign(const fs::path& folder, int lock) {
  const std::string text = std::to_string(::getpid()) + " on " + host_name();
  if (::ftruncate(lock, 0) != 0 ||
      ::pwrite(lock, text.data(), text.size(), 0) != ssize_t(text.size())) {
    refuse(folder, "cannot write to the work folder", errno);
  }
}

/// Bit 62 is set so that no memory use ever reaches the limit that serves as the mark.
std::uint64_t mark_of(const fs::path& folder) {
  struct stat status {};
  if (::stat(folder.c_str(), &status) !=
      0) {  // otherwise another folder's workers may share the mark
    refuse(folder, "cannot read the work folder's status", errno);
  }
  const std::size_t hash =
      std::hash<std::string>()(std::to_string(status.st_dev) + " " + std::to_string(status.st_ino));
  return (std::uint64_t(1) << 62) | (std::uint64_t(std::uint32_t(hash ^ (hash >> 32))) << 24);
}

/// Files that workers have made, sorted.
std::vector<fs::path> files_of_workers(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().filename().string().starts_with("worker-")) {
      files.push_back(entry->path());
    }
  }
  if (host::is_machine_fault(error.value())) {
    throw host::MachineFault(host::unreadable(folder, error.value()));
  }
  std::sort(files.begin(), files.end());
  return files;
}
}  // namespace

WorkFolder::WorkFolder(const fs::path& folder)
    : path_(fs::absolute(folder).lexically_normal()), owner_(::getpid()) {
  // An interruption between creating the folder and `unfinished_` would leave it behind.
  const auto lock = host::uninterrupted();
  do {
    std::error_code error;
    fs::create_directories(path_, error);
    std::error_code ignored;
    if (error && !fs::is_directory(path_, ignored)) {
      refuse(path_, "cannot create the work folder", error.value());
    }
    lock_ = try_lock(path_);
  } while (lock_ < 0);
  try {
    mark_ = mark_of(path_);
    sign(path_, lock_);
  } catch (...) {
    remove_lock(path_);
    ::close(lock_);
    throw;
  }
  processes().kill();
  unfinished_.emplace([this] {
    try {
      const bool is_done = records().empty();
      for (const fs::path& file : files_of_workers(path_)) {
        std::error_code error;
        if (is_done || file.extension() != ".records") {  // the next call continues from them
          fs::remove(file, error);
        }
      }
      if (is_done) {
        remove_lock(path_);
      }
    } catch (const host::MachineFault&) {
      // The next call tries again.
    }
  });
}

WorkFolder::~WorkFolder() {
  unfinished_.reset();
  ::close(lock_);
}

std::vector<Ended> WorkFolder::records() const {
  std::vector<Ended> records;
  for (const fs::path& file : files_of_workers(path_)) {
    if (file.extension() != ".records") {
      continue;
    }
    const ReadText all = read_from(file.string(), 0, std::numeric_limits<std::size_t>::max());
    if (host::is_machine_fault(all.error)) {
      throw host::MachineFault(host::unreadable(file, all.error));
    }
    std::string_view text = all.text;
    for (Ended ended; !text.empty() && take_record(text, ended) == RecordState::whole;) {
      records.push_back(ended);
    }
  }
  return records;
}

void WorkFolder::clear() {
  for (const fs::path& file : files_of_workers(path_)) {
    std::error_code error;
    fs::remove(file, error);
  }
}

std::string WorkFolder::file(std::size_t worker, std::string_view what) const {
  const std::string name = "worker-" + std::to_string(owner_) + "-" + std::to_string(worker);
  return (path_ / name).string() + "." + std::string(what);
}

ProcessTree WorkFolder::processes() const { return {0, mark_, ~kWorkerBits}; }

ProcessTree WorkFolder::processes(pid_t root, std::size_t worker) const {
  return {root, mark_ | (std::uint64_t(worker) & kWorkerBits), ~std::uint64_t(0)};
}
}  // namespace altiplan::study
