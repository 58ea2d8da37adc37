// SPDX-License-Identifier: Apache-2.0
#include "host/mission/vehicle.hpp"

namespace altiplan::host {

Vehicle vehicle_of(const VehicleEntry& entry) {
  Vehicle vehicle;
  vehicle.radius_m = entry.radius_m;
  vehicle.speed_mps = entry.speed_mps;
  vehicle.sensing_m = entry.sensing_m.value_or(kInfinity);
  vehicle.turns_on_the_spot = entry.turns_on_the_spot;
  for (const SpeedNearEntry& near : entry.speed_near) {
    vehicle.speed_near.push_back({near.within_m, near.speed_mps});
  }
  if (const auto& wing = entry.wing) {
    vehicle.speed_mps = wing->airspeed_mps;
    vehicle.wing = {vehicle.speed_mps, radians(wing->bank_deg), radians(wing->climb_deg),
                    radians(wing->sink_deg), radians(wing->roll_rate_dps)};
  }
  return vehicle;
}

Wind wind_of(const WindEntry& entry) {
  const auto velocity = [](double from_deg, double speed_mps) -> Vec3 {
    return -speed_mps * unit_heading(radians(90 - from_deg));
  };
  Wind wind;
  if (entry.from_deg && *entry.speed_mps > 0) {
    wind.layers.push_back({-kInfinity, velocity(*entry.from_deg, *entry.speed_mps)});
  }
  for (const auto& [above_m, from_deg, speed_mps] : entry.layers) {
    wind.layers.push_back({above_m, velocity(from_deg, speed_mps)});
  }
  return wind;
}
}  // namespace altiplan::host
