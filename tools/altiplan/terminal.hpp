// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace altiplan::cli {

/// Columns of the terminal behind a descriptor; 0 if it is none, or does not say.
std::size_t terminal_columns(int descriptor);

enum class Color { none, good, bad, open, strong };

/// The text in a colour where the stream is a terminal and NO_COLOR is not set.
std::string painted(std::FILE* to, Color color, const std::string& text);
/// Of a status or a verdict: "accepted" is good, "undecided" open, "failed" bad.
Color color_of(const std::string& status);
}  // namespace altiplan::cli
