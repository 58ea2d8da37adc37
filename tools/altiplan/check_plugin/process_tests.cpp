// SPDX-License-Identifier: Apache-2.0
#include <dirent.h>
#include <malloc.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <set>

#include "file_watch.hpp"
#include "host/run/process_guard.hpp"
#include "plugin_test.hpp"

namespace altiplan::cli {
namespace {

using conformance::answers_of;

constexpr const char* kLeaves =
    "Process: locale, working folder, signal handlers, floating-point mode, environment, open "
    "files and threads are unchanged";
constexpr const char* kStdout = "Process: nothing is written to stdout";
constexpr const char* kFiles = "Process: nothing is written outside the scratch folder (TMPDIR)";
constexpr const char* kMemory = "Process: memory is released";

std::size_t entries_in(const char* folder) {
  std::size_t count = 0;
  if (DIR* open = ::opendir(folder)) {
    while (::readdir(open) != nullptr) {
      ++count;
    }
    ::closedir(open);
  }
  return count;
}

mode_t file_mask() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return mask;
}

std::multiset<std::string> environment_variables() {
  std::multiset<std::string> all;
  for (char** one = environ; *one != nullptr; ++one) {
    all.insert(*one);
  }
  return all;
}

/// A used library may keep a file open and a thread pool may fill up once: only growth in every
/// further use is a leak.
Outcome leaves_the_process(const LoadPlugin& load, const MakeSetup& make_setup) {
  const conformance::Setup setup = make_setup();
  host::ProcessGuard guard;
  const auto variables = environment_variables();
  const mode_t mask = file_mask();
  const PluginEntry& entry = load();
  std::size_t files = 0;
  std::size_t threads = 0;
  std::size_t more_files = ~std::size_t(0);
  std::size_t more_threads = ~std::size_t(0);
  for (int round = 0; round < 6; ++round) {
    (void)answers_of(entry, setup);
    const std::size_t files_now = entries_in("/proc/self/fd");
    const std::size_t threads_now = entries_in("/proc/self/task");
    if (round > 0) {
      more_files = std::min(more_files, files_now - std::min(files, files_now));
      more_threads = std::min(more_threads, threads_now - std::min(threads, threads_now));
    }
    files = files_now;
    threads = threads_now;
  }
  Outcome outcome;
  const auto expect = [&](bool kept, const std::string& what) {
    if (!kept) {
      outcome.findings.push_back({kLeaves, what});
    }
  };
  const std::string changed = guard.restore();
  expect(changed.empty(), "it changed " + changed);
  expect(environment_variables() == variables, "it changed an environment variable");
  expect(file_mask() == mask, "it changed the file mode creation mask (umask)");
  expect(more_files == 0,
         "it leaves " + std::to_string(more_files) + " more open files behind each time");
  expect(more_threads == 0,
         "it leaves " + std::to_string(more_threads) + " more threads behind each time");
  return outcome;
}

Outcome writes_nothing_to_stdout(const LoadPlugin& load, const MakeSetup& make_setup) {
  const conformance::Setup setup = make_setup();
  host::ProcessGuard guard;
  (void)answers_of(load(), setup);
  guard.restore();
  if (guard.pass_on_output()) {
    return {{{kStdout, "it wrote to stdout, which is reserved for the result"}}, "", false, ""};
  }
  return {};
}

Outcome writes_no_files(const LoadPlugin& load, const MakeSetup& make_setup) {
  const conformance::Setup setup = make_setup();
  static FileWatch& watch = *new FileWatch(std::filesystem::temp_directory_path());  // to the end
  if (!watch.works()) {
    return {{},
            "the system does not allow a process to watch its own system calls (seccomp), or this "
            "altiplan is built with sanitizers",
            false,
            ""};
  }
  (void)answers_of(load(), setup);
  Outcome outcome;
  for (const std::string& file : watch.written()) {
    outcome.findings.push_back({kFiles, "it " + file});
  }
  return outcome;
}

std::size_t memory_in_use() {
  const struct mallinfo2 info = ::mallinfo2();
  return info.uordblks + info.hblkhd;
}

/// Caches may fill in the first rounds; growth in each of the later ones is a leak.
Outcome memory_is_given_back(const LoadPlugin& load, const MakeSetup& make_setup) {
  constexpr int kRounds = 12;
  constexpr std::size_t kMax = 4096;
  const conformance::Setup setup = make_setup();
  const PluginEntry& entry = load();
  std::size_t min_growth = ~std::size_t(0);
  std::size_t before = 0;
  for (int round = 0; round < kRounds; ++round) {
    (void)answers_of(entry, setup);
    const std::size_t now = memory_in_use();
    if (round >= kRounds / 2) {
      min_growth = std::min(min_growth, now > before ? now - before : 0);
    }
    before = now;
  }
  if (min_growth > kMax) {
    return {{{kMemory, "each repetition of the same work takes " + std::to_string(min_growth) +
                           " more bytes"}},
            "",
            false,
            ""};
  }
  return {};
}
}  // namespace

std::vector<PluginTest> process_tests(const std::string& prefix, const LoadPlugin& load,
                                      const MakeSetup& setup) {
  const auto bound = [&](Outcome (*test)(const LoadPlugin&, const MakeSetup&)) {
    return [load, setup, test] { return test(load, setup); };
  };
  std::vector<PluginTest> all{
      {prefix + "leaves_the_process_as_it_was", bound(leaves_the_process)},
      {prefix + "writes_nothing_to_stdout", bound(writes_nothing_to_stdout)},
      {prefix + "writes_no_files", bound(writes_no_files)},
      {prefix + "memory_is_given_back", bound(memory_is_given_back)},
      {prefix + "same_answers_in_two_processes", [load, setup] {
         return Outcome{{}, "", false, answers_of(load(), setup())};
       }}};
  all.back().in_two_processes = true;
  return all;
}
}  // namespace altiplan::cli
