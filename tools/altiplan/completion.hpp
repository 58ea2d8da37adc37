// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "command_line.hpp"

namespace altiplan::cli {

/// A script that completes commands, options and their words in bash, zsh or fish.
std::string completion(const std::string& shell, const std::vector<CommandText>& all);

/// The manual page, in roff, of a command or of the program ("altiplan").
std::string manual_page(const std::string& command, const std::vector<CommandText>& all);
}  // namespace altiplan::cli
