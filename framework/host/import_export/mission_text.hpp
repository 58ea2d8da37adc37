// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/formats/mission_file.hpp"
#include "altiplan/route.hpp"
#include "altiplan/task.hpp"
#include "host/base/words.hpp"
#include "host/config/scenario_file.hpp"

namespace altiplan::host {

/// Number of decimals of degrees and metres.
struct Decimals {
  int degrees = 7;
  int metres = 3;
};

/// What is done at an item besides waiting.
struct ItemStop {
  Stop stop{};
  double ground_m = 0;  ///< below it, in the items' altitude frame
};

/// A route, or a mission, and the settings of its text.
struct MissionText {
  formats::MissionFile mission;  ///< all items have one altitude frame
  Polyline local;                ///< the places of its items in the world's frame
  bool has_position = true;      ///< that frame is on the Earth
  double speed_mps = 15;
  VehicleType vehicle = VehicleType::copter;
  double climb_deg = 10;  ///< of an aeroplane's take-off
  Decimals decimals;
  /// Expected time at each item, seconds since the route's start; empty: unknown.
  std::vector<double> times_s;
  std::vector<double> holds_s;            ///< waits at each item, whole seconds; empty: none
  std::map<std::size_t, ItemStop> stops;  ///< by item, in place of its wait
  std::optional<double> start_time_s;     ///< of the route, since 1970-01-01 UTC
  bool landing_start = false;             ///< the last three items are an approach and a landing
  formats::Firmware firmware = formats::Firmware::ardupilot;
  double commanded_mps = 0;  ///< behind the first item; 0: no speed is
};

/// The value of `rounded_text`.
double rounded(double value, int decimals);
/// "sea", "ground" or "home".
const char* name(formats::AltitudeFrame frame);
/// The zone's polygon; of a circle, one of 64 corners, around it to keep out, within it to keep in.
formats::Polygon polygon_of(const formats::Zone& zone);
}  // namespace altiplan::host
