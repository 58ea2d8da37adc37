// SPDX-License-Identifier: Apache-2.0
#include "altiplan/formats/iso_time.hpp"

#include <charconv>
#include <chrono>
#include <cmath>
#include <ctime>

namespace altiplan::formats {
namespace {

/// Parses a text from the front.
class TimeReader {
 public:
  explicit TimeReader(std::string_view text) : text_(text) {}

  bool digits(std::size_t count, int& value) {
    if (text_.size() < count) {
      return false;
    }
    value = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (text_[i] < '0' || text_[i] > '9') {
        return false;
      }
      value = value * 10 + (text_[i] - '0');
    }
    text_.remove_prefix(count);
    return true;
  }
  bool take(char c) {
    if (text_.empty() || text_[0] != c) {
      return false;
    }
    text_.remove_prefix(1);
    return true;
  }
  double fraction() {
    double share = 0;
    double scale = 0.1;
    while (!text_.empty() && text_[0] >= '0' && text_[0] <= '9') {
      share += scale * (text_[0] - '0');
      scale /= 10;
      text_.remove_prefix(1);
    }
    return share;
  }
  bool done() const { return text_.empty(); }

 private:
  std::string_view text_;
};
}  // namespace

std::optional<double> parse_iso_time(std::string_view text) {
  TimeReader read(text);
  int year = 0;
  int month = 0;
  int day = 0;
  if (!read.digits(4, year) || !read.take('-') || !read.digits(2, month) || !read.take('-') ||
      !read.digits(2, day)) {
    return std::nullopt;
  }
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(unsigned(month)),
                                         std::chrono::day(unsigned(day))};
  if (!date.ok()) {
    return std::nullopt;
  }
  double seconds = 86400.0 * double(std::chrono::sys_days(date).time_since_epoch().count());
  if (read.done()) {
    return seconds;
  }
  int hour = 0;
  int minute = 0;
  int second = 0;
  if ((!read.take('T') && !read.take(' ')) || !read.digits(2, hour) || !read.take(':') ||
      !read.digits(2, minute)) {
    return std::nullopt;
  }
  if (read.take(':')) {
    if (!read.digits(2, second)) {
      return std::nullopt;
    }
    if (read.take('.')) {
      seconds += read.fraction();
    }
  }
  if (hour > 23 || minute > 59 || second > 60) {
    return std::nullopt;
  }
  seconds += hour * 3600 + minute * 60 + second;
  if (!read.take('Z')) {
    const bool east = read.take('+');
    int offset_hour = 0;
    int offset_minute = 0;
    if ((!east && !read.take('-')) || !read.digits(2, offset_hour)) {
      return std::nullopt;
    }
    read.take(':');
    if (!read.digits(2, offset_minute) || offset_hour > 23 || offset_minute > 59) {
      return std::nullopt;
    }
    seconds -= (east ? 1 : -1) * (offset_hour * 3600 + offset_minute * 60);
  }
  if (!read.done()) {
    return std::nullopt;
  }
  return seconds;
}

std::string iso_time(double seconds) {
  const auto time = static_cast<std::time_t>(std::llround(seconds));
  std::tm utc{};
  gmtime_r(&time, &utc);
  char text[40];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}
}  // namespace altiplan::formats
