// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace altiplan::host {

using Json = nlohmann::ordered_json;

// Json's own `parse` and `dump`, instantiated in one unit instead of in each that calls them, which
// takes 2 s a unit.

/// Throws Json::parse_error where the text is not JSON.
Json parse_json(std::string_view text);

/// The same, with a function that is called at each event and may drop values.
Json parse_json(std::istream& in, const Json::parser_callback_t& on_event);

/// `is_discarded()` where the text is not JSON.
Json json_or_discarded(std::string_view text);

/// On one line, or indented by so many spaces a level. U+FFFD replaces invalid bytes of UTF-8,
/// which texts of damaged plugins may hold.
std::string json_text(const Json& json, int indent = -1);

/// On one line. Throws Json::type_error at an invalid byte.
std::string exact_json_text(const Json& json);
}  // namespace altiplan::host
