// SPDX-License-Identifier: Apache-2.0
#include "host/base/utf8.hpp"

#include <algorithm>

namespace altiplan::host {
namespace {

/// Line and paragraph separators, C1 controls, and bidirectional controls; and the two
/// noncharacters at the end of the first plane that XML excludes.
bool hidden_control(std::string_view character) {
  if (character.size() == 2 && character[0] == '\xC2') {
    return static_cast<unsigned char>(character[1]) < 0xA0;
  }
  if (character.size() == 3 && character.substr(0, 2) == "\xE2\x80") {
    const auto last = static_cast<unsigned char>(character[2]);
    return last >= 0xA8 && last <= 0xAE;
  }
  if (character.size() == 3 && character.substr(0, 2) == "\xE2\x81") {
    const auto last = static_cast<unsigned char>(character[2]);
    return last >= 0xA6 && last <= 0xA9;
  }
  return character == "\xEF\xBF\xBE" || character == "\xEF\xBF\xBF";
}
}  // namespace

std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) {
    return 1;
  }
  const std::size_t length = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC2 || byte(0) > 0xF4 || text.size() < length) {
    return 0;
  }
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) {
      return 0;
    }
  }
  const bool overlong = (byte(0) == 0xE0 && byte(1) < 0xA0) || (byte(0) == 0xF0 && byte(1) < 0x90);
  const bool surrogate = byte(0) == 0xED && byte(1) > 0x9F;
  const bool too_large = byte(0) == 0xF4 && byte(1) > 0x8F;
  return overlong || surrogate || too_large ? 0 : length;
}

std::size_t characters(std::string_view text) {
  return std::size_t(
      std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xC0) != 0x80; }));
}

std::string printable(std::string_view bytes, bool keep_lines) {
  std::string out;
  out.reserve(bytes.size());
  while (!bytes.empty()) {
    const std::size_t length = utf8_length(bytes);
    const std::string_view character = bytes.substr(0, std::max<std::size_t>(length, 1));
    const auto letter = static_cast<unsigned char>(character[0]);
    if (length == 0) {
      out += "\xEF\xBF\xBD";
    } else if (letter < ' ' || letter == 0x7F) {
      out += keep_lines && (letter == '\n' || letter == '\t') ? character[0] : ' ';
    } else if (hidden_control(character)) {
      out += ' ';
    } else {
      out += character;
    }
    bytes.remove_prefix(character.size());
  }
  return out;
}
}  // namespace altiplan::host
