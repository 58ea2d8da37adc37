// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace altiplan::study {

/// A value of the runs of a pipeline, as a claim names it.
struct ClaimValue {
  std::size_t pipeline = 0;  ///< index into the names given to read_quantity
  std::string name;          ///< "flight.length_m"
  bool operator==(const ClaimValue&) const = default;
};

/// An expression: a number, a value, or an operator and what it applies to.
struct ClaimExpression {
  enum class Kind {
    number,
    value,
    negate,
    add,
    subtract,
    multiply,
    divide,
    less,
    less_or_equal,
    greater,
    greater_or_equal,
    equal,
    both,
    either
  };
  Kind kind = Kind::number;
  double number = 0;
  std::size_t value = 0;  ///< index into ClaimQuantity::values
  std::size_t at = 0;     ///< where it begins in the text, from 0
  std::vector<ClaimExpression> operands;

  /// Whether it is true or false (1 or 0) rather than a number.
  bool is_logical() const { return kind >= Kind::less; }
};

/// What a claim is about: `that`, read.
struct ClaimQuantity {
  enum class Function { quantile, mean, min, max, share };
  Function function = Function::quantile;
  double q = 0.5;  ///< of quantile: 0.5 for median(), 0.95 for p95()
  ClaimExpression expression;
  std::vector<ClaimValue> values;  ///< those named, each once, in the order of the text
};

/// What it shall be: `is`, read. A comparison is a range with an end at infinity.
struct ClaimRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_counts = true;  ///< whether the end itself is in the range
  bool high_counts = true;

  bool contains(double x) const {
    return (x > low || (low_counts && x == low)) && (x < high || (high_counts && x == high));
  }
  /// Whether a value in the interval is in the range.
  bool meets(double from, double to) const {
    return !(to < low || (to == low && !low_counts) || from > high ||
             (from == high && !high_counts));
  }
};

/// Reads FUNCTION(expression), which names pipelines out of `pipelines` (all variants of the
/// study). Throws Error with what was expected where: "at character 8: expected …".
ClaimQuantity read_quantity(const std::string& text, const std::vector<std::string>& pipelines);
/// Reads an expression whose values are named by themselves: "length_m + 0.1 * flight.duration_s".
/// Throws likewise.
ClaimQuantity read_objective(const std::string& text);
/// Reads "<= 0.95", "0.9..1.1" and the like; throws likewise.
ClaimRange read_range(const std::string& text);
}  // namespace altiplan::study
