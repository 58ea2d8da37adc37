// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace altiplan::cli {

/// Records the system calls by which the calling thread, and threads and processes that it starts,
/// would change a file, and lets them pass: a seccomp filter, which stays until the process ends.
/// One per process, never destroyed.
class FileWatch {
 public:
  /// Changes below `scratch` and to devices are not recorded.
  explicit FileWatch(std::filesystem::path scratch);
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

  /// True if the system allows the filter.
  bool works() const { return works_; }
  /// "opens /home/me/log for writing": the first few, in order, each once.
  std::vector<std::string> written() const;

 private:
  void serve(int listener);
  void note(const std::string& what);

  std::filesystem::path scratch_;
  bool works_ = false;
  mutable std::mutex mutex_;
  std::vector<std::string> written_;
};
}  // namespace altiplan::cli
