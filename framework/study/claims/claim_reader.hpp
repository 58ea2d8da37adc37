// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/claims/claim_text.hpp"

namespace altiplan::study {

/// The text of a claim, read from left to right.
class ClaimReader {
 public:
  explicit ClaimReader(std::string_view text) : text_(text) {}

  std::size_t at() const { return at_; }
  std::string_view rest() const { return text_.substr(at_); }
  void skip(std::size_t characters) { at_ += characters; }
  void skip_spaces();
  /// True if the sign comes next; consumes it.
  bool takes(std::string_view sign);
  /// Likewise for a whole word.
  bool takes_word(std::string_view word);
  /// Reads the letters, digits and '_' that come next.
  std::string_view peek_word() const;
  /// Reads a number without sign, if one comes next.
  std::optional<double> takes_number();

  /// Throws an Error with what was expected here and what was found.
  [[noreturn]] void expected(const std::string& what, const std::string& hint = "");
  /// Throws an Error with the message for position `at` (from 0).
  [[noreturn]] static void fail(std::size_t at, const std::string& message);

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

/// Reads an expression and adds the values that it names to the quantity; without pipelines,
/// values are named alone.
ClaimExpression read_expression(ClaimReader& reader, const std::vector<std::string>& pipelines,
                                ClaimQuantity& quantity);
/// Throws unless it is a comparison, several of them, or a value that is always 0 or 1.
void expect_logical(const ClaimExpression& expression, const ClaimQuantity& quantity);
}  // namespace altiplan::study
