// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// One search event, for playback.
struct TraceEvent {
  enum class Kind { expanded, added, removed, rewired, iteration };
  Kind kind = Kind::expanded;
  std::int64_t node = -1;    ///< id within this search
  std::int64_t parent = -1;  ///< -1 for a root
  Vec3 position{0, 0, 0};
  double value = 0;  ///< f of an expanded node, cost of an added node, best length of an iteration
  // Iterations of population-based planners only; the nodes added after one, up to the next, are
  // its routes.
  double mean = 0;          ///< mean length of the routes found, metres
  std::int64_t alive = -1;  ///< number of individuals that found a route; -1: no population
};

/// Receives the events of one plan; null where no trace is recorded, which a planner checks once.
class ALTIPLAN_API Trace {
 public:
  virtual ~Trace();
  virtual void add(const TraceEvent& event) = 0;
};
}  // namespace altiplan
