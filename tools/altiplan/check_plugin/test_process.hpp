// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runner.hpp"

namespace altiplan::cli {

/// A folder in TMPDIR, removed with its contents on destruction.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A running test: its process, in its own session and scratch folder. The process is killed on
/// destruction.
class TestProcess {
 public:
  /// `mark` distinguishes its processes from those of other tests; `again` marks the second of two
  /// whose answers must be equal. Throws Error if no process can be started.
  TestProcess(const PluginTest& test, std::size_t index, std::uint64_t mark, bool again,
              const RunnerOptions& options);
  ~TestProcess() { end(); }
  TestProcess(const TestProcess&) = delete;
  TestProcess& operator=(const TestProcess&) = delete;

  std::size_t index() const { return index_; }
  bool again() const { return again_; }

  /// The verdict once the process has ended or exceeded a limit; nullopt while it runs.
  std::optional<Verdict> look(const RunnerOptions& options);
  /// The answers of a passed test in two processes.
  const std::string& answers() const { return answers_; }

 private:
  [[noreturn]] void become(char* const* arguments) const;
  void end();
  Verdict verdict_of(int status);

  ScratchFolder scratch_;
  std::size_t index_;
  std::uint64_t mark_;
  bool again_;
  pid_t process_ = 0;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  double peak_mb_ = 0;
  std::string answers_;
};
}  // namespace altiplan::cli
