// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace altiplan::host {

/// Bytes of the UTF-8 character at the front of `text`, which is not empty; 0 where none stands
/// there.
std::size_t utf8_length(std::string_view text);

/// What a plugin or a file says, for people, terminals, HTML and XML: valid UTF-8, with U+FFFD in
/// place of every byte that is none, and a blank in place of control characters (line ends and tabs
/// too, unless they are kept).
std::string printable(std::string_view bytes, bool keep_lines = false);
}  // namespace altiplan::host
