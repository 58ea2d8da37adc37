// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/config/overrides.hpp"

namespace altiplan::host {

/// The text of a YAML file with the assignments of `--set` written in their places: comments, order
/// and everything else stay, byte for byte. A missing key is added to its map, as the last one.
/// `name` stands for the file in messages. Throws ConfigError as apply_overrides does, and where
/// the text cannot be changed without changing something else (an alias, a text of several lines).
std::string with_assignments(std::string text, const std::string& name,
                             const std::vector<std::string>& set, FileOfKey file);

/// The value at a dotted path; null if there is none.
const Value* value_at(const Value& tree, const std::string& path);

/// True if two trees mean the same: their kinds, texts, keys and order; not where they stand.
bool same_values(const Value& a, const Value& b);
}  // namespace altiplan::host
