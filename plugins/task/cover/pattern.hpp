// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "flown.hpp"

namespace altiplan::cover {

/// Parallel rows at most a spacing apart, cut at islands; in the frame of the area turned by
/// `angle`, where rows run east. Beside them perhaps a column along one side, across the rows: a
/// closed tour comes back along it and covers a strip meanwhile.
struct Pattern {
  double angle = 0;
  int column = 0;  ///< -1: along the west side, 1: along the east side, 0: none
  std::vector<Segment> lines;
  double estimate_s = 0;  ///< of a tour, roughly
};

/// Patterns of several directions and positions, the most promising first.
std::vector<Pattern> patterns(const Problem& problem);
}  // namespace altiplan::cover
