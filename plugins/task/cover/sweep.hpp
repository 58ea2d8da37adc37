// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "flown.hpp"

namespace altiplan::cover {

/// The fastest tour found, and what bounds it.
struct Sweep {
  Flown flown;               ///< no points: none within the budget
  std::vector<char> needed;  ///< by leg: it covers what no other leg does
  double bound_s = 0;        ///< of all tours that fly the same rows
  std::uint64_t iterations = 0;
  bool is_complete = true;  ///< all attempts were made
};

/// Covers an area. Patterns of parallel rows are tried, each of them so: a travelling-salesman
/// search orders the rows, counting the fastest joins around islands and what those cover beside
/// slanted edges; stops are inserted where gaps are left; waypoints move to where they save time.
/// `spent(iterations)` ends it: attempts are whole, so that more of them never give a slower tour.
Sweep sweep(const Problem& problem, int attempts, std::uint64_t seed,
            const std::function<bool(std::uint64_t)>& spent);
}  // namespace altiplan::cover
