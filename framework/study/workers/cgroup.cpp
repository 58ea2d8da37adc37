// SPDX-License-Identifier: Apache-2.0
#include "study/workers/cgroup.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "altiplan/error.hpp"

namespace altiplan::study {
namespace {

namespace fs = std::filesystem;

constexpr const char* kParent = "altiplan-program";

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The kernel accepts or refuses a value in one write.
bool put(const fs::path& file, const std::string& value) {
  const int to = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  if (to < 0) {
    return false;
  }
  const bool taken = ::write(to, value.data(), value.size()) == ssize_t(value.size());
  ::close(to);
  return taken;
}

/// The mount point of cgroup v2; "" if not mounted.
fs::path mount_point() {
  std::ifstream mounts("/proc/self/mounts");
  for (std::string line; std::getline(mounts, line);) {
    std::istringstream words(line);
    std::string device;
    std::string place;
    std::string type;
    words >> device >> place >> type;
    if (type == "cgroup2") {
      return place;
    }
  }
  return {};
}

/// This process's group in it.
std::string own_group() {
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    if (line.starts_with("0::/")) {
      return line.substr(4);
    }
  }
  return {};
}

bool has_word(const std::string& text, const std::string& word) {
  std::istringstream words(text);
  for (std::string one; words >> one;) {
    if (one == word) {
      return true;
    }
  }
  return false;
}
}  // namespace

std::optional<fs::path> ControlGroups::delegated() {
  const fs::path mount = mount_point();
  const std::string group = own_group();
  if (mount.empty() || group.empty()) {  // or the root group, which is the system's
    return std::nullopt;
  }
  const fs::path own = mount / group;
  const auto writable = [&](const char* file) { return ::access((own / file).c_str(), W_OK) == 0; };
  const bool alone = text_of(own / "cgroup.procs") == std::to_string(::getpid()) + "\n";
  if (alone && has_word(text_of(own / "cgroup.controllers"), "memory") && writable("") &&
      writable("cgroup.procs") && writable("cgroup.subtree_control")) {
    return own;
  }
  return std::nullopt;
}

ControlGroups::ControlGroups(const fs::path& own, std::size_t workers, double memory_mb)
    : own_(own) {
  const auto expect = [&](bool done, const char* what) {
    if (!done) {
      const int error = errno;
      leave();
      throw Error(own_.string() + ": " + what + ": " + std::strerror(error));
    }
  };
  std::error_code error;
  fs::create_directory(own_ / kParent, error);
  expect(put(own_ / kParent / "cgroup.procs", "0"), "cannot move into its own control group");
  expect(put(own_ / "cgroup.subtree_control", "+memory"), "cannot delegate the memory controller");
  for (std::size_t i = 1; i <= workers; ++i) {
    const fs::path group = own_ / ("altiplan-worker-" + std::to_string(i));
    fs::create_directory(group, error);
    workers_.push_back(group);
    expect(put(group / "memory.max", std::to_string(std::int64_t(memory_mb * double(1 << 20)))),
           "cannot limit the memory of a control group");
    put(group / "memory.swap.max", "0");   // missing without swap
    put(group / "memory.oom.group", "1");  // kill all of a worker's processes, or none
  }
}

void ControlGroups::leave() {
  for (const fs::path& group : workers_) {
    ::rmdir(group.c_str());
  }
  put(own_ / "cgroup.subtree_control", "-memory");
  put(own_ / "cgroup.procs", "0");
  ::rmdir((own_ / kParent).c_str());
}

ControlGroups::~ControlGroups() { leave(); }

std::string ControlGroups::entrance(std::size_t worker) const {
  return (workers_[worker] / "cgroup.procs").string();
}
}  // namespace altiplan::study
