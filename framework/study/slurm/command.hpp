// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace altiplan::study {

/// What a program said, and its exit code (128 and the signal that ended it).
struct CommandResult {
  int code = 0;
  std::string out;
  std::string err;
};

/// Runs a program, looked up in PATH, and waits for its end. Throws Error where it cannot be
/// started.
CommandResult run_command(std::vector<std::string> arguments);

/// Whether PATH has such a program.
bool has_command(const std::string& program);
}  // namespace altiplan::study
