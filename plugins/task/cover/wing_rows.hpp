// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "swept.hpp"

namespace altiplan::cover {

/// What an aeroplane covers, and how it turns.
struct WingProblem {
  struct Field {
    Area area;     ///< which rows keep within, but for their ends beyond the outline
    Area outline;  ///< without islands
  };
  std::vector<Field> fields;
  double spacing_m;
  double beyond_m;  ///< by which rows go on beyond the outline
  double radius_m;  ///< of turns
  std::optional<Point2> start;
  std::optional<Point2> goal;
  bool closed;
};

/// A straight row.
struct WingRow {
  Segment line;
  bool leads[2] = {false, false};  ///< at its ends: it goes on beyond the outline

  double length() const { return (line.b - line.a).norm(); }
};

/// Rows in the order and direction in which they are flown.
struct WingRows {
  std::vector<WingRow> rows;  ///< none: none within the budget
  std::uint64_t iterations = 0;
  bool is_complete = true;  ///< all attempts were made
  std::string message{};    ///< no rows: why one of the shortest direction cannot be flown
};

/// Covers areas by straight rows of one direction, which reach as far as the strip about each does.
/// They are ordered by a travelling-salesman search that counts Dubins's paths from row to row, in
/// still air. Directions are those of an outline's edges and each twelfth of a half turn, those
/// first whose rows, with a turn for each, are shortest; of those in which `refusal` of every row
/// is "", `attempts` are tried. `spent(iterations)` ends it; attempts are whole.
WingRows wing_rows(const WingProblem& problem, int attempts, std::uint64_t seed,
                   const std::function<std::string(const WingRow&)>& refusal,
                   const std::function<bool(std::uint64_t)>& spent);
}  // namespace altiplan::cover
