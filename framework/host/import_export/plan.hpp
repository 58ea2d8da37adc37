// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host/import_export/mission_text.hpp"

namespace altiplan::host {

/// Numbers of MAV_CMD.
struct Command {
  static constexpr int kWaypoint = 16;
  static constexpr int kLoiterForever = 17;
  static constexpr int kLoiterTurns = 18;
  static constexpr int kLand = 21;
  static constexpr int kTakeoff = 22;
  static constexpr int kLoiterToAltitude = 31;
  static constexpr int kVtolTakeoff = 84;
  static constexpr int kVtolLand = 85;
  static constexpr int kDelay = 93;           ///< parameter 1: seconds
  static constexpr int kChangeSpeed = 178;    ///< parameters 1: over the ground or not; 2: m/s
  static constexpr int kCameraTrigger = 206;  ///< parameters 1: metres, 0: off; 3: a photo at once
  static constexpr int kLandingStart = 189;
  static constexpr int kGripper = 211;          ///< parameters 1: number of it; 2: 0, to release
  static constexpr int kFencePolygonIn = 5001;  ///< a corner; parameter 1: number of corners
  static constexpr int kFencePolygonOut = 5002;
  static constexpr int kFenceCircleIn = 5003;  ///< parameter 1: radius
  static constexpr int kFenceCircleOut = 5004;
  static constexpr int kRallyPoint = 5100;
};

/// An item of a plan as autopilots and ground stations number it.
struct PlanItem {
  int command = Command::kWaypoint;
  int frame = 0;  ///< MAV_FRAME
  /// Latitude and longitude in degrees and an altitude come last; NaN: left to the autopilot.
  std::array<double, 7> params{};
  bool continues = true;
  std::string name{};  ///< of a fence's zone, at its first corner or its circle
};

/// What a vehicle is given: its mission, its fence and its rally points.
struct Plan {
  static constexpr int kArduPilot = 3;  ///< of MAV_AUTOPILOT
  static constexpr int kPx4 = 12;
  int autopilot = kArduPilot;  ///< which supports all three altitude frames
  int vehicle = 2;             ///< MAV_TYPE: a quadrotor
  double speed_mps = 15;
  std::optional<formats::MissionPoint> home;  ///< above sea level
  std::vector<PlanItem> items;
  std::vector<PlanItem> fence;
  std::vector<PlanItem> rally;
  Decimals decimals;  ///< of its texts
};

/// The items; before one with a speed of its own stands the command for that speed.
Plan plan_of(const MissionText& mission);

/// A file's own commands, fence and rally points. Throws Error for a file without commands, or with
/// a complex item that contains none.
Plan plan_of(const formats::MissionFile& mission);

/// Photos along parts of a route.
struct CameraLines {
  std::vector<Polyline> lines;
  double trigger_m = 0;   ///< between photos
  double within_m = 0.1;  ///< of a line's ends, the items there; turns are written beside theirs
};
/// The items, with the camera on at the one nearest to each line's first point and off, with a last
/// photo, at that nearest to its last.
/// Throws Error where a line is not among the items, in order.
Plan plan_of(const MissionText& mission, const CameraLines& camera);

/// QGroundControl's `.plan`.
std::string plan_text(const Plan& plan);
/// The `QGC WPL 110` text of its mission.
std::string waypoints_text(const Plan& plan);
/// That of its fence, as Mission Planner loads it.
std::string fence_text(const Plan& plan);
}  // namespace altiplan::host
