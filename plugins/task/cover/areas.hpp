// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "area.hpp"

namespace altiplan::cover {

/// An area in the order of several, and where its tour begins and ends; empty: anywhere.
struct Stage {
  const Area* area;
  std::optional<Point2> start;
  std::optional<Point2> goal;
  bool closed;  ///< it ends where it began
};

/// Areas in the order of the shortest path between them, by local search. Each is entered and left
/// where the one before and after is nearest. `start` and `goal` may lie beside the areas; without
/// a goal a closed order ends where it began.
std::vector<Stage> stages_of(const std::vector<Area>& areas, const std::optional<Point2>& start,
                             const std::optional<Point2>& goal, bool closed);
}  // namespace altiplan::cover
