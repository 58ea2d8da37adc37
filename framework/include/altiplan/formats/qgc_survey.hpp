// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "altiplan/api.hpp"

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
}  // namespace altiplan::formats::qgc
