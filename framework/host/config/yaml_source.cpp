// SPDX-License-Identifier: Apache-2.0
#include "host/config/yaml_source.hpp"

#include <cstring>

namespace altiplan::host {

Location YamlSource::at(std::size_t line, std::size_t line_start, std::size_t column_bytes) const {
  if (!override_text_.empty()) {
    return {"", 0, 0, override_text_};
  }
  if (line_start != last_.line_start || column_bytes < last_.bytes) {
    last_ = {line_start, 0, 1};
  }
  for (; last_.bytes < column_bytes && line_start + last_.bytes < text_.size(); ++last_.bytes) {
    const auto byte = static_cast<unsigned char>(text_[line_start + last_.bytes]);
    last_.column += (byte & 0xC0) != 0x80 ? 1 : 0;
  }
  return {name_, static_cast<int>(line) + 1, last_.column, ""};
}

Location YamlSource::at(const YAML::Mark& mark) const {
  if (mark.is_null()) {
    return override_text_.empty() ? Location{name_, 0, 0, ""} : Location{"", 0, 0, override_text_};
  }
  const auto column = static_cast<std::size_t>(mark.column);
  return at(static_cast<std::size_t>(mark.line), static_cast<std::size_t>(mark.pos) - column,
            column);
}

std::string_view YamlSource::value_from(const YAML::Mark& mark) const {
  std::string_view text = from(mark);
  if (!text.empty() && text.front() == '&') {
    text.remove_prefix(std::min(text.size(), text.find_first_of(" \t\r\n")));
    text.remove_prefix(std::min(text.size(), text.find_first_not_of(" \t\r\n")));
  }
  return text;
}

std::string YamlSource::null_word(const YAML::Mark& mark) const {
  const std::string_view text = from(mark);
  for (const std::string_view word : {"~", "null", "Null", "NULL"}) {
    if (text.substr(0, word.size()) == word &&
        (text.size() == word.size() || std::strchr(" \t\r\n,]}#", text[word.size()]) != nullptr)) {
      return std::string(word);
    }
  }
  return "";
}

bool is_closed(std::string_view text) {
  const char quote = text.empty() ? '\0' : text.front();
  if (quote != '"' && quote != '\'') {
    return true;
  }
  std::size_t i = 1;
  for (; i < text.size(); ++i) {
    const bool doubled = quote == '\'' && text.substr(i, 2) == "''";
    if (doubled || (quote == '"' && text[i] == '\\')) {
      ++i;
    } else if (text[i] == quote) {
      break;
    }
  }
  return i < text.size();
}
}  // namespace altiplan::host
