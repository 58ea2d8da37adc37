// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "altiplan/formats/polygon.hpp"

/// \file The rule of QGroundControl's SurveyComplexItem, versions 4 and 5.
namespace altiplan::formats::qgc {

/// The plane in which lines are laid: of saved plans about a sphere of 6,371 km, of sources from
/// 2026 on the tangent plane of WGS 84.
enum class SurveyPlane { sphere, ellipsoid };

struct QgcSurvey {
  Ring polygon;  ///< longitude, latitude
  double angle_deg = 0;
  int entry = 0;  ///< 0 top left, 1 top right, 2 bottom left, 3 bottom right
  bool flies_alternate = false;
  double spacing_m = 0;
  double trigger_m = 0;  ///< 0: no camera
  double turnaround_m = 0;
  bool triggers_in_turnaround = false;
  bool hovers = false;  ///< and captures
  bool reflies = false;
  bool starts_once = false;  ///< with the camera on in turnarounds: older builds
  double height_m = 0;
  bool follows_terrain = false;
  double moved_m = 0;  ///< of the lines: kOntoEdge, its negative, or 0
};

struct SurveyCommand {
  int command = 16;  ///< 16 a waypoint, 206 the trigger distance, 2000 a photo
  double lon = 0;    ///< of a waypoint
  double lat = 0;
  double value = 0;  ///< hold (s) of a waypoint, metres of a trigger
};

/// What the ground station makes of the settings, in order.
std::vector<SurveyCommand> survey_commands(const QgcSurvey& survey, SurveyPlane plane);

/// Metres by which the lines are moved: one that lies on an edge belongs to the area or not by
/// rounding.
inline constexpr double kOntoEdge = 1e-6;

/// Share of the area within half a spacing beside the lines: exact.
double survey_coverage(const QgcSurvey& survey, SurveyPlane plane);
}  // namespace altiplan::formats::qgc
