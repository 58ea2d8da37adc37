// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "joins.hpp"

namespace altiplan::cover {

/// A part of a tour: of its legs, `needed` says which must be flown.
struct Flight {
  Ring2 points;
  std::vector<char> needed;

  /// Adds a leg to a point, unless it is there already.
  void go_to(const Point2& p, char is_needed);
};

/// A tour of several areas.
struct Tour : Flight {
  std::vector<const Area*> within{};  ///< by waypoint; null: beside the areas

  double seconds(const LegTime& time) const;
};

/// Cuts a closed tour into flights from one place and back to it, each within a capacity, of the
/// least total time; the place is the first waypoint, or of one area any if `is_free`. Empty: no
/// place and no cuts do.
std::vector<Flight> flights_of(const Tour& tour, const LegTime& time, bool is_free,
                               double capacity_s);
}  // namespace altiplan::cover
