// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "airspace_parts.hpp"
#include "altiplan/formats/iso_time.hpp"
#include "altiplan/geometry.hpp"

namespace altiplan::formats {
namespace {

using Event = DailyHours::Event;

constexpr double kDay = 86400;
constexpr std::array<const char*, 7> kDays{"MON", "TUE", "WED", "THU", "FRI", "SAT", "SUN"};
/// Hours that end in the last minute of a day end with it.
constexpr double kLastMinute = kDay - 60;

// Beyond the error of the formulas, and for a degree of the zone's half extent: the sun crosses a
// degree of longitude in 240 s, and up to 60° of latitude its rising changes by less than 300 s
// per degree of it.
constexpr double kSunMargin = 120;
constexpr double kPerLongitude = 240;
constexpr double kPerLatitude = 300;

struct Sun {
  double declination;       ///< radians
  double equation_of_time;  ///< seconds
};

/// Meeus, Astronomical Algorithms, ch. 25 and 28; names as there.
Sun sun_at(double seconds) {
  const double T = (seconds / kDay + 2440587.5 - 2451545.0) / 36525;
  const double L0 = radians(280.46646 + T * (36000.76983 + 0.0003032 * T));
  const double M = radians(357.52911 + T * (35999.05029 - 0.0001537 * T));
  const double e = 0.016708634 - T * (0.000042037 + 0.0000001267 * T);
  const double C =
      radians((1.914602 - T * (0.004817 + 0.000014 * T)) * std::sin(M) +
              (0.019993 - 0.000101 * T) * std::sin(2 * M) + 0.000289 * std::sin(3 * M));
  const double omega = radians(125.04 - 1934.136 * T);
  const double lambda = L0 + C - radians(0.00569 + 0.00478 * std::sin(omega));
  const double epsilon = radians(23.439291 - T * (0.0130042 + T * (1.64e-7 - T * 5.04e-7)) +
                                 0.00256 * std::cos(omega));
  const double y = std::pow(std::tan(epsilon / 2), 2);
  const double E = y * std::sin(2 * L0) - 2 * e * std::sin(M) +
                   4 * e * y * std::sin(M) * std::cos(2 * L0) - y * y / 2 * std::sin(4 * L0) -
                   1.25 * e * e * std::sin(2 * M);
  return {std::asin(std::sin(epsilon) * std::sin(lambda)), 240 * degrees(E)};
}

bool is_first(Event event) { return event == Event::sunrise || event == Event::dawn; }

struct Where {
  Point2 middle{0, 0};
  double margin = 0;
};

Where where(const Zone& zone) {
  Point2 low{kInfinity, kInfinity};
  Point2 high{-kInfinity, -kInfinity};
  for (const ZoneVolume& volume : zone.volumes) {
    for (const Point2& p : volume.polygon.outline) {
      low = {std::min(low[0], p[0]), std::min(low[1], p[1])};
      high = {std::max(high[0], p[0]), std::max(high[1], p[1])};
    }
  }
  return {
      {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2},
      kSunMargin + kPerLongitude * (high[0] - low[0]) / 2 + kPerLatitude * (high[1] - low[1]) / 2};
}

/// Time of one end of the hours of a day; the margin makes them longer.
std::optional<double> time_of(const DailyHours::Edge& edge, long day, const Where& where,
                              bool start) {
  if (edge.event == Event::clock) {
    const bool to_midnight = !start && edge.seconds >= kLastMinute;
    return double(day) * kDay + (to_midnight ? kDay : edge.seconds);
  }
  const auto time = sun_time(edge.event, day, where.middle);
  return time ? std::optional(*time + edge.seconds + (start ? -where.margin : where.margin))
              : std::nullopt;
}

using Times = std::array<double, 2>;

/// The hours of a day.
Times times_on(const DailyHours& hours, long day, const Where& where) {
  const auto starts = time_of(hours.from, day, where, true);
  auto ends = time_of(hours.until, day, where, false);
  if (!starts || !ends) {
    // No sunrise or sunset: the whole local day, wherever it begins.
    return {double(day - 1) * kDay, double(day + 2) * kDay};
  }
  if (*ends <= *starts) {
    *ends += kDay;
  }
  return {*starts, *ends};
}

void add_active(const ZonePeriod& period, const Zone& zone, double from, double until,
                std::vector<Times>& all) {
  from = std::max(from, period.from);
  until = std::min(until, period.until);
  if (from > until) {
    return;
  }
  // Beyond these many days every day of the week has come.
  constexpr double kMany = 400 * kDay;
  constexpr double kFar = 1e12;
  if (period.hours.empty() || !(until - from <= kMany) || std::abs(from) > kFar) {
    all.push_back({from, until});
    return;
  }
  const bool by_sun =
      std::any_of(period.hours.begin(), period.hours.end(), [](const DailyHours& hours) {
        return hours.from.event != Event::clock || hours.until.event != Event::clock;
      });
  const Where at = by_sun ? where(zone) : Where{};
  const long first = long(std::floor(from / kDay)) - 2;
  const long last = long(std::floor(until / kDay)) + 2;
  for (const DailyHours& hours : period.hours) {
    for (long day = first; day <= last; ++day) {
      const long weekday = ((day + 3) % 7 + 7) % 7;  // 1970-01-01 was a Thursday
      if ((hours.days >> unsigned(weekday) & 1U) == 0) {
        continue;
      }
      const auto [starts, ends] = times_on(hours, day, at);
      if (starts <= until && ends >= from) {
        all.push_back({std::max(starts, from), std::min(ends, until)});
      }
    }
  }
}

/// A part of a clock's time, two digits.
bool two_digits(std::string_view& text, int& value) {
  if (text.size() < 2 || std::isdigit(static_cast<unsigned char>(text[0])) == 0 ||
      std::isdigit(static_cast<unsigned char>(text[1])) == 0) {
    return false;
  }
  value = (text[0] - '0') * 10 + (text[1] - '0');
  text.remove_prefix(2);
  return true;
}

double period_time(const std::string& text, bool end, const std::string& zone, Doubts& doubts) {
  const double open = end ? kInfinity : -kInfinity;
  if (text.empty()) {
    return open;
  }
  const auto time = parse_iso_time(text);
  if (!time) {
    doubts.add("unreadable " + std::string(end ? "end" : "start") + " of a period ('" +
                   printable(text) + "'), active without it",
               zone);
    return open;
  }
  // A date without a time of day ends with its day.
  return end && text.find_first_of("T ") == std::string::npos ? *time + kDay : *time;
}
}  // namespace

std::optional<double> sun_time(Event event, long day, const Point2& lonlat) {
  // The sun's upper limb on the horizon, with a refraction of 34'; civil twilight.
  const double zenith =
      event == Event::dawn || event == Event::dusk ? radians(96) : radians(90.833);
  const double mean_noon = double(day) * kDay + kDay / 2 - 240 * lonlat[0];
  double time = mean_noon;
  for (int n = 0; n < 4; ++n) {
    const Sun sun = sun_at(time);
    const double cosine =
        std::cos(zenith) / (std::cos(radians(lonlat[1])) * std::cos(sun.declination)) -
        std::tan(radians(lonlat[1])) * std::tan(sun.declination);
    if (!(std::abs(cosine) <= 1)) {
      return std::nullopt;
    }
    const double half_day = 240 * degrees(std::acos(cosine));
    time = mean_noon - sun.equation_of_time + (is_first(event) ? -half_day : half_day);
  }
  return time;
}

std::vector<std::array<double, 2>> Zone::active_between(double from, double until) const {
  std::vector<Times> all;
  for (const ZonePeriod& period : periods) {
    add_active(period, *this, from, until, all);
  }
  if (periods.empty()) {
    all.push_back({from, until});
  }
  std::sort(all.begin(), all.end());
  std::vector<Times> apart;
  for (const Times& times : all) {
    if (apart.empty() || times[0] > apart.back()[1]) {
      apart.push_back(times);
    } else {
      apart.back()[1] = std::max(apart.back()[1], times[1]);
    }
  }
  return apart;
}

std::optional<unsigned> day_bits(std::string_view name) {
  const std::string day = upper_case(name);
  if (day == "ANY") {
    return 127;
  }
  for (std::size_t n = 0; n < kDays.size(); ++n) {
    if (day == kDays[n]) {
      return 1U << n;
    }
  }
  return std::nullopt;
}

std::optional<double> clock_time(std::string_view text) {
  int hour = 0;
  int minute = 0;
  int second = 0;
  if (!two_digits(text, hour) || text.empty() || text[0] != ':') {
    return std::nullopt;
  }
  text.remove_prefix(1);
  if (!two_digits(text, minute)) {
    return std::nullopt;
  }
  if (!text.empty() && text[0] == ':') {
    text.remove_prefix(1);
    if (!two_digits(text, second)) {
      return std::nullopt;
    }
    if (!text.empty() && text[0] == '.') {
      text.remove_prefix(std::min(text.find_first_not_of("0123456789", 1), text.size()));
    }
  }
  const bool utc = text == "Z" || text == "z" || text == "+00:00";
  const double time = hour * 3600 + minute * 60 + second;
  if (!utc || minute > 59 || second > 60 || time > kDay) {
    return std::nullopt;
  }
  return time;
}

std::optional<Event> sun_event(std::string_view name) {
  const std::string event = upper_case(name);
  return event == "SR"     ? std::optional(Event::sunrise)
         : event == "SS"   ? std::optional(Event::sunset)
         : event == "BMCT" ? std::optional(Event::dawn)
         : event == "EECT" ? std::optional(Event::dusk)
                           : std::nullopt;
}

double period_start(const std::string& text, const std::string& zone, Doubts& doubts) {
  return period_time(text, false, zone, doubts);
}

double period_end(const std::string& text, const std::string& zone, Doubts& doubts) {
  return period_time(text, true, zone, doubts);
}

void settle(ZonePeriod& period, const std::string& zone, Doubts& doubts) {
  if (period.from > period.until) {
    doubts.add("period that ends before it starts, always active", zone);
    period = {-kInfinity, kInfinity, {}};
  }
}
}  // namespace altiplan::formats
