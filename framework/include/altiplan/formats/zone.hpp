// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/formats/polygon.hpp"

/// \file Zones of missions, maps and published airspace, in one representation.
namespace altiplan::formats {

/// What a zone demands of a flight: to stay out, a permission, to be informed, or to stay in;
/// unspecified: the file does not say which (KML).
enum class Restriction { keep_out, ask, inform, keep_in, unspecified };

struct ZoneLimit {
  /// Reference of the height; none: the zone has no limit in this direction. `standard` is the
  /// pressure altitude of flight levels.
  enum class Datum { none, ground, sea, standard };
  Datum datum = Datum::none;
  double metres = 0;

  /// Above sea level; none: no limit.
  static ZoneLimit sea(std::optional<double> metres) {
    return metres ? ZoneLimit{Datum::sea, *metres} : ZoneLimit{};
  }
  bool operator==(const ZoneLimit&) const = default;
};

/// Upright, over a polygon in longitude and latitude, with straight edges in these, or over a
/// circle where the outline is empty. Circles and arcs of published airspace have become edges that
/// never cut into the volume, and are at most 1.1 m off.
struct ZoneVolume {
  Polygon polygon;
  ZoneLimit lower;
  ZoneLimit upper;
  Point2 centre{0, 0};
  double radius_m = 0;
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
struct ZonePeriod {
  double from;
  double until;
  std::vector<DailyHours> hours;
};

struct ALTIPLAN_API Zone {
  std::string id;
  std::string name;
  std::string type;  ///< the source's own word: "PROHIBITED", "CTR", "D TMA"
  Restriction restriction = Restriction::keep_out;
  std::vector<ZoneVolume> volumes;  ///< at least one; of a mission, exactly one
  std::vector<ZonePeriod> periods;  ///< none: always active
  /// Why its rings are no polygon, such as an outline that meets itself; "" if they are. Its
  /// volumes then hold whatever the rings may enclose, which is for keeping out of it alone.
  std::string problem;

  bool keeps_in() const { return restriction == Restriction::keep_in; }
  /// "EGD901 (TEST DANGER)"
  std::string label() const;
  /// True if that is its identifier, its name or its label.
  bool is_called(const std::string& text) const {
    return !text.empty() && (text == id || text == name || text == label());
  }
  bool takes_permission() const {
    return restriction == Restriction::ask || restriction == Restriction::inform;
  }
  /// True if the zone is active at some time of [from, until]. Hours that depend on the sun are
  /// taken at the middle of the zone, longer at both ends by two minutes and by what the sun takes
  /// to cross the zone; where it does not rise or set, for the whole day.
  bool is_active(double from, double until) const { return !active_between(from, until).empty(); }
  /// The times within [from, until] at which it is, ascending and apart.
  std::vector<std::array<double, 2>> active_between(double from, double until) const;
};

/// A point of a map.
struct NamedPoint {
  std::string name;
  Point2 at{0, 0};  ///< longitude, latitude
};

/// Why a permission for the zone that is called so opens nothing: none is, with the nearest names,
/// it takes none, or zones with other labels are called so too. "" if it opens a zone.
ALTIPLAN_API std::string permission_problem(const std::vector<Zone>& zones,
                                            const std::string& called);

/// All corners of the zones' outlines, and the centres of circles.
ALTIPLAN_API std::vector<Point2> corners_of(const std::vector<Zone>& zones);
}  // namespace altiplan::formats
