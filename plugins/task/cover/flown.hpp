// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "joins.hpp"
#include "swept.hpp"

namespace altiplan::cover {

/// What is to be covered, and how tours are timed.
struct Problem {
  Area area;
  double spacing_m;
  LegTime time;
  bool closed;
  std::optional<Point2> start;
  std::optional<Point2> goal;
  /// Of the area, that may stay uncovered: slivers beside slanted edges.
  double uncovered_share;

  double half() const { return spacing_m / 2; }
  double allowed() const { return uncovered_share * area.square_metres(); }
};

/// A tour as legs. Rows are the lines of a pattern; the other legs join them.
struct Flown {
  Ring2 points;
  std::vector<char> is_row;  ///< by leg
  double time_s = 1e300;

  std::size_t legs() const { return is_row.size(); }
  Segment leg(std::size_t i) const { return {points[i], points[i + 1]}; }
  /// Seconds of all legs.
  double seconds(const LegTime& time) const;
  /// Drops waypoints that repeat the one before.
  void drop_repeats();
  /// The points i..j replaced by others; the first and last leg stay what they were.
  void replace(std::size_t i, std::size_t j, const Ring2& by);
};

/// Stops and short legs that cover all of a gap, or if there are none, places in it.
std::vector<Segment> stops_for(const Problem& problem, const Area& area, const Swept& swept,
                               const std::vector<Point2>& gap);
/// Inserts stops into joins until no more than `allowed` square metres are uncovered, or none
/// helps.
void repair(const Problem& problem, const Area& area, Flown& flown, Swept& swept, double allowed);
/// Moves, merges and drops waypoints where that saves time and leaves all but `allowed` square
/// metres covered.
void polish(const Problem& problem, const Area& area, Flown& flown, Swept& swept, double allowed);
}  // namespace altiplan::cover
