// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "host/base/utf8.hpp"
#include "host/config/yaml_source.hpp"

namespace altiplan::host {
namespace {

// yaml-cpp queues the tokens of a whole [...] or {...} (about 200 bytes each) before the first
// event shows how deep or how large it is. Unlike the depth and node caps, these two count
// characters of comments and text too, so they stay far above the caps.
constexpr std::ptrdiff_t kMaxOpenBrackets = 10'000;
constexpr std::size_t kMaxMarksInBrackets = 4 * kMaxNodes;

std::string hexadecimal(unsigned char byte) {
  constexpr const char* kDigits = "0123456789abcdef";
  return std::string("0x") + kDigits[byte >> 4] + kDigits[byte & 15];
}
}  // namespace

void scan_characters(const YamlSource& source) {
  const std::string_view text = source.text();
  std::size_t line = 0;
  std::size_t line_start = 0;
  std::size_t marks = 0;
  std::ptrdiff_t open = 0;
  const auto refuse = [&](std::size_t at, const std::string& message) {
    throw ConfigError(source.at(line, line_start, at - line_start), "", message);
  };
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    const std::size_t length = utf8_length(text.substr(i));
    if (length == 0) {
      refuse(i, "the byte " + hexadecimal(static_cast<unsigned char>(c)) +
                    " is not UTF-8 text: save the file as UTF-8");
    }
    if (is_control(c)) {
      refuse(i, "the control character " + hexadecimal(static_cast<unsigned char>(c)) +
                    " is not allowed in a text file");
    }
    if (i == line_start && c == '%') {
      refuse(i, "lines that start with '%' (YAML directives) are not supported: remove the line");
    }
    if (i == line_start && (c == ' ' || c == '\t')) {
      const std::string_view rest = text.substr(i);
      const std::string_view indent = rest.substr(0, rest.find_first_not_of(" \t"));
      const bool blank = indent.size() == rest.size() || rest[indent.size()] == '\n' ||
                         rest[indent.size()] == '\r';
      if (!blank && indent.find('\t') != indent.npos) {
        refuse(i + indent.find('\t'), "a tab indents this line: indent with spaces");
      }
    }
    open += c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
    open = std::max<std::ptrdiff_t>(open, 0);
    marks = open == 0 ? 0 : marks + (std::strchr(",:?\"'&*![{", c) != nullptr ? 1 : 0);
    if (open > kMaxOpenBrackets) {
      refuse(i, "nested more than " + std::to_string(kMaxDepth) + " levels deep");
    }
    if (marks > kMaxMarksInBrackets) {
      refuse(i, "more than " + std::to_string(kMaxNodes) + " values in one file");
    }
    i += length;
    if (c == '\n') {
      ++line;
      line_start = i;
    }
  }
}
}  // namespace altiplan::host
