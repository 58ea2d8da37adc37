// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/flight/track_judge.hpp"
#include "host/import_export/place_timing.hpp"
#include "host/import_export/route_format.hpp"
#include "host/mission/mission.hpp"
#include "host/result/stored_result.hpp"

namespace altiplan::host {

struct ExportOptions {
  const RouteFormat* format = &format_named("csv");
  formats::AltitudeFrame altitude = formats::AltitudeFrame::sea;
  bool takeoff = false;
  bool land = false;
  /// DO_LAND_START before an aeroplane's approach. Take-offs and landings on runways are written as
  /// such, whatever the other options say.
  bool landing_start = false;
  /// The last point is circled by the autopilot, not left for home.
  bool circles_at_end = false;
  /// Turns as circles where an autopilot flies them so; else all as points.
  bool loiters = false;
  /// Altitude of home above sea level; default: the ground below the start.
  std::optional<double> home_altitude_m;
  std::optional<std::size_t> max_items;
  formats::Firmware firmware = formats::Firmware::ardupilot;  ///< of plans
  double commanded_mps = 0;  ///< speed that a plan commands behind its first item; 0: none

  /// The reason why the options cannot be combined; "" if they can.
  std::string problem() const;
};

/// The source of an export: a route, or a flight with its times.
struct ExportSource {
  std::string name;
  Route route;
  std::vector<double> times;          ///< of a flight, one per point
  std::vector<FlightEvent> events;    ///< of the flight
  bool telemetry = false;             ///< the flight was a vehicle's
  std::vector<PlacedStop> stops{};    ///< in order, where the route waits for them
  std::vector<std::size_t> via{};     ///< waypoints at via points; export_route finds a route's
  std::vector<PlaceTiming> timing{};  ///< of each waypoint, where an autopilot's flight is known
};

struct Exported {
  std::optional<std::string> text;    ///< none if the written route would not be valid
  std::vector<std::string> messages;  ///< the verdict first
  MissionText mission{};              ///< of the text, unless it is CSV
};

/// Writes the route, reads it back and judges the result; uses more decimals, and more points of
/// turns, if fewer are not enough. Throws Error if the format or the world cannot express what is
/// asked for.
Exported export_route(const Mission& mission, const ExportSource& source,
                      const ExportOptions& options);

/// The zones as a fence file for Mission Planner (QGC WPL 110); no text where there are none.
Exported export_fence(const Mission& mission, const Route& route);
}  // namespace altiplan::host
