// SPDX-License-Identifier: Apache-2.0
#include "study/claims/claim_text.hpp"

#include "altiplan/error.hpp"
#include "host/config/config_check.hpp"
#include "study/claims/claim_reader.hpp"

namespace altiplan::study {
namespace {

/// p01 to p99.
bool is_percentile(std::string_view word) {
  return word.size() == 3 && word[0] == 'p' && word != "p00" &&
         word.find_first_not_of("0123456789", 1) == word.npos;
}

/// Reads the function's name.
void read_function(ClaimReader& reader, ClaimQuantity& quantity) {
  using Function = ClaimQuantity::Function;
  reader.skip_spaces();
  const std::string word(reader.peek_word());
  const std::vector<std::string> names{"median", "mean", "min", "max", "share"};
  if (is_percentile(word)) {
    quantity.q = ((word[1] - '0') * 10 + (word[2] - '0')) / 100.0;
  } else if (word == "mean") {
    quantity.function = Function::mean;
  } else if (word == "min") {
    quantity.function = Function::min;
  } else if (word == "max") {
    quantity.function = Function::max;
  } else if (word == "share") {
    quantity.function = Function::share;
  } else if (word != "median") {
    reader.expected("median(, mean(, min(, max(, share( or one of p01( to p99(",
                    host::did_you_mean(word, names));
  }
  reader.skip(word.size());
  if (!reader.takes("(")) {
    reader.expected("'(' after " + word);
  }
}

/// A number with its sign.
double read_number(ClaimReader& reader, const std::string& expected = "a number") {
  const bool is_negative = reader.takes("-");
  const std::optional<double> number = reader.takes_number();
  if (!number) {
    reader.expected(expected);
  }
  return is_negative ? -*number : *number;
}

void expect_end(ClaimReader& reader, const std::string& after) {
  reader.skip_spaces();
  if (!reader.rest().empty()) {
    reader.expected("nothing after " + after);
  }
}

void expect_short(const std::string& text) {
  constexpr std::size_t kLongest = 4000;
  if (text.size() > kLongest) {
    ClaimReader::fail(kLongest, "longer than " + std::to_string(kLongest) + " characters");
  }
}
}  // namespace

ClaimQuantity read_quantity(const std::string& text, const std::vector<std::string>& pipelines) {
  expect_short(text);
  ClaimQuantity quantity;
  ClaimReader reader(text);
  read_function(reader, quantity);
  const ClaimExpression& read = quantity.expression = read_expression(reader, pipelines, quantity);
  if (!reader.takes(")")) {
    reader.expected("an operator or ')'");
  }
  expect_end(reader, "the function's ')'");
  if (quantity.function == ClaimQuantity::Function::share) {
    expect_logical(read, quantity);
  } else if (read.is_logical()) {
    ClaimReader::fail(read.at, "a comparison is for share(); the other functions take a number");
  }
  if (quantity.values.empty()) {
    ClaimReader::fail(read.at, "expected a PIPELINE.value somewhere, found numbers only");
  }
  return quantity;
}

ClaimQuantity read_objective(const std::string& text) {
  expect_short(text);
  ClaimQuantity quantity;
  quantity.function = ClaimQuantity::Function::mean;
  ClaimReader reader(text);
  quantity.expression = read_expression(reader, {}, quantity);
  expect_end(reader, "the expression");
  if (quantity.expression.is_logical()) {
    ClaimReader::fail(quantity.expression.at, "expected a number, found a comparison");
  }
  if (quantity.values.empty()) {
    ClaimReader::fail(0, "expected a value of a run somewhere, found numbers only");
  }
  return quantity;
}

ClaimRange read_range(const std::string& text) {
  ClaimRange range;
  ClaimReader reader(text);
  if (reader.takes("<=")) {
    range.high = read_number(reader);
  } else if (reader.takes(">=")) {
    range.low = read_number(reader);
  } else if (reader.takes("==")) {
    range.low = range.high = read_number(reader);
  } else if (reader.takes("<")) {
    range.high = read_number(reader);
    range.high_counts = false;
  } else if (reader.takes(">")) {
    range.low = read_number(reader);
    range.low_counts = false;
  } else {
    range.low = read_number(reader, "<=, <, >=, > or == before a number, or FROM..TO");
    if (!reader.takes("..")) {
      reader.expected("'..' and a number (as in 0.9..1.1), or <=, <, >=, > or == before the first");
    }
    range.high = read_number(reader);
    if (range.low > range.high) {
      ClaimReader::fail(0, "expected FROM..TO with FROM at most TO, found " + excerpt(text));
    }
  }
  expect_end(reader, "the comparison");
  return range;
}
}  // namespace altiplan::study
