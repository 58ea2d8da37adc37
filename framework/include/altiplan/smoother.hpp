// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/plan_result.hpp"
#include "altiplan/request.hpp"

namespace altiplan {

/// Turns a route into a better one with the same ends.
/// Laws: 1. First and last points stay. 2. For every constraint the worst excess does not grow; a
/// sound route stays sound. 3. Routes of one or two points come back as they are.
class ALTIPLAN_API Smoother {
 public:
  virtual ~Smoother();
  PlanResult smooth(const Route& route, const Request& request) const;

 private:
  virtual PlanResult do_smooth(const Route& route, const Request& request) const = 0;
};
}  // namespace altiplan
