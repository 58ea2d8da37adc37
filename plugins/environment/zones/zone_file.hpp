// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/formats/airspace.hpp"
#include "altiplan/formats/mission_file.hpp"
#include "altiplan/params.hpp"

namespace altiplan::zones {

/// Meaning of a value of the file's type property.
struct TypeRule {
  std::string is;
  std::optional<double> floor_m;
  std::optional<double> ceiling_m;
  bool skip = false;

  void describe(Fields& f);
};

/// Rules that convert a file's features to zones; property names are "" if the file has none.
struct FileRules {
  formats::Restriction kind = formats::Restriction::keep_out;
  std::string floor;
  std::string ceiling;
  std::string from;
  std::string until;
  std::string type;
  std::vector<TypeRule> types;

  void describe(Fields& f);
  bool name_properties() const { return !(floor + ceiling + from + until + type).empty(); }
};

/// Zones of a file, of one volume each.
struct FileZones {
  std::shared_ptr<const formats::Airspace>
      airspace;                      ///< of a file of that kind, which has no other zones
  std::vector<formats::Zone> zones;  ///< to keep out of or in
  std::vector<std::string> notes;
};

/// A time window's ends, "" where it is open; no period where it is open at both. Throws Error for
/// other texts than times.
std::vector<formats::ZonePeriod> time_window(const std::string& from, const std::string& until);

/// Reads published airspace, GeoJSON, KML, or the fence from a ground station's file. Throws Error
/// naming the file.
FileZones read_zone_file(const std::string& file, const FileRules& rules);

inline std::vector<formats::Point2> corners_of(const FileZones& file) {
  return formats::corners_of(file.airspace ? file.airspace->zones : file.zones);
}
}  // namespace altiplan::zones
