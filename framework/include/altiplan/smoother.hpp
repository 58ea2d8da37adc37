// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/plan_result.hpp"
#include "altiplan/request.hpp"

namespace altiplan {

/// Improves a route and keeps its ends.
/// Contract: 1. First and last points stay. 2. The worst excess of each constraint does not grow; a
/// valid route stays valid. 3. Straight routes of one or two points are returned unchanged. 4.
/// Under an objective a valid route's cost does not grow: smooth sees to it, and that no moving
/// obstacle is met; a route that waits is returned unchanged.
class ALTIPLAN_API Smoother {
 public:
  virtual ~Smoother();
  PlanResult smooth(const Route& route, const Request& request) const;

 private:
  virtual PlanResult do_smooth(const Polyline& route, const Request& request) const = 0;
  /// Smooths a route that has turns. Default: returns it unchanged, and says so.
  virtual PlanResult do_smooth_turns(const Route& route, const Request& request) const;
};
}  // namespace altiplan
