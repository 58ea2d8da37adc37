// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

// Numbers and texts as parameters are written and shown, for the sources of Fields.

namespace altiplan {

template <class T>
bool parse_whole(std::string_view text, T& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

/// "010" and "-01" have another value in other programs; from_chars does not accept YAML's "+1".
inline bool is_plain_number(std::string_view text) {
  if (!text.empty() && text[0] == '-') {
    text.remove_prefix(1);
  }
  return !text.empty() &&
         ((text[0] >= '1' && text[0] <= '9') || text[0] == '.' ||
          (text[0] == '0' && (text.size() == 1 || text[1] < '0' || text[1] > '9')));
}

inline std::string number_text(double number) {
  if (!std::isfinite(number)) {
    return "null";
  }
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, number);
  return {buffer, result.ptr};
}

inline std::string json_text(std::string_view text) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += "\\u00";
      out += kHex[c >> 4];
      out += kHex[c & 15];
    } else {
      out += c;
    }
  }
  return out + '"';
}
}  // namespace altiplan
