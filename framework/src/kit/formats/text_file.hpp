// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace altiplan::kit {

/// Throws Error with the line if the text is not JSON; `file` is for messages.
nlohmann::json parse_json(const std::string& file, const std::string& text);

/// A value for messages, shortened.
std::string short_text(const nlohmann::json& value);

/// The line, from 1, that contains the byte at `offset`.
std::size_t line_at(const std::string& text, std::size_t offset);
}  // namespace altiplan::kit
