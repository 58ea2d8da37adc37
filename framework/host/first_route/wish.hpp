// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/autopilot/flown_mission.hpp"
#include "host/config/scenario_file.hpp"
#include "host/first_route/survey.hpp"

namespace altiplan::host {

/// A point as the user gives it.
struct WishedPoint {
  std::string option;  ///< "--from", for messages
  double lon = 0;      ///< degrees, WGS 84
  double lat = 0;
  std::optional<double> above_ground_m;
};

/// A wind of one speed and direction.
struct WishedWind {
  double speed_mps = 0;
  double from_deg = 0;  ///< clockwise from north
};

/// A route over an elevation model that is wished for without a scenario.
struct RouteWish {
  std::vector<std::filesystem::path> terrain;  ///< models, or folders of them
  std::optional<std::string> crs;              ///< of models that name none
  std::vector<std::filesystem::path> avoid;    ///< files of zones
  double buffer_m = 0;                         ///< kept from zones
  std::vector<std::string> permitted;          ///< zones that a permission opens, as in ZoneUse
  std::vector<WishedPoint> points;             ///< start, via points, goal
  std::optional<double> min_above_ground_m;
  std::optional<double> max_above_ground_m;
  formats::Autopilot autopilot;         ///< of an aeroplane or a VTOL with a turn radius
  ParameterFile parameters;             ///< of the autopilot
  std::optional<double> turn_radius_m;  ///< of an aeroplane; none: a copter
  std::optional<double> speed_mps;      ///< through the air; none: chosen
  std::optional<double> climb_mps;      ///< greatest rates of climb and sink; none: an autopilot's
  std::optional<WishedWind> wind;
  std::optional<double> battery_wh;    ///< with power_w
  std::optional<double> power_w;       ///< mean power in flight
  double reserve = 0.2;                ///< share of the battery
  std::optional<std::string> planner;  ///< none: chosen
  std::optional<std::string> start_time;
  std::optional<TakeOffEntry> takeoff;  ///< of an aeroplane, from the ground of the start,
  std::optional<LandingEntry> landing;  ///< and on that of the goal; of a VTOL in hover above them
  std::optional<SurveyWish> survey;     ///< in place of a route to a goal
  double kept_m = 0;  ///< from the limits of height besides, for what a flight lacked before

  bool is_vtol() const { return autopilot.airframe == formats::Airframe::vtol; }
};

/// Heights above ground, metres.
struct WishedHeights {
  double min_m = 50;
  bool is_min_lowered = false;  ///< below the default, for the upper limit's sake
  std::optional<double> max_m;
  double ends_m = 60;  ///< of points without a height
};

/// The heights with the defaults filled in; throws Error where they contradict each other.
WishedHeights heights_of(const RouteWish& wish);
}  // namespace altiplan::host
