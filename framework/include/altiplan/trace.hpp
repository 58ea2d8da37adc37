// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// One thing that a search did, for playback.
struct TraceEvent {
  enum class Kind { expanded, added, removed, rewired, iteration };
  Kind kind = Kind::expanded;
  std::int64_t node = -1;    ///< identity within this search
  std::int64_t parent = -1;  ///< -1: a root
  Vec3 position{0, 0, 0};
  double value = 0;  ///< f of an expanded node, cost of an added one, best length of an iteration
  // Of an iteration of a population; what is added after it, up to the next, is its routes.
  double mean = 0;          ///< length of the routes that it found, metres
  std::int64_t alive = -1;  ///< how many of it found one; -1: no population
};

/// Receives the events of one plan; a planner asks once whether there is one (a null pointer).
class ALTIPLAN_API Trace {
 public:
  virtual ~Trace();
  virtual void add(const TraceEvent& event) = 0;
};
}  // namespace altiplan
