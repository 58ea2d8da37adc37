// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "altiplan/value.hpp"

namespace altiplan::host {

enum class FileOfKey { pipeline, scenario };

/// Applies the values of `--set KEY=VALUE` to the file's tree, adding keys that are missing; keys
/// that begin with "scenario." are the scenario's. Throws ConfigError naming the assignment.
void apply_overrides(Value& tree, const std::vector<std::string>& set, FileOfKey file);
}  // namespace altiplan::host
