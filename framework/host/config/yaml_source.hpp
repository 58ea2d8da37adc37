// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <yaml-cpp/mark.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "altiplan/error.hpp"

namespace altiplan::host {

// Limits of a document.
constexpr std::size_t kMaxDepth = 64;
constexpr std::size_t kMaxNodes = 1'000'000;

/// A text, and the locations in it.
class YamlSource {
 public:
  YamlSource(std::string_view text, std::string name, std::string override_text)
      : text_(text), name_(std::move(name)), override_text_(std::move(override_text)) {}

  std::string_view text() const { return text_; }

  /// `column_bytes` counts from 0 in bytes, `line` from 0; an override has no lines.
  Location at(std::size_t line, std::size_t line_start, std::size_t column_bytes) const;
  Location at(const YAML::Mark& mark) const;
  /// The text from the mark onward.
  std::string_view from(const YAML::Mark& mark) const {
    return text_.substr(std::min(text_.size(), static_cast<std::size_t>(mark.pos)));
  }
  /// The same, after an anchor ('&name').
  std::string_view value_from(const YAML::Mark& mark) const;
  /// "null", "~" … as written at the mark; "" if nothing is (the mark is then that of whatever
  /// follows).
  std::string null_word(const YAML::Mark& mark) const;

 private:
  /// The last position requested: positions mostly come in order, so a line is counted once.
  struct Column {
    std::size_t line_start = 0;
    std::size_t bytes = 0;
    int column = 1;
  };
  std::string_view text_;
  mutable Column last_;
  std::string name_;
  std::string override_text_;
};

inline bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\n' && c != '\r') || byte == 0x7F;
}

/// True if the quote at the start of the text, if any, is closed: yaml-cpp accepts the end of the
/// file as its end.
bool is_closed(std::string_view text);

/// Refuses, as ConfigError, characters and nesting that yaml-cpp would accept silently, misread or
/// choke on.
void scan_characters(const YamlSource& source);
}  // namespace altiplan::host
