// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/kit/formats/mission_file.hpp"

namespace altiplan::host {

/// How many decimals degrees and metres are written with.
struct Decimals {
  int degrees = 7;
  int metres = 3;
};

/// What a mission file says beside the mission itself.
struct MissionText {
  kit::MissionFile mission;  ///< its format is the one to write; all items have one altitude frame
  double speed_mps = 15;
  Decimals decimals;
};

// Each writes one format; what it cannot hold is left out, and said by the caller.
std::string qgc_plan_text(const MissionText& mission);
std::string waypoints_text(const MissionText& mission);
std::string kml_text(const MissionText& mission);
std::string gpx_text(const MissionText& mission);
std::string geojson_text(const MissionText& mission);

/// Writes in the mission's format.
std::string mission_text(const MissionText& mission);

/// A number with so many decimals at most, in the C locale, without zeros at its end.
std::string rounded_text(double value, int decimals);
/// The number that such a text stands for.
double rounded(double value, int decimals);
/// "sea", "ground" or "home".
const char* name(kit::AltitudeFrame frame);
/// The circle as a polygon of 64 corners: around it to keep out of, inside it to keep in.
kit::Polygon circle_outline(const kit::MissionZone& circle);
}  // namespace altiplan::host
