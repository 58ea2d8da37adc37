// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/world.hpp"
#include "link/link.hpp"

namespace altiplan::link {

/// Where a vehicle is to fly now, in local metres.
struct SetPoint {
  Vec3 velocity{0, 0, 0};  ///< of a multirotor, which hovers when none follows
  Vec3 position{0, 0, 0};  ///< of an aeroplane, which circles there when none follows
  double radius_m = 0;     ///< of that circle
};

/// The message for it that the autopilot takes, once it is in its commanded mode.
Message set_point(const Vehicle& vehicle, const SetPoint& wanted, const Frame& frame);
}  // namespace altiplan::link
