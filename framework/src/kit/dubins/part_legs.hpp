// SPDX-License-Identifier: Apache-2.0
// Legs of a path that is a sequence of turns of one radius and straight parts.
#pragma once

#include <span>
#include <vector>

#include "altiplan/leg.hpp"

namespace altiplan::kit {

struct PathPart {
  int sense;    ///< 1 left, -1 right, 0 straight
  double size;  ///< radians, of a straight part radii; parts that rounding leaves have no leg
};

/// `wind` is in units of the airspeed. The height changes linearly in time, which is
/// also linear in the length through the air. The last leg ends at `to` exactly.
std::vector<Leg> part_legs(std::span<const PathPart> parts, double radius, const Pose& from,
                           const Vec3& to, const Vec3& wind = Vec3::Zero());
}  // namespace altiplan::kit
