// SPDX-License-Identifier: Apache-2.0
#include "study/claims/claim_reader.hpp"

#include <algorithm>
#include <charconv>

#include "altiplan/error.hpp"

namespace altiplan::study {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_in_word(char c) {
  return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
}  // namespace

void ClaimReader::skip_spaces() {
  while (at_ < text_.size() && is_space(text_[at_])) {
    ++at_;
  }
}

bool ClaimReader::takes(std::string_view sign) {
  skip_spaces();
  if (!rest().starts_with(sign)) {
    return false;
  }
  skip(sign.size());
  return true;
}

bool ClaimReader::takes_word(std::string_view word) {
  skip_spaces();
  return peek_word() == word && takes(word);
}

std::string_view ClaimReader::peek_word() const {
  const std::string_view text = rest();
  const auto end = std::find_if_not(text.begin(), text.end(), is_in_word);
  return text.substr(0, std::size_t(end - text.begin()));
}

std::optional<double> ClaimReader::takes_number() {
  skip_spaces();
  const std::string_view digits = rest().substr(0, rest().find(".."));  // FROM of FROM..TO
  if (digits.empty() || !(is_digit(digits[0]) || digits[0] == '.')) {
    return std::nullopt;  // "inf" and "nan" too
  }
  double number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc()) {
    return std::nullopt;
  }
  skip(std::size_t(end - digits.data()));
  return number;
}

void ClaimReader::expected(const std::string& what, const std::string& hint) {
  skip_spaces();
  fail(at_,
       "expected " + what + ", found " + (rest().empty() ? "the end" : excerpt(rest())) + hint);
}

void ClaimReader::fail(std::size_t at, const std::string& message) {
  throw Error("at character " + std::to_string(at + 1) + ": " + message);
}
}  // namespace altiplan::study
