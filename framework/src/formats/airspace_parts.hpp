// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "altiplan/error.hpp"
#include "altiplan/formats/airspace.hpp"

/// \file Common parts of the readers of airspace.
namespace altiplan::formats {

class JsonNode;

inline constexpr double kFoot = 0.3048;
inline constexpr double kNauticalMile = 1852;
inline constexpr double kFlightLevel = 100 * kFoot;

/// What had to be closed or skipped, and in which zones.
class Doubts {
 public:
  void add(const std::string& what, const std::string& zone);
  std::vector<std::string> notes() const;

 private:
  std::vector<std::pair<std::string, std::vector<std::string>>> found_;
};

/// An arc around a centre; the radius is known to lie between two values.
struct OutlineArc {
  Point2 centre;
  double min_radius_m;
  double max_radius_m;
  double from_deg;        ///< bearing
  double sweep_deg;       ///< positive clockwise
  bool has_start = true;  ///< false: the corner before it is where it starts
  bool has_end = true;
  bool is_uncertain = false;  ///< it may run the other way round
};
using OutlinePart = std::variant<Point2, OutlineArc>;
using Outline = std::vector<OutlinePart>;

/// Each throws Error: unless it is a position, a radius up to 1000 km, a bearing.
void expect_lonlat(const Point2& p);
void expect_radius(double metres);
void expect_bearing(double degrees);

/// Polygons that cover the outline: one, several if it meets itself, none if it has no area; the
/// last two are reported.
std::vector<Polygon> cover_of(const Outline& outline, const std::string& zone, Doubts& doubts);
/// The polygon, or where its rings are no polygon: what these may enclose, and what is wrong.
/// None if they enclose nothing; throws Error if then there are holes all the same.
struct Enclosed {
  std::vector<Polygon> polygons;
  std::string problem;
};
Enclosed enclosed_by(const Polygon& rings);
/// True if the outline does not meet itself, apart from gaps between arcs and corners.
bool is_simple(const Outline& outline);
/// A circle around its disc, or within it.
Ring circle_ring(const Point2& centre, double radius_m, bool within = false);
/// What lies within a distance of a line whose edges are straight in longitude and latitude, or of
/// a point: polygons that overlap, a metre per kilometre wider at most. Throws Error unless the
/// distance is between 0 and 1000 km.
std::vector<Polygon> corridor_of(const Ring& line, double distance_m);
/// How far a point or a line reaches, metres, if the property with this name says that, such as
/// "Bufferzone": "5 km"; else 0. A number without a unit is in metres from 100 on, below in
/// kilometres, which closes more. Throws Error if it is no length.
double reach_of(const std::string& property, const std::string& value);
/// Cuts holes out of the polygon as far as that is certain.
void cut_holes(Polygon& polygon, const std::vector<Ring>& holes, const std::string& zone,
               Doubts& doubts);
/// Of an outline: chords that never reach beyond it.
Ring ring_within(const Outline& outline);

/// A limit as a file gives it.
struct LimitText {
  std::optional<double> value;
  std::string unit;       ///< M, FT or FL
  std::string reference;  ///< AGL, SFC, GND, AMSL, MSL, STD, WGS84, W84
  std::string found;      ///< for the note, if the limit is unknown
};
ZoneLimit lower_limit(const LimitText& text, const std::string& zone, Doubts& doubts);
ZoneLimit upper_limit(const LimitText& text, const std::string& zone, Doubts& doubts);
/// Removes limits that contradict each other.
void settle(ZoneVolume& volume, const std::string& zone, Doubts& doubts);

/// The restriction of a class of airspace, or of a kind of zone; keep_out, and reported, if it is
/// unknown.
Restriction restriction_of(const std::string& type, const std::string& zone, Doubts& doubts);

/// Bit of a day ("MON"), all of them for "ANY"; none if it is no such word.
std::optional<unsigned> day_bits(std::string_view name);
/// Seconds since midnight of "06:00Z"; none if it is no time in UTC.
std::optional<double> clock_time(std::string_view text);
/// The event of "SR", "SS", "BMCT", "EECT".
std::optional<DailyHours::Event> sun_event(std::string_view name);
/// Start or end of a period; infinite, and reported, if it is unreadable.
double period_start(const std::string& text, const std::string& zone, Doubts& doubts);
double period_end(const std::string& text, const std::string& zone, Doubts& doubts);
/// Removes the ends of a period that ends before it starts.
void settle(ZonePeriod& period, const std::string& zone, Doubts& doubts);

std::string upper_case(std::string_view text);
/// The text without control characters and broken UTF-8.
std::string printable(std::string_view text);

bool is_openair(const std::string& text);
Airspace read_openair(const std::string& file, const std::string& text);
bool is_aixm(const std::string& text);
Airspace read_aixm(const std::string& file, const std::string& text);
/// None if it is JSON of another kind.
std::optional<Airspace> read_airspace_json(const std::string& file, const std::string& text);
/// Adds the feature's zone.
void read_json_feature(const JsonNode& feature, Airspace::Format format, Airspace& to,
                       Doubts& doubts);
}  // namespace altiplan::formats
