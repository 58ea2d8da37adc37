// SPDX-License-Identifier: Apache-2.0
#include "fate.hpp"

#include <sys/mman.h>
#include <sys/syscall.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" long syscall(long number, ...) noexcept;

namespace faults {
namespace {

constexpr int kKilled = -1;
constexpr int kHalf = -2;

struct Failed {
  std::uint32_t call;
  std::int32_t process;
  std::array<char, 248> path;
};
constexpr std::size_t kMaxKept = 64;

struct State {
  std::array<std::atomic<std::uint32_t>, kCalls> counted;  ///< by kind, in the scope
  std::atomic<std::uint32_t> together;                     ///< of the kinds that were asked for
  std::atomic<std::uint32_t> failures;
  std::atomic<std::int32_t> first_process;
  std::array<Failed, kMaxKept> kept;
};

enum class Scope { tree, process, children };

struct Settings {
  State* state = nullptr;
  unsigned calls = 0;
  std::uint32_t nth = 0;
  std::uint32_t times = 0;
  int error = 0;
  Scope scope = Scope::tree;
  std::array<char, 2048> below{};
};
Settings settings;
std::atomic<std::uint32_t> own_count = 0;

long number(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? 0 : std::strtol(text, nullptr, 10);
}

[[gnu::constructor]] void read_settings() {
  const char* file = std::getenv("FAULTS_STATE");
  if (file == nullptr) {
    return;
  }
  constexpr int kReadWrite = 2;
  const long opened = ::syscall(SYS_open, file, kReadWrite, 0);
  const long shared =
      ::syscall(SYS_mmap, nullptr, sizeof(State), PROT_READ | PROT_WRITE, MAP_SHARED, opened, 0L);
  ::syscall(SYS_close, opened);
  if (opened < 0 || shared == -1) {
    return;
  }
  settings.calls = unsigned(number("FAULTS_CALLS"));
  settings.nth = std::uint32_t(number("FAULTS_NTH"));
  settings.times = std::uint32_t(number("FAULTS_TIMES"));
  settings.error = int(number("FAULTS_ERROR"));
  const char* scope = std::getenv("FAULTS_SCOPE");
  settings.scope = scope == nullptr || std::strcmp(scope, "tree") == 0 ? Scope::tree
                   : std::strcmp(scope, "process") == 0                ? Scope::process
                                                                       : Scope::children;
  if (const char* below = std::getenv("FAULTS_BELOW")) {
    std::strncpy(settings.below.data(), below, settings.below.size() - 1);
  }
  settings.state = reinterpret_cast<State*>(shared);
  std::int32_t nobody = 0;
  settings.state->first_process.compare_exchange_strong(nobody,
                                                        std::int32_t(::syscall(SYS_getpid)));
}

/// What the link says, "" where it cannot be read.
void read_link(const char* link, Path& path) {
  const long length = ::syscall(SYS_readlink, link, path.data(), path.size() - 1);
  path[std::size_t(length < 0 ? 0 : length)] = '\0';
}

bool is_below(const char* path, const char* folder, std::size_t length) {
  return std::strncmp(path, folder, length) == 0 && (path[length] == '/' || path[length] == '\0');
}

bool is_meant(Call call, const char* path) {
  if (call == kFork || call == kMap || call == kDescriptor) {
    return true;
  }
  const char* folder = settings.below.data();
  if (*folder == '\0') {
    return std::strncmp(path, "/memfd:", 7) != 0 && !is_below(path, "/proc", 5) &&
           !is_below(path, "/sys", 4) && !is_below(path, "/dev", 4);
  }
  while (*folder != '\0') {
    const std::size_t length = std::strcspn(folder, ":");
    if (is_below(path, folder, length)) {
      return true;
    }
    folder += length + (folder[length] == ':' ? 1 : 0);
  }
  return false;
}

/// What shall become of this call: an errno, kHalf, or 0. Leaves errno as it is.
int fate(Call call, const char* path) {
  State* const state = settings.state;
  if (state == nullptr || !is_meant(call, path)) {
    return 0;
  }
  const auto process = std::int32_t(::syscall(SYS_getpid));
  if (settings.scope == Scope::children && process == state->first_process) {
    return 0;
  }
  ++state->counted[call];
  if ((settings.calls >> call & 1U) == 0) {
    return 0;
  }
  const std::uint32_t n =
      1 + (settings.scope == Scope::process ? own_count++ : state->together.fetch_add(1));
  if (settings.nth == 0 || n < settings.nth ||
      (settings.times != 0 && n >= settings.nth + settings.times)) {
    return 0;
  }
  if (const std::uint32_t at = state->failures.fetch_add(1); at < kMaxKept) {
    Failed& kept = state->kept[at];
    kept.call = call;
    kept.process = process;
    std::memcpy(kept.path.data(), path, std::min(std::strlen(path), kept.path.size() - 1));
  }
  if (settings.error == kKilled) {
    ::syscall(SYS_kill, process, SIGKILL);
  }
  return settings.error;
}
}  // namespace

Path path_of(long file) {
  Path path{};
  std::array<char, 64> link{};
  std::snprintf(link.data(), link.size(), "/proc/self/fd/%ld", file);
  read_link(link.data(), path);
  return path;
}

Path path_of(const char* name, long folder) {
  Path path{};
  if (name == nullptr) {
    return path;
  }
  if (name[0] != '/') {
    if (folder == kWorkingFolder) {
      read_link("/proc/self/cwd", path);
    } else {
      path = path_of(folder);
    }
    std::strncat(path.data(), "/", path.size() - 1 - std::strlen(path.data()));
  }
  std::strncat(path.data(), name, path.size() - 1 - std::strlen(path.data()));
  return path;
}

bool fails(Call call, const Path& path) {
  const int before = errno;
  const int error = fate(call, path.data());
  errno = error > 0 ? error : before;
  return error > 0;
}
std::size_t granted(Call call, long file, std::size_t asked) {
  constexpr int kMessages = 2;
  if (file == kMessages || settings.state == nullptr) {
    return asked;
  }
  const int before = errno;
  const int error = fate(call, path_of(file).data());
  errno = error > 0 ? error : before;
  return error > 0 ? 0 : error == kHalf && asked > 1 ? asked / 2 : asked;
}

void begin_own_count() { own_count = 0; }
}  // namespace faults
