// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/kit/layers/polygon.hpp"

/// \file Airspace as authorities and pilots' programs publish it, in one representation. What a
/// file leaves unknown is closed, and listed; where a zone lies must be known.
namespace altiplan::kit {

/// What a zone demands of a flight: to stay out, a permission, or to be informed.
enum class Restriction { keep_out, ask, inform };

struct AirspaceLimit {
  /// Reference of the height; none: the zone has no limit in this direction. `standard` is the
  /// pressure altitude of flight levels.
  enum class Datum { none, ground, sea, standard };
  Datum datum = Datum::none;
  double metres = 0;

  bool operator==(const AirspaceLimit&) const = default;
};

/// Upright, over a polygon in longitude and latitude, with straight edges in these. Circles and
/// arcs have become edges that never cut into the volume, and are at most 1.1 m off.
struct AirspaceVolume {
  Polygon polygon;
  AirspaceLimit lower;
  AirspaceLimit upper;
};

/// Hours of some days of the week, in UTC; they end on the next day if not after they begin.
struct DailyHours {
  /// Civil twilight begins and ends at dawn and dusk.
  enum class Event { clock, sunrise, sunset, dawn, dusk };
  struct Edge {
    Event event = Event::clock;
    double seconds = 0;  ///< since midnight, or after the event
  };
  unsigned days = 127;  ///< bit 0: Monday, … bit 6: Sunday
  Edge from;
  Edge until;
};

/// Active at these hours from one time to another (seconds since 1970-01-01 UTC), or always in
/// between, if there are no hours.
struct AirspacePeriod {
  double from;
  double until;
  std::vector<DailyHours> hours;
};

struct ALTIPLAN_API AirspaceZone {
  std::string id;
  std::string name;
  std::string type;  ///< the source's own word: "PROHIBITED", "CTR", "D TMA"
  Restriction restriction = Restriction::keep_out;
  std::vector<AirspaceVolume> volumes;  ///< at least one
  std::vector<AirspacePeriod> periods;  ///< none: always active

  /// "EGD901 (TEST DANGER)"
  std::string label() const;
  /// True if the zone is active at some time of [from, until]. Hours that depend on the sun are
  /// taken at the middle of the zone, longer at both ends by two minutes and by what the sun takes
  /// to cross the zone; where it does not rise or set, for the whole day.
  bool is_active(double from, double until) const;
};

struct Airspace {
  enum class Format { ed269, ed318, aixm, openair, faa };
  Format format = Format::ed269;
  std::vector<AirspaceZone> zones;
  /// What is closed because the file leaves it unknown, and what was skipped, one per line.
  std::vector<std::string> notes;
};

/// Reads ED-269, ED-318, AIXM 5.1, OpenAir or a UAS facility map of the FAA, which its content
/// tells; none if it is of another kind. `file` is for messages. Throws Error, naming file and line
/// or feature, if it is damaged so that the place of a zone is unknown.
ALTIPLAN_API std::optional<Airspace> read_airspace(const std::string& file,
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
}  // namespace altiplan::kit
