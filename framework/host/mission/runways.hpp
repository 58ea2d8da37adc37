// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/mission/mission.hpp"

namespace altiplan::host {

/// The way to an aeroplane's landing, all in one vertical plane.
struct LandingLine {
  Vec3 entry;  ///< where its course and height are reached
  Vec3 fix;    ///< where the glide begins
};
LandingLine line_of(const LandingEntry& landing, const Vec3& touch);
/// Where the climb from the start ends.
Vec3 end_of(const TakeOffEntry& takeoff, const Vec3& start);

/// Adds the scenario's take-off and landing: the runways, and via points where the course and the
/// height of each are flown. Throws ConfigError where the wind does not let a course be held.
void add_runways(const ScenarioFile& file, Mission& mission);

/// The straight section between a runway and its via point; none for any other section.
std::optional<Polyline> runway_section(const Mission& mission, const Vec3& from, const Vec3& to);
}  // namespace altiplan::host
