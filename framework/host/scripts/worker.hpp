// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/base/json.hpp"
#include "host/base/program.hpp"

namespace altiplan::host {

/// A message between this program and a process that runs a file of Python.
struct ScriptMessage {
  Json head;
  std::vector<double> numbers;
};

/// A process that runs a file of Python, in a group of its own, ended with this object. Its output
/// goes to the standard error of this program.
class ScriptWorker {
 public:
  using Clock = Program::Clock;

  /// Starts it, and runs the file. Throws PluginError if it cannot, or the file fails.
  explicit ScriptWorker(const std::filesystem::path& file);
  ~ScriptWorker();
  ScriptWorker(const ScriptWorker&) = delete;
  ScriptWorker& operator=(const ScriptWorker&) = delete;

  /// What the file offers: a list of plugins with their parameters.
  const Json& plugins() const { return plugins_; }
  /// Throws PluginError if it has ended.
  void send(const Json& head, std::span<const double> numbers = {});
  /// The next message, or none until then. Throws PluginError if the process has ended, sends what
  /// is no message, or tells an exception.
  std::optional<ScriptMessage> receive(Clock::time_point until);
  /// The answer to a message; PluginError after a while.
  ScriptMessage answer_to(const Json& head);
  /// Memory of the process, MiB; 0 if unknown.
  double memory_mb() const;

 private:
  std::optional<ScriptMessage> taken();
  [[noreturn]] void fail_as_ended() const;

  std::filesystem::path file_;
  Program program_;
  std::string received_;
  Json plugins_;
  int process_ = 0;
};
}  // namespace altiplan::host
