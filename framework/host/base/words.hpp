// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace altiplan::host {

/// The number in so many significant digits.
std::string with_digits(double number, int digits);

/// "1 pair", "2 pairs".
std::string counted(std::size_t count, std::string_view what);

/// The text with a full stop, unless it ends in a question.
std::string sentence(const std::string& text);

/// "95 %", "99.9 %".
std::string per_cent(double confidence);
}  // namespace altiplan::host
