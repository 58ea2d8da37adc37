// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/formats/mission_file.hpp"
#include "host/base/words.hpp"
#include "host/config/scenario_file.hpp"

namespace altiplan::host {

/// Number of decimals of degrees and metres.
struct Decimals {
  int degrees = 7;
  int metres = 3;
};

/// A mission and the settings of its text.
struct MissionText {
  formats::MissionFile
      mission;  ///< its format is the one to write; all items have one altitude frame
  double speed_mps = 15;
  VehicleType vehicle = VehicleType::copter;
  double climb_deg = 10;  ///< of an aeroplane's take-off
  Decimals decimals;
  /// Expected time at each item, seconds since the route's start; empty: unknown.
  std::vector<double> times_s;
  std::optional<double> start_time_s;  ///< of the route, since 1970-01-01 UTC
};

// Each writes one format; what it cannot hold is left out, and reported by the caller.
std::string qgc_plan_text(const MissionText& mission);
std::string waypoints_text(const MissionText& mission);
std::string kml_text(const MissionText& mission);
std::string gpx_text(const MissionText& mission);
std::string geojson_text(const MissionText& mission);

/// Writes in the mission's format.
std::string mission_text(const MissionText& mission);

/// The value of `rounded_text`.
double rounded(double value, int decimals);
/// "sea", "ground" or "home".
const char* name(formats::AltitudeFrame frame);
/// The zone's polygon; of a circle, one of 64 corners, around it to keep out, within it to keep in.
formats::Polygon polygon_of(const formats::Zone& zone);
}  // namespace altiplan::host
