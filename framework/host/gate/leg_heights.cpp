// SPDX-License-Identifier: Apache-2.0
#include "host/gate/leg_heights.hpp"

#include <algorithm>

#include "altiplan/constraint.hpp"

namespace altiplan::host {

LegHeights leg_heights(const Leg& leg, const World& world) {
  const Polyline points = leg.chords(kChordTolerance);
  LegHeights heights;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    heights.lowest = std::min(heights.lowest, world.ground_gap(points[i], points[i + 1]));
    heights.highest = std::max(heights.highest, world.ground_gap_max(points[i], points[i + 1]));
  }
  return heights;
}
}  // namespace altiplan::host
