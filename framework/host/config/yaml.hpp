// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "altiplan/value.hpp"

namespace altiplan::host {

/// The only entry point for YAML: a strict reader on yaml-cpp's event parser. Refuses, as
/// ConfigError with file:line:column: duplicate keys, anchors that refer to themselves, merge keys,
/// tags, a second document, null values, non-text keys, control characters, files over 16 MiB,
/// nesting over 64 levels, more than a million nodes (aliases counted as often as they are used).
/// Scalars stay text.
Value load_yaml(const std::filesystem::path& file);

/// The same from memory; `name` stands for the file in messages.
Value parse_yaml(std::string_view text, const std::string& name);

/// Parses a --set value: a YAML scalar, list or map on one line.
Value parse_override(std::string_view text, const std::string& assignment);
}  // namespace altiplan::host
