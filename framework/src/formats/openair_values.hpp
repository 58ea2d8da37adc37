// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>

#include "airspace_parts.hpp"
#include "xml_parts.hpp"

/// \file Values in the records of OpenAir.
namespace altiplan::formats {

/// Parses a text from the front.
class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text) {}

  void skip(const char* characters) {
    text_.remove_prefix(std::min(text_.find_first_not_of(characters), text_.size()));
  }
  bool take(char c) {
    if (text_.empty() || std::toupper(static_cast<unsigned char>(text_[0])) != c) {
      return false;
    }
    text_.remove_prefix(1);
    return true;
  }
  std::optional<double> number() {
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc() || !std::isfinite(value)) {
      return std::nullopt;
    }
    text_.remove_prefix(std::size_t(end - text_.data()));
    return value;
  }
  std::string_view rest() const { return text_; }

 private:
  std::string_view text_;
};

/// "39:29.7 N" or "45:37:56N", degrees. Programs that round write 60 minutes or seconds.
inline std::optional<double> angle(Scan& scan, char positive, char negative) {
  double degrees = 0;
  double scale = 1;
  do {
    const auto part = scan.number();
    if (!part || *part < 0 || (scale < 1 && *part > 60)) {
      return std::nullopt;
    }
    degrees += *part * scale;
    scale /= 60;
  } while (scale > 1e-4 && scan.take(':'));
  scan.skip(" \t");
  if (scan.take(positive)) {
    return degrees;
  }
  return scan.take(negative) ? std::optional(-degrees) : std::nullopt;
}

inline Point2 coordinate(Scan& scan) {
  const std::string text(scan.rest());
  scan.skip(" \t,");
  const auto lat = angle(scan, 'N', 'S');
  scan.skip(" \t,");
  const auto lon = lat ? angle(scan, 'E', 'W') : std::nullopt;
  if (!lat || !lon) {
    throw Error("expected a coordinate such as 39:29.7 N 119:46.5 W, found '" + printable(text) +
                "'");
  }
  expect_lonlat({*lon, *lat});
  return {*lon, *lat};
}

/// One coordinate, then nothing, or a remark after a space.
inline Point2 only_coordinate(std::string_view text) {
  Scan scan(text);
  const Point2 p = coordinate(scan);
  if (!scan.rest().empty() && std::strchr(" \t", scan.rest()[0]) == nullptr) {
    throw Error("expected the end of the coordinate, found '" + printable(scan.rest()) + "'");
  }
  return p;
}

inline std::vector<double> numbers(std::string_view text, std::size_t count) {
  std::vector<double> values;
  Scan scan(text);
  while (values.size() < count) {
    scan.skip(" \t");
    const auto value = scan.number();
    if (!value) {
      break;
    }
    values.push_back(*value);
    scan.skip(" \t");
    if (values.size() < count && !scan.take(',')) {
      break;
    }
  }
  if (values.size() != count || !scan.rest().empty()) {
    throw Error("expected " + std::to_string(count) + (count == 1 ? " number" : " numbers") +
                ", found '" + printable(text) + "'");
  }
  return values;
}

/// "8400 ft", "FL 180", "100 Agl", "UNLIM (Mon-Fri)".
inline LimitText openair_limit(const std::string& found) {
  LimitText limit{{}, "FT", "AMSL", found};
  const std::string text =
      upper_case(trimmed(std::string_view(found).substr(0, found.find_first_of("(;"))));
  if (text == "SFC" || text == "GND" || text == "SURFACE" || text == "GROUND") {
    limit.value = 0;
    limit.reference = "GND";
    return limit;
  }
  if (text == "UNL" || text == "UNLIM" || text == "UNLIMITED" || text == "UNLTD") {
    limit.value = 1e9;
    return limit;
  }
  Scan scan(text);
  if (scan.take('F') && scan.take('L')) {
    scan.skip(" \t");
    limit.unit = "FL";
  } else {
    scan = Scan(text);
  }
  const auto value = scan.number();
  std::string words;
  std::copy_if(scan.rest().begin(), scan.rest().end(), std::back_inserter(words),
               [](char c) { return c != ' ' && c != '\t' && c != '.'; });
  for (const char* unit : {"FT", "FEET", "F"}) {
    if (limit.unit == "FT" && words.starts_with(unit)) {
      words.erase(0, std::strlen(unit));
      break;
    }
  }
  if (limit.unit == "FT" && words.starts_with("M") && !words.starts_with("MSL")) {
    limit.unit = "M";
    words.erase(0, words.starts_with("MT") ? 2 : 1);
  }
  if (words == "AGL" || words == "GND" || words == "SFC" || words == "ASFC") {
    limit.reference = "AGL";
  } else if (words == "STD") {
    limit.reference = "STD";
  } else if (!words.empty() && words != "MSL" && words != "AMSL" && words != "ALT") {
    return limit;  // unknown
  }
  limit.value = value;
  return limit;
}
}  // namespace altiplan::formats
