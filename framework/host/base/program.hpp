// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/unfinished.hpp"

namespace altiplan::host {

/// True if the file can be executed.
bool is_program(const std::filesystem::path& file);
/// The first of these programs on the PATH; an empty entry, the current folder, is not searched.
std::optional<std::filesystem::path> find_on_path(std::initializer_list<const char*> names);

/// A temporary folder, removed with this object or by an interruption.
class TemporaryFolder {
 public:
  TemporaryFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::optional<Unfinished> unfinished_;
};

/// The surroundings of a program.
struct ProgramFiles {
  std::vector<int> wired{};                    ///< descriptors at which it talks to this one
  std::filesystem::path errors = "/dev/null";  ///< receives its standard error; "": that of this
                                               ///< program receives both, output and error
  std::filesystem::path temporary{};           ///< its TMPDIR, "" for that of this program
};

/// A program running beside this one, and all that it starts, ended with this object or by an
/// interruption. Its standard input and output are discarded unless they are wired.
class Program {
 public:
  using Clock = std::chrono::steady_clock;

  /// Throws Error if it cannot be started.
  explicit Program(std::vector<std::string> arguments, const ProgramFiles& files = {});
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// False if it has ended, or does not read until then.
  bool send(std::string_view bytes, Clock::time_point until);
  /// Nothing more will be sent.
  void finish_sending();
  /// Appends what it sends; false if it has ended, or sends nothing until then.
  bool receive(std::string& to, Clock::time_point until);
  /// Its exit code, -1 if a signal ended it; nothing if it still runs then.
  std::optional<int> ended(Clock::time_point until) const;

 private:
  pid_t pid_ = -1;
  int socket_ = -1;
  std::optional<Unfinished> unfinished_;
};
}  // namespace altiplan::host
