// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/route.hpp"
#include "altiplan/world.hpp"
#include "host/first_route/survey.hpp"

namespace altiplan::host {

/// Photos along lines: straight down, their width across the line, one at the beginning of a line
/// and others `trigger_m` apart.
struct PhotoLines {
  std::vector<Polyline> lines;
  double trigger_m = 0;
  double half_across = 0;  ///< that a photo shows for each metre of height above what it shows
  double half_along = 0;
  double off_m = 0;    ///< by which the camera may be off the lines, in each direction
  double early_m = 0;  ///< by how much the first photo of each line may come before its beginning
};

bool ring_holds(const formats::Ring& ring, const Eigen::Vector2d& p);

/// Share of areas, but their holes, that at least one photo shows for certain: wherever between its
/// bounds the camera is, and with all ground of a cell of a grid at the height of its highest.
/// Hills that hide ground from the side are not looked for.
double share_shown(const std::vector<formats::Polygon>& areas, const PhotoLines& photos,
                   const World& world);
}  // namespace altiplan::host
