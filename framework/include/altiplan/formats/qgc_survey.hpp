// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "altiplan/api.hpp"
#include "altiplan/formats/polygon.hpp"

/// \file Survey items of QGroundControl: an area and settings, and the commands that the ground
/// station makes from them.
namespace altiplan::formats::qgc {

/// A survey of a plan, made again from its settings and compared with the commands that the plan
/// holds.
struct SurveyMatch {
  std::string place;    ///< of the item in the file: "mission.items.3"
  std::string problem;  ///< why the commands differ; "": they are equal
  double differ_m = 0;  ///< greatest distance of a waypoint from the plan's, if they are equal
  double coverage = 0;  ///< share of the area within half a spacing beside the lines
  std::size_t commands = 0;
  std::string plane;  ///< that fits better: "sphere", of saved plans, or "ellipsoid", from 2026
};

/// Of each survey of a `.plan`, in order. Throws Error, naming the file and the item, for damaged
/// data.
ALTIPLAN_API std::vector<SurveyMatch> match_surveys(const std::string& file);

/// A survey of an area by a copter with a camera that looks straight down, its width across.
struct SurveySettings {
  Ring polygon;  ///< longitude, latitude
  std::array<double, 2> sensor_mm{0, 0};
  std::array<double, 2> image_px{0, 0};
  double focal_mm = 0;
  double min_interval_s = 0;
  double gsd_cm = 0;
  double overlap = 0;  ///< shares
  double sidelap = 0;
  double spacing_m = 0;  ///< of lines
  double trigger_m = 0;  ///< between photos
  double height_m = 0;
  bool above_ground = false;  ///< else above home
  Point2 start{0, 0};         ///< where the flight begins and ends
  double stop_m = 0;          ///< a turn takes as long as so many metres
};

/// The item, as JSON, whose lines by the ground station's rule take the least way of all angles
/// and entries.
struct SurveyItem {
  std::string json;
  std::size_t commands = 0;                  ///< in it, numbered from the one that was asked for
  std::vector<std::array<Point2, 2>> lines;  ///< longitude, latitude
};
ALTIPLAN_API SurveyItem survey_item(const SurveySettings& settings, int first_number);
}  // namespace altiplan::formats::qgc
