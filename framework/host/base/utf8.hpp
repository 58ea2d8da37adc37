// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace altiplan::host {

/// Length in bytes of the UTF-8 character at the start of `text`, which is not empty; 0 if there is
/// none.
std::size_t utf8_length(std::string_view text);

/// Number of UTF-8 characters.
std::size_t characters(std::string_view text);

/// Text of a plugin or a file made safe for terminals, HTML and XML: valid UTF-8, with U+FFFD in
/// place of every invalid byte, and a blank in place of control characters (line ends and tabs too,
/// unless they are kept).
std::string printable(std::string_view bytes, bool keep_lines = false);
}  // namespace altiplan::host
