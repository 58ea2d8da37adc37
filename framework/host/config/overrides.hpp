// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/value.hpp"

namespace altiplan::host {

enum class FileOfKey { pipeline, scenario };

/// `--set KEY=VALUE`, or `--set ~KEY`, which removes the key or the list's item.
struct SetText {
  std::string path;                  ///< in its file, without "scenario."
  std::optional<std::string> value;  ///< nothing: it is removed
  FileOfKey file = FileOfKey::pipeline;
};
/// Throws ConfigError for any other text.
SetText parse_set(const std::string& assignment);

/// Applies the values of `--set` to the file's tree. Keys that are missing are added, also the one
/// after a list's last item. Throws ConfigError naming the assignment.
void apply_overrides(Value& tree, const std::vector<std::string>& set, FileOfKey file);
}  // namespace altiplan::host
