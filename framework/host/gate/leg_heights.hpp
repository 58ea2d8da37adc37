// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/leg.hpp"
#include "altiplan/world.hpp"

namespace altiplan::host {

/// Heights above the ground, metres; not finite without ground below the whole leg.
struct LegHeights {
  double lowest = kInfinity;
  double highest = -kInfinity;
};

LegHeights leg_heights(const Leg& leg, const World& world);
}  // namespace altiplan::host
