// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "altiplan/check.hpp"

namespace altiplan::host {

/// A change of a waypoint's height.
struct Cure {
  std::size_t waypoint = 0;
  double by_m = 0;  ///< a multiple of 0.1 m; positive: up
};

/// The least change of one waypoint's height, of at most 1,000 m, with which the violated leg and
/// the other leg at that waypoint are valid; none if there is none, or the route has turns.
std::optional<Cure> cure(const Route& route, const Violation& violation, const Request& request);
}  // namespace altiplan::host
