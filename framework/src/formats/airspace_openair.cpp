// SPDX-License-Identifier: Apache-2.0
//
// OpenAir: WinPilot's format of 1998 with the extensions of Naviter's specification 2.1 (AA, AF,
// AG, AI, AX, AY).
#include <algorithm>
#include <cmath>

#include "airspace_parts.hpp"
#include "altiplan/earth.hpp"
#include "altiplan/geometry.hpp"
#include "openair_values.hpp"
#include "xml_parts.hpp"

namespace altiplan::formats {
namespace {

class OpenAirReader {
 public:
  OpenAirReader(const std::string& file, const std::string& text) : file_(file), text_(text) {}

  Airspace read() {
    std::size_t begin = 0;
    while (begin < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', begin), text_.size());
      ++line_;
      std::string_view line = std::string_view(text_).substr(begin, end - begin);
      if (line_ == 1 && line.starts_with("\xEF\xBB\xBF")) {
        line.remove_prefix(3);
      }
      line = trimmed(line.substr(0, line.find('*')));
      begin = end + 1;
      told([&] { take(line); });
    }
    told([&] { finish(); });
    airspace_.notes = doubts_.notes();
    return std::move(airspace_);
  }

 private:
  struct Field {
    bool given = false;
    std::string text;
  };

  template <class Act>
  void told(const Act& act) const {
    try {
      act();
    } catch (const Error& error) {
      throw Error(file_ + ":" + std::to_string(line_) + ": " + error.what());
    }
  }

  void take(std::string_view line) {
    if (line.empty() || line.front() == ';') {  // a comment of some programs
      return;
    }
    const std::string record = upper_case(line.substr(0, line.find_first_of(" \t")));
    const std::string_view value = trimmed(line.substr(std::min(record.size(), line.size())));
    if (record == "AC") {
      finish();
      begin(value);
    } else if (record == "TO" || record == "TC") {
      finish();
      in_terrain_ = true;
      doubts_.add("terrain, skipped", printable(value));
    } else if (record == "SP" || record == "SB" || record == "AT") {
      return;  // how and where things are drawn
    } else if (record == "V") {
      take_variable(value);
    } else if (in_terrain_ && record == "DP") {
      only_coordinate(value);
    } else if (!open_) {
      throw Error("expected AC before '" + printable(record) + "'");
    } else {
      take_part(record, value);
    }
  }

  void take_part(const std::string& record, std::string_view value) {
    if (Field* field = field_of(record)) {
      if (field->given) {
        throw Error("a second " + record + " in the airspace of line " + std::to_string(start_) +
                    ", expected AC before it");
      }
      *field = {true, printable(value)};
    } else if (record == "AA") {
      activations_.push_back(printable(value.substr(0, value.find_first_of(" \t;"))));
    } else if (record == "DY") {
      airway_.push_back(only_coordinate(value));
    } else if (record == "DP") {
      outline_.emplace_back(only_coordinate(value));
    } else if (record == "DA") {
      const std::vector<double> arc = numbers(value, 3);
      add_arc(arc[0] * kNauticalMile, arc[0] * kNauticalMile, arc[1], arc[2]);
    } else if (record == "DB") {
      take_arc_between(value);
    } else if (record == "DC") {
      circles_.push_back(circle_ring(centre("DC"), numbers(value, 1)[0] * kNauticalMile));
    } else if (is_other(record)) {
      doubts_.add("record " + record + ", not read", label());
    } else if (record != "AF" && record != "AG" && record != "AX") {
      throw Error(
          "unknown record '" + printable(record) +
          "', expected AC, AN, AL, AH, AY, AI, AA, AF, AG, AT, AX, V, DP, DA, DB, DC or DY");
    }
  }

  /// Of another description of the format, but not of the outline: two letters, without D first,
  /// and perhaps a mark.
  static bool is_other(const std::string& record) {
    const auto letter = [](char c) { return c >= 'A' && c <= 'Z'; };
    const bool has_mark = record.size() == 3 && !letter(record[2]);
    return (record.size() == 2 || has_mark) && letter(record[0]) && letter(record[1]) &&
           record[0] != 'D' && record != "AF" && record != "AG" && record != "AT" && record != "AX";
  }

  Field* field_of(const std::string& record) {
    return record == "AN"   ? &name_
           : record == "AL" ? &lower_
           : record == "AH" ? &upper_
           : record == "AY" ? &kind_
           : record == "AI" ? &id_
                            : nullptr;
  }

  void take_variable(std::string_view value) {
    Scan scan(value);
    if (scan.take('X')) {
      expect_equals(scan);
      centre_ = only_coordinate(scan.rest());
      centre_is_here_ = true;
    } else if (scan.take('D')) {
      expect_equals(scan);
      const bool clockwise = scan.take('+');
      if (!clockwise && !scan.take('-')) {
        throw Error("expected V D=+ or V D=-, found '" + printable(value) + "'");
      }
      clockwise_ = clockwise;
    } else if (scan.take('W')) {
      expect_equals(scan);
      airway_width_m_ = numbers(scan.rest(), 1)[0] * kNauticalMile;
    } else if (!scan.take('Z')) {
      throw Error("unknown variable '" + printable(value) + "', expected X, D, W or Z");
    }
  }
  static void expect_equals(Scan& scan) {
    scan.skip(" \t");
    if (!scan.take('=')) {
      throw Error("expected '=' after the variable, found '" + printable(scan.rest()) + "'");
    }
    scan.skip(" \t");
  }

  const Point2& centre(const char* record) {
    if (!centre_) {
      throw Error(std::string(record) + " needs a centre, expected V X=… before it");
    }
    if (!centre_is_here_) {
      doubts_.add("centre of an earlier airspace, kept", label());
    }
    return *centre_;
  }

