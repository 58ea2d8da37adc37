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

/// A folder in TMPDIR that goes with all that is in it.
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

/// A test under way: its process, in a session and a scratch folder of its own. It ends with the
/// object.
class TestProcess {
 public:
  /// `mark` tells its processes from those of other tests; `again` is for the second of two whose
  /// answers must be equal. Throws Error where none can be made.
  TestProcess(const PluginTest& test, std::size_t index, std::uint64_t mark, bool again,
              const RunnerOptions& options);
  ~TestProcess() { end(); }
  TestProcess(const TestProcess&) = delete;
  TestProcess& operator=(const TestProcess&) = delete;

  std::size_t index() const { return index_; }
  bool again() const { return again_; }

  /// What is wrong once it has ended, or has used more than it may; nullopt while neither is so.
  std::optional<Verdict> look(const RunnerOptions& options);
  /// Of a test of two processes that has passed.
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
