// SPDX-License-Identifier: Apache-2.0
#include "host/base/words.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace altiplan::host {

bool is_snake_case(std::string_view name) {
  const auto small = [](char c) { return c >= 'a' && c <= 'z'; };
  return !name.empty() && small(name[0]) && std::all_of(name.begin(), name.end(), [&](char c) {
    return small(c) || (c >= '0' && c <= '9') || c == '_';
  });
}

std::string with_digits(double number, int digits) {
  std::array<char, 64> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number,
                                 std::chars_format::general, digits);
  return {text.data(), end.ptr};
}

std::string with_decimals(double number, int decimals) {
  std::array<char, 400> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number,
                                 std::chars_format::fixed, decimals);
  return {text.data(), end.ptr};
}

std::string rounded_text(double number, int decimals) {
  std::string result = with_decimals(number, decimals);
  if (result.find('.') != std::string::npos) {
    result.erase(result.find_last_not_of('0') + 1);
    if (result.back() == '.') {
      result.pop_back();
    }
  }
  return result == "-0" ? "0" : result;
}

std::string listed(const std::vector<std::string>& names, std::size_t maximum) {
  std::string text;
  for (std::size_t n = 0; n < std::min(names.size(), maximum); ++n) {
    text += (n > 0 ? ", " : "") + names[n];
  }
  const bool are_more = names.size() > maximum;
  return are_more ? text + " and " + std::to_string(names.size() - maximum) + " more" : text;
}

std::string with_commas(std::string digits) {
  const std::size_t end = std::min(digits.find('.'), digits.size());
  const std::size_t first = digits[0] == '-' ? 1 : 0;
  for (std::size_t at = end; at > first + 3;) {
    at -= 3;
    digits.insert(at, ",");
  }
  return digits;
}

std::string grouped(std::size_t count) { return with_commas(std::to_string(count)); }

std::string readable(double number, int digits) {
  if (!std::isfinite(number)) {
    return "–";
  }
  if (number == 0) {
    return "0";
  }
  // The power of ten after rounding: 9.9999 is 10.0 in three digits.
  std::array<char, 64> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number,
                                 std::chars_format::scientific, digits - 1);
  const std::string scientific(text.data(), end.ptr);
  const int power = std::stoi(scientific.substr(scientific.find('e') + 1));
  if (power < -4 || power >= 9) {
    return scientific;
  }
  std::string plain = with_decimals(number, std::max(0, digits - 1 - power));
  if (number == std::round(number) && plain.find('.') != std::string::npos) {
    plain.resize(plain.find('.'));  // counts are written as counts
  }
  return with_commas(plain);
}

std::string counted(std::size_t count, std::string_view what) {
  return grouped(count) + " " + std::string(what) + (count == 1 ? "" : "s");
}

std::string place(const Vec3& p) {
  return "(" + with_decimals(p.x(), 0) + ", " + with_decimals(p.y(), 0) + ", " +
         with_decimals(p.z(), 0) + ")";
}

std::string sentence(const std::string& text) { return text + (text.ends_with('?') ? "" : "."); }

std::string per_cent(double confidence) { return with_digits(100 * confidence, 6) + " %"; }
}  // namespace altiplan::host
