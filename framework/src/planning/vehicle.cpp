// SPDX-License-Identifier: Apache-2.0
#include "altiplan/vehicle.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/body.hpp"
#include "altiplan/energy.hpp"

namespace altiplan {

double Wing::turn_radius() const {
  constexpr double kGravity = 9.80665;
  return airspeed_mps * airspeed_mps / (kGravity * std::tan(bank));
}

Power::~Power() = default;

double Vehicle::reach_m() const {
  return body != nullptr ? std::max(radius_m, body->outer_m()) : radius_m;
}

double Vehicle::max_speed() const {
  double fastest = speed_mps;
  for (const SpeedNear& near : speed_near) {
    fastest = std::max(fastest, near.speed_mps);
  }
  return fastest;
}

double Vehicle::speed_at(double distance_m) const {
  for (const SpeedNear& near : speed_near) {
    if (distance_m <= near.within_m) {
      return near.speed_mps;
    }
  }
  return speed_mps;
}
}  // namespace altiplan
