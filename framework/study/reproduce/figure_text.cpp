// SPDX-License-Identifier: Apache-2.0
#include "study/reproduce/figure_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "host/base/words.hpp"

namespace altiplan::study {
namespace {

constexpr const char* kNothing = "–";

/// Reads a figure from left to right.
class Reader {
 public:
  explicit Reader(std::string text) : text_(std::move(text)) {}

  bool takes(std::string_view sign) {
    const bool is_next = text_.compare(at_, sign.size(), sign) == 0;
    at_ += is_next ? sign.size() : 0;
    return is_next;
  }
  bool is_at_end() const { return at_ == text_.size(); }

  /// Digits with or without commas between groups of three.
  std::optional<PrintedNumber> takes_number() {
    const std::size_t end = std::min(text_.find_first_not_of("-.,0123456789", at_), text_.size());
    // The comma that ends the first number of an interval is not part of it.
    std::size_t stop = end;
    while (stop > at_ && text_[stop - 1] == ',') {
      --stop;
    }
    const std::string written = text_.substr(at_, stop - at_);
    std::string digits = written;
    digits.erase(std::remove(digits.begin(), digits.end(), ','), digits.end());
    PrintedNumber number;
    const char* const last = digits.data() + digits.size();
    const auto [read, error] = std::from_chars(digits.data(), last, number.value);
    const bool has_its_commas = written == digits || written == host::with_commas(digits);
    if (error != std::errc() || read != last || !has_its_commas) {
      return std::nullopt;
    }
    at_ = stop;
    const std::size_t point = digits.find('.');
    number.decimals = point == digits.npos ? 0 : int(digits.size() - point - 1);
    return number;
  }

 private:
  std::string text_;
  std::size_t at_ = 0;
};

std::string printed(double value, int decimals) {
  char text[400];
  const auto done =
      std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals);
  std::string digits(text, done.ptr);
  const bool is_minus_zero = digits[0] == '-' && digits.find_first_not_of("-0.") == digits.npos;
  return host::with_commas(is_minus_zero ? digits.substr(1) : digits);
}
}  // namespace

std::optional<PrintedFigure> read_figure(const std::string& text) {
  Reader reader(text);
  PrintedFigure figure;
  const std::optional<PrintedNumber> first = reader.takes_number();
  if (!first) {
    return std::nullopt;
  }
  figure.estimate = *first;
  if (reader.takes("/")) {
    const std::optional<PrintedNumber> all = reader.takes_number();
    if (!all || !reader.is_at_end() || all->value < 1 || first->value > all->value ||
        first->value < 0 || first->decimals + all->decimals > 0) {
      return std::nullopt;
    }
    figure.form = PrintedFigure::Form::count;
    figure.estimate.value = first->value / all->value;
    figure.estimate.decimals = 15;
    return figure;
  }
  figure.form = reader.takes(" %") ? PrintedFigure::Form::percent : PrintedFigure::Form::number;
  if (reader.takes(" [")) {
    figure.low = reader.takes_number();
    if (!figure.low || !reader.takes(", ")) {
      return std::nullopt;
    }
    figure.high = reader.takes_number();
    if (!figure.high || !reader.takes("]")) {
      return std::nullopt;
    }
  }
  return reader.is_at_end() ? std::optional(figure) : std::nullopt;
}

std::string PrintedFigure::of(const JudgedClaim& found, bool is_share) const {
  if (form == Form::count) {
    const double share = is_share && found.used > 0 ? found.estimate : 1;
    const auto counted = std::size_t(std::llround(share * double(found.used)));
    return std::to_string(counted) + "/" + std::to_string(is_share ? found.used : found.pairs);
  }
  if (!std::isfinite(found.estimate)) {
    return kNothing;
  }
  const double factor = form == Form::percent ? 100 : 1;
  std::string text =
      printed(factor * found.estimate, estimate.decimals) + (form == Form::percent ? " %" : "");
  if (low && high) {
    text += found.interval ? " [" + printed(factor * found.interval->low, low->decimals) + ", " +
                                 printed(factor * found.interval->high, high->decimals) + "]"
                           : " [–, –]";
  }
  return text;
}

bool PrintedFigure::is_within(const Interval& interval) const {
  const double factor = form == Form::percent ? 100 : 1;
  const double half = 0.5 * std::pow(10, -estimate.decimals);
  const double noise = 1e-12 * std::abs(estimate.value);  // a tie is printed either way
  return estimate.value + half + noise >= factor * interval.low &&
         estimate.value - half - noise <= factor * interval.high;
}

std::string PrintedFigure::range(const Interval& interval) const {
  const double factor = form == Form::number ? 1 : 100;
  // One digit more than the figure: it is compared with the interval's exact ends.
  const int decimals = form == Form::count ? 1 : estimate.decimals + 1;
  const std::string unit = form == Form::number ? "" : " %";
  if (!std::isfinite(interval.low)) {
    return "at most " + printed(factor * interval.high, decimals) + unit;
  }
  const std::string from = printed(factor * interval.low, decimals);
  return std::isfinite(interval.high)
             ? from + " to " + printed(factor * interval.high, decimals) + unit
             : "at least " + from + unit;
}
}  // namespace altiplan::study
