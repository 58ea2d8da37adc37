// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace altiplan::study {

/// A value of the runs of a pipeline, named in a claim.
struct ClaimValue {
  std::size_t pipeline = 0;  ///< index into the names given to read_quantity
  std::string name;          ///< "flight.length_m"
  bool operator==(const ClaimValue&) const = default;
};

/// An expression: a number, a value, or an operator and its operands.
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
  std::size_t at = 0;     ///< position of its first character in the text, from 0
  std::vector<ClaimExpression> operands;

  /// True if its value is boolean (1 or 0) and not a number.
  bool is_logical() const { return kind >= Kind::less; }
};

/// The quantity of a claim, parsed from `that`.
struct ClaimQuantity {
  enum class Function { quantile, mean, min, max, share };
  Function function = Function::quantile;
  double q = 0.5;  ///< of quantile: 0.5 for median(), 0.95 for p95()
  ClaimExpression expression;
  std::vector<ClaimValue> values;  ///< the values named, each once, in the order of the text
};

/// The required range, parsed from `is`. A comparison is a range with one end at infinity.
struct ClaimRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_counts = true;  ///< true if the range includes its end
  bool high_counts = true;

  bool contains(double x) const {
    return (x > low || (low_counts && x == low)) && (x < high || (high_counts && x == high));
  }
  /// True if some value of the interval is in the range.
  bool meets(double from, double to) const {
    return !(to < low || (to == low && !low_counts) || from > high ||
             (from == high && !high_counts));
  }
};

/// Reads FUNCTION(expression), which names pipelines of `pipelines` (all variants of the study).
/// Throws Error with the position and what was expected: "at character 8: expected …".
ClaimQuantity read_quantity(const std::string& text, const std::vector<std::string>& pipelines);
/// Reads an expression of values without pipelines: "length_m + 0.1 * flight.duration_s". Throws
/// likewise.
ClaimQuantity read_objective(const std::string& text);
/// Reads "<= 0.95", "0.9..1.1" and the like; throws likewise.
ClaimRange read_range(const std::string& text);
}  // namespace altiplan::study
