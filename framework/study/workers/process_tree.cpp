// SPDX-License-Identifier: Apache-2.0
#include "study/workers/process_tree.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

namespace altiplan::study {
namespace {

using FileText = std::array<char, 4096>;  ///< ends with a zero

/// The text of a file of /proc; "" if the process has ended.
std::string_view read_proc(pid_t process, const char* name, FileText& text) {
  std::array<char, 64> path{};
  std::snprintf(path.data(), path.size(), "/proc/%d/%s", int(process), name);
  const int file = ::open(path.data(), O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    return {};
  }
  std::size_t size = 0;
  ssize_t got = 0;
  while (size + 1 < text.size() &&
         (got = ::read(file, text.data() + size, text.size() - 1 - size)) > 0) {
    size += std::size_t(got);
  }
  ::close(file);
  return {text.data(), size};
}

/// The number after a name like "VmHWM:", in kB; 0 if the name is missing.
double megabytes(std::string_view text, std::string_view name) {
  const std::size_t at = text.find(name);
  return at == text.npos ? 0 : std::strtod(text.data() + at + name.size(), nullptr) / 1024;
}

std::vector<pid_t> all_numbers(const char* folder) {
  std::vector<pid_t> numbers;
  const std::unique_ptr<DIR, int (*)(DIR*)> open(::opendir(folder), ::closedir);
  while (const dirent* entry = open ? ::readdir(open.get()) : nullptr) {
    if (const int number = std::atoi(entry->d_name); number > 0) {
      numbers.push_back(number);
    }
  }
  return numbers;
}

/// State and CPU time, which follow the name in brackets; the name may contain any characters.
struct Stat {
  char state = 'X';
  double cpu_s = 0;
};
Stat stat_of(pid_t process) {
  FileText text{};
  const std::string_view all = read_proc(process, "stat", text);
  const std::size_t end = all.rfind(')');
  Stat stat;
  if (end == all.npos) {
    return stat;
  }
  unsigned long long user = 0;
  unsigned long long system = 0;
  long long children_user = 0;
  long long children_system = 0;
  if (std::sscanf(std::string(all.substr(end + 1)).c_str(),
                  " %c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %llu %llu %lld %lld", &stat.state,
                  &user, &system, &children_user, &children_system) != 5) {
    stat.state = 'X';
  }
  stat.cpu_s = double(user + system + (unsigned long long)(children_user + children_system)) /
               double(::sysconf(_SC_CLK_TCK));
  return stat;
}

bool ended(char state) { return state == 'Z' || state == 'X'; }

/// Adds the descendants; removes ended processes.
std::vector<pid_t> with_children(std::vector<pid_t> found) {
  for (std::size_t i = 0; i < found.size(); ++i) {  // grows
    for (const pid_t child : children_of(found[i])) {
      if (std::ranges::count(found, child) == 0) {
        found.push_back(child);
      }
    }
  }
  std::erase_if(found, [](pid_t process) { return ended(stat_of(process).state); });
  return found;
}

/// Sends the signal to exactly this process: a process id reused in the meantime is not in the
/// tree.
void send(const ProcessTree& tree, pid_t process, int signal) {
  const int handle = int(::syscall(SYS_pidfd_open, process, 0));  // glibc's are not for C++ yet
  if (handle < 0) {
    return;
  }
  if (process == tree.root || is_marked(process, tree.mark, tree.mask) ||
      std::ranges::count(tree.find(), process) > 0) {
    ::syscall(SYS_pidfd_send_signal, handle, signal, nullptr, 0);
  }
  ::close(handle);
}
}  // namespace

bool is_marked(pid_t process, std::uint64_t mark, std::uint64_t mask) {
  rlimit limit{};
  return ::prlimit(process, RLIMIT_RSS, nullptr, &limit) == 0 &&
         (limit.rlim_cur & mask) == (mark & mask);
}

bool set_mark(std::uint64_t mark) {
  rlimit limit{};
  ::getrlimit(RLIMIT_RSS, &limit);
  limit.rlim_cur = mark;
  return ::setrlimit(RLIMIT_RSS, &limit) == 0;
}

std::vector<pid_t> children_of(pid_t process) {
  std::vector<pid_t> children;
  const std::string tasks = "/proc/" + std::to_string(process) + "/task";
  for (const pid_t task : all_numbers(tasks.c_str())) {
    std::string text;
    FileText part{};
    const int file =
        ::open((tasks + "/" + std::to_string(task) + "/children").c_str(), O_RDONLY | O_CLOEXEC);
    ssize_t got = 0;
    while (file >= 0 && (got = ::read(file, part.data(), part.size())) > 0) {
      text.append(part.data(), std::size_t(got));
    }
    if (file >= 0) {
      ::close(file);
    }
    const char* at = text.c_str();
    char* end = nullptr;
    for (long child = std::strtol(at, &end, 10); end != at; child = std::strtol(at, &end, 10)) {
      children.push_back(pid_t(child));
      at = end;
    }
  }
  return children;
}

std::vector<pid_t> ProcessTree::find() const {
  std::vector<pid_t> found;
  if (root > 0) {
    found.push_back(root);
  }
  for (const pid_t process : all_numbers("/proc")) {
    if (process != root && is_marked(process, mark, mask)) {
      found.push_back(process);
    }
  }
  return with_children(std::move(found));
}

std::vector<pid_t> ProcessTree::below_root() const {
  static const bool kListed = ::access("/proc/thread-self/children", R_OK) == 0;
  return kListed ? with_children({root}) : find();
}

std::size_t ProcessTree::kill(pid_t keep) const {
  using Clock = std::chrono::steady_clock;
  if (root > 0) {
    ::kill(-root, SIGKILL);  // its whole session at once, without gaps
  }
  const Clock::time_point until = Clock::now() + std::chrono::seconds(10);
  std::size_t first = 0;
  for (std::vector<pid_t> found = find(); !found.empty() && Clock::now() < until; found = find()) {
    first = std::max(first, found.size());
    for (const pid_t process : found) {
      send(*this, process, SIGSTOP);
    }
    if (find() == found) {  // all of them are stopped
      for (const pid_t process : found) {
        send(*this, process, SIGKILL);
      }
    }
    for (const pid_t process : found) {
      if (process != keep) {
        ::waitpid(process, nullptr, WNOHANG);
      }
    }
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return first;
}

ProcessUse use_of(pid_t process) {
  ProcessUse use;
  const Stat stat = stat_of(process);
  FileText text{};
  const std::string_view status = read_proc(process, "status", text);
  use.alive = !ended(stat.state);
  use.cpu_s = stat.cpu_s;
  use.memory_mb =
      megabytes(status, "RssAnon:") + megabytes(status, "RssShmem:") + megabytes(status, "VmSwap:");
  use.file_mb = megabytes(status, "RssFile:");
  use.peak_resident_mb = megabytes(status, "VmHWM:");
  return use;
}

double proportional_memory_mb(pid_t process) {
  FileText text{};
  const std::string_view rollup = read_proc(process, "smaps_rollup", text);
  return megabytes(rollup, "Pss_Anon:") + megabytes(rollup, "Pss_Shmem:") +
         megabytes(rollup, "SwapPss:");
}

TreeUse use_of(const std::vector<pid_t>& processes, double base_mb) {
  TreeUse all;
  all.processes = processes.size();
  for (const pid_t process : processes) {
    const ProcessUse use = use_of(process);
    all.cpu_s += use.cpu_s;
    all.memory_mb += use.memory_mb;
  }
  if (processes.size() > 1) {
    const auto proportional = [&] {
      double sum = 0;
      for (const pid_t process : processes) {
        sum += proportional_memory_mb(process);
      }
      return sum;
    };
    // When a process ends between two checks, its share of common pages is added to another's: only
    // memory seen in two rounds counts.
    const double first = proportional();
    all.memory_mb = std::min(first, proportional());
  }
  all.memory_mb = std::max(0.0, all.memory_mb - base_mb);
  return all;
}
}  // namespace altiplan::study
