// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace altiplan::formats {

/// Called with an item of a list that is a member of the document, and with the member's key.
using OnItem = std::function<void(const std::string& key, nlohmann::json& item)>;

/// Throws Error with line and column if the text is not JSON; `file` is for messages. Large files
/// take half the time if `on_item` empties each item as it is read.
nlohmann::json parse_json(const std::string& file, const std::string& text,
                          const OnItem& on_item = {});

/// Throws Error if the GeoJSON document says that its coordinates are not longitude and latitude of
/// WGS 84, as files from before RFC 7946 could.
void expect_wgs84(const nlohmann::json& document);

/// A value for messages, shortened.
std::string short_text(const nlohmann::json& value);

/// The line, from 1, that contains the byte at `offset`.
std::size_t line_at(const std::string& text, std::size_t offset);
}  // namespace altiplan::formats
