// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace altiplan::study {

/// A program's output and its exit code (128 plus the signal that ended it).
struct CommandResult {
  int code = 0;
  std::string out;
  std::string err;
};

/// Runs a program from PATH and waits for its end. Throws Error if it cannot be started.
CommandResult run_command(std::vector<std::string> arguments);
}  // namespace altiplan::study
