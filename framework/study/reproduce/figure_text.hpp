// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "study/claims/claims.hpp"

namespace altiplan::study {

/// A number of the documentation, and the digits that it is given to.
struct PrintedNumber {
  double value = 0;
  int decimals = 0;
};

/// A figure of the documentation: "1,231", "0.45", "92.6 %", "0.674 [0.631, 0.722]", "54/100".
struct PrintedFigure {
  enum class Form { number, percent, count };
  Form form = Form::number;
  PrintedNumber estimate;            ///< of a count its share
  std::optional<PrintedNumber> low;  ///< ends of an interval
  std::optional<PrintedNumber> high;

  /// The same figure of other runs, in this form and to as many digits: of a share the counted
  /// pairs for which it is true, of another quantity the pairs that have it. "–" without a value.
  std::string of(const JudgedClaim& found, bool is_share) const;
  /// True if the range holds a number whose text is that of the estimate.
  bool is_within(const Interval& interval) const;
  /// A range of the quantity in this form: "0.61 to 0.72".
  std::string range(const Interval& interval) const;
};

/// Nothing if the text is no such figure.
std::optional<PrintedFigure> read_figure(const std::string& text);
}  // namespace altiplan::study
