// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan::mesh {

/// Corners, counter-clockwise as seen from outside; may be so thin that it is a segment.
using Triangle = std::array<Vec3, 3>;

/// Point of the triangle nearest to p.
Vec3 nearest_point(const Triangle& triangle, const Vec3& p);
/// Minimum distance between the leg a–b and the triangle, 0 if they meet.
double leg_distance(const Triangle& triangle, const Vec3& a, const Vec3& b);
/// Minimum distance between the solid box and the triangle, 0 if they meet.
double box_distance(const Triangle& triangle, const Box& box);
/// Adds the positions along the leg (0 at a, 1 at b) where it may enter or leave the triangle, if
/// they come within `distance`: between two of them the leg does not meet the triangle.
void add_meetings(const Triangle& triangle, const Vec3& a, const Vec3& b, double distance,
                  std::vector<double>& places);
}  // namespace altiplan::mesh
