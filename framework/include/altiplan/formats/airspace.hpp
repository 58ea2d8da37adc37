// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/formats/zone.hpp"

/// \file Airspace as authorities and pilots' programs publish it, in one representation. What a
/// file leaves unknown is closed, and listed; where a zone lies must be known.
namespace altiplan::formats {

struct Airspace {
  enum class Format { ed269, ed318, aixm, openair, faa };
  Format format = Format::ed269;
  std::vector<Zone> zones;
  /// What is closed because the file leaves it unknown, and what was skipped, one per line.
  std::vector<std::string> notes;
};

/// Reads ED-269, ED-318, AIXM 5.1, OpenAir or a UAS facility map of the FAA, which its content
/// tells; null if it is of another kind. `file` is for messages. Throws Error, naming file and line
/// or feature, if it is damaged so that the place of a zone is unknown.
ALTIPLAN_API std::shared_ptr<const Airspace> read_airspace(const std::string& file,
                                                           const std::string& text);

/// "ED-269"
ALTIPLAN_API std::string format_name(Airspace::Format format);

/// Height above sea level of a pressure altitude, in the standard atmosphere at that QNH.
ALTIPLAN_API double standard_to_sea(double metres, double qnh_hpa);

/// Time of an event of the sun on a day (since 1970-01-01) of a place, seconds since 1970-01-01
/// UTC, of the local solar day; none where the sun does not rise or set. Meeus, Astronomical
/// Algorithms, ch. 25 (low accuracy) with the standard refraction, as NOAA's calculator: within a
/// minute up to 72° of latitude.
ALTIPLAN_API std::optional<double> sun_time(DailyHours::Event event, long day,
                                            const Point2& lonlat);
}  // namespace altiplan::formats
