// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sweep.hpp"

namespace altiplan::cover {

/// A part of a tour: of its legs, `needed` says which must be flown.
struct Flight {
  Ring2 points;
  std::vector<char> needed;
};

/// Cuts a closed tour into flights from one place and back to it, each within a capacity, of the
/// least total time; the place is the start, or else a waypoint. Empty: no place and no cuts do.
std::vector<Flight> flights_of(const Problem& problem, const Sweep& tour, double capacity_s);
}  // namespace altiplan::cover
