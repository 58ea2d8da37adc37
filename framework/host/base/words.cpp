// SPDX-License-Identifier: Apache-2.0
#include "host/base/words.hpp"

#include <array>
#include <charconv>

namespace altiplan::host {

std::string with_digits(double number, int digits) {
  std::array<char, 64> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number,
                                 std::chars_format::general, digits);
  return {text.data(), end.ptr};
}

std::string counted(std::size_t count, std::string_view what) {
  return std::to_string(count) + " " + std::string(what) + (count == 1 ? "" : "s");
}

std::string sentence(const std::string& text) { return text + (text.ends_with('?') ? "" : "."); }

std::string per_cent(double confidence) { return with_digits(100 * confidence, 6) + " %"; }
}  // namespace altiplan::host
