// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cfenv>
#include <chrono>
#include <clocale>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "altiplan/constraint.hpp"
#include "altiplan/environment.hpp"
#include "altiplan/local_planner.hpp"
#include "altiplan/objective.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin.hpp"
#include "altiplan/smoother.hpp"
#include "altiplan/task.hpp"
#include "altiplan/tuner.hpp"

/// What code may do to its process, whatever it is there for; each a function that a plugin broken
/// on purpose calls in the midst of its work.
namespace altiplan::bad {

using Does = void (*)();

inline void does_nothing() {}

inline void changes_locale() { std::setlocale(LC_ALL, "C.UTF-8"); }
inline void changes_folder() { (void)!::chdir("/"); }
inline void changes_rounding() { std::fesetround(FE_UPWARD); }
inline void takes_signal() { ::signal(SIGSEGV, SIG_IGN); }
inline void sets_variable() { ::setenv("ALTIPLAN_BAD_PLUGIN", "was here", 1); }
inline void leaves_file_open() { (void)::open("/dev/null", O_RDONLY); }
inline void leaves_thread() {
  std::thread([] {
    while (true) {
      std::this_thread::sleep_for(std::chrono::seconds(1));
    }
  }).detach();
}

inline void prints() { std::puts("so far, so good"); }

inline void keeps_file(const char* folder) {
  std::ofstream(std::string(folder) + "/altiplan_bad_plugin.log") << "so far, so good";
}
inline void writes_file() { keeps_file(std::getenv("HOME")); }
inline void makes_folder() {
  ::mkdir((std::string(std::getenv("HOME")) + "/altiplan_bad_plugin").c_str(), 0700);
}
inline void writes_by_process() {
  const pid_t child = ::fork();
  if (child == 0) {
    writes_file();
    ::_exit(0);
  }
  while (::waitpid(child, nullptr, 0) < 0) {
  }
}
inline void writes_scratch_file() { keeps_file(std::getenv("TMPDIR")); }

inline void leaks() {
  static thread_local std::vector<void*> kept;  // a race would be another fault
  kept.push_back(std::calloc(1, 5000));
}

[[noreturn]] inline void never_returns() {
  for (std::atomic<int> turns = 0;; ++turns) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}
[[noreturn]] inline void hoards() {
  std::vector<std::vector<char>> all;
  while (true) {
    all.emplace_back(16 << 20, 'x');
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}
inline void crashes() { ::raise(SIGSEGV); }
inline void throws() { throw std::runtime_error("the attic is on fire"); }
inline void leaves_process() {
  if (::fork() == 0) {
    ::setsid();
    never_returns();
  }
}
/// Other in each process, the same throughout one.
inline double by_address() {
  static const int kHere = 0;
  return 1e-18 * double(reinterpret_cast<std::uintptr_t>(&kHere));
}
inline double by_time() {
  static const auto kBegan = std::chrono::steady_clock::now().time_since_epoch().count();
  return 1e-18 * double(kBegan % 1'000'000'007);
}
inline double by_memory() {
  static const double kFound = [] {
    std::vector<char>* volatile hidden = new std::vector<char>(64);
    volatile const char* volatile data = static_cast<char*>(std::malloc(512));
    delete hidden;
    return 1e-9 * data[300];
  }();
  return kFound;
}
}  // namespace altiplan::bad
