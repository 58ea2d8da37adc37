// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan::host {

/// True for lower-case letters, digits and '_', beginning with a letter: the form of plugin and
/// parameter names.
bool is_snake_case(std::string_view name);

/// Formats a number with `digits` significant digits.
std::string with_digits(double number, int digits);

/// Formats a number with `decimals` decimals: "-0.50".
std::string with_decimals(double number, int decimals);

/// Formats a number with at most `decimals` decimals, without trailing zeros: "0.5".
std::string rounded_text(double number, int decimals);

/// With a comma between groups of three digits: "-12,345.6".
std::string with_commas(std::string digits);

/// "1,234".
std::string grouped(std::size_t count);

/// To that many significant digits, a dash if not finite: "1,234", "0.0123", "1.2e-9".
std::string readable(double number, int digits = 4);

/// "1 pair", "2,000 pairs".
std::string counted(std::size_t count, std::string_view what);

/// "one, two and 3 more": so many names at most.
std::string listed(const std::vector<std::string>& names, std::size_t maximum);

/// "(12, 34, 56)", in whole metres, for messages.
std::string place(const Vec3& p);

/// Appends a full stop unless the text ends in a question mark.
std::string sentence(const std::string& text);

/// "95 %", "99.9 %".
std::string per_cent(double confidence);
}  // namespace altiplan::host