  void add_arc(double radius, double other_radius, double from, double to) {
    expect_radius(std::min(radius, other_radius));
    expect_radius(std::max(radius, other_radius));
    expect_bearing(from);
    expect_bearing(to);
    const double turn = clockwise_ ? to - from : from - to;
    const double sweep = turn - 360 * std::floor(turn / 360);
    outline_.emplace_back(OutlineArc{centre("an arc"), std::min(radius, other_radius),
                                     std::max(radius, other_radius), from,
                                     (clockwise_ ? 1 : -1) * (sweep == 0 ? 360 : sweep)});
  }

  void take_arc_between(std::string_view value) {
    Scan scan(value);
    const Point2 from = coordinate(scan);
    const Point2 to = only_coordinate(scan.rest());
    const GeodesicCourse first = geodesic_course(centre("DB"), from);
    const GeodesicCourse last = geodesic_course(centre("DB"), to);
    outline_.emplace_back(from);
    add_arc(first.metres, last.metres, first.bearing_deg, last.bearing_deg);
    outline_.emplace_back(to);
  }

  void begin(std::string_view type) {
    open_ = true;
    in_terrain_ = false;
    start_ = line_;
    type_ = printable(type);
    clockwise_ = true;
    centre_is_here_ = false;
    name_ = lower_ = upper_ = kind_ = id_ = {};
    activations_.clear();
    outline_.clear();
    circles_.clear();
    airway_.clear();
  }

  std::string label() const { return name_.given ? name_.text : "line " + std::to_string(start_); }

  void finish() {
    in_terrain_ = false;
    if (!open_) {
      return;
    }
    open_ = false;
    Zone zone;
    zone.id = id_.text;
    zone.name = label();
    zone.type = kind_.given ? type_ + " " + kind_.text : type_;
    zone.restriction = restriction(zone.label());
    std::vector<Polygon> polygons;
    if (!airway_.empty()) {
      if (!airway_width_m_) {
        throw Error("airspace '" + zone.label() + "' of line " + std::to_string(start_) +
                    ": DY needs a width, expected V W=… before it");
      }
      polygons = corridor_of(airway_, *airway_width_m_ / 2);
    }
    if (!outline_.empty() || (circles_.empty() && airway_.empty())) {
      try {
        std::vector<Polygon> cover = cover_of(outline_, zone.label(), doubts_);
        std::move(cover.begin(), cover.end(), std::back_inserter(polygons));
      } catch (const Error& error) {
        throw Error("airspace '" + zone.label() + "' of line " + std::to_string(start_) + ": " +
                    error.what());
      }
    }
    for (Ring& circle : circles_) {
      polygons.push_back({std::move(circle), {}});
    }
    if (polygons.empty()) {
      return;
    }
    const ZoneLimit lower = lower_limit(openair_limit(lower_.text), zone.label(), doubts_);
    const ZoneLimit upper = upper_limit(openair_limit(upper_.text), zone.label(), doubts_);
    for (Polygon& polygon : polygons) {
      zone.volumes.push_back({std::move(polygon), lower, upper});
      settle(zone.volumes.back(), zone.label(), doubts_);
    }
    zone.periods = periods(zone.label());
    airspace_.zones.push_back(std::move(zone));
  }

  /// The stricter one of class and type; that of the type where there is no class.
  Restriction restriction(const std::string& label) {
    const std::string kind = upper_case(kind_.text);
    if (kind.empty() || kind == "NONE") {
      return restriction_of(type_, label, doubts_);
    }
    const Restriction of_kind = restriction_of(kind, label, doubts_);
    return upper_case(type_) == "UNC" ? of_kind
                                      : std::min(of_kind, restriction_of(type_, label, doubts_));
  }

  /// None: always active.
  std::vector<ZonePeriod> periods(const std::string& label) {
    std::vector<ZonePeriod> periods;
    for (const std::string& text : activations_) {
      const std::size_t slash = text.find('/');
      const std::string start = text.substr(0, slash);
      const std::string end = slash == std::string::npos ? "" : text.substr(slash + 1);
      if (slash == std::string::npos || end.find('/') != std::string::npos) {
        doubts_.add("activation '" + text + "' without times, always active", label);
        return {};
      }
      periods.push_back({period_start(start == "NONE" ? "" : start, label, doubts_),
                         period_end(end == "NONE" ? "" : end, label, doubts_),
                         {}});
      settle(periods.back(), label, doubts_);
    }
    return periods;
  }

  const std::string& file_;
  const std::string& text_;
  std::size_t line_ = 0;
  Airspace airspace_{Airspace::Format::openair, {}, {}};
  Doubts doubts_;
  std::optional<Point2> centre_;  ///< kept from one airspace to the next, as the format has it
  bool centre_is_here_ = false;
  std::optional<double> airway_width_m_;  ///< kept likewise
  bool clockwise_ = true;
  // The airspace being read.
  bool open_ = false;
  bool in_terrain_ = false;
  std::size_t start_ = 0;
  std::string type_;
  Field name_;
  Field lower_;
  Field upper_;
  Field kind_;
  Field id_;
  std::vector<std::string> activations_;
  Outline outline_;
  std::vector<Ring> circles_;
  Ring airway_;  ///< corners of its centre line
};
}  // namespace

bool is_openair(const std::string& text) {
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = trimmed(std::string_view(text).substr(begin, end - begin));
    if (line.starts_with("AC ") || line.starts_with("AC\t")) {
      return true;
    }
    if (line.starts_with("QGC WPL")) {
      return false;
    }
    begin = end + 1;
  }
  return false;
}

Airspace read_openair(const std::string& file, const std::string& text) {
  return OpenAirReader(file, text).read();
}
}  // namespace altiplan::formats
