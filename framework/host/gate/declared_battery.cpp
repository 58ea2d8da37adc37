// SPDX-License-Identifier: Apache-2.0
#include "host/gate/declared_battery.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/energy.hpp"

namespace altiplan::host {
namespace {

/// Through the air, in m/s.
struct FlownSpeeds {
  double top = 0;
  double up = 0;
  double down = 0;
};

FlownSpeeds speeds_of(const formats::MissionFile& plan, formats::Autopilot autopilot,
                      const FlightOptions& flight) {
  constexpr int kChangeSpeed = 178;
  const Parameters value(autopilot, flight.parameters);
  const auto of = [&](const char* px4, const char* ardupilot) {
    return value(autopilot.is_px4() ? px4 : ardupilot);
  };
  FlownSpeeds speeds{of("MPC_XY_CRUISE", "WP_SPD"), of("MPC_Z_V_AUTO_UP", "WP_SPD_UP"),
                     of("MPC_Z_V_AUTO_DN", "WP_SPD_DN")};
  for (const formats::MissionCommand& command : plan.commands) {
    if (command.number == kChangeSpeed && std::isfinite(command.params[1])) {
      for (double* speed : {&speeds.top, &speeds.up, &speeds.down}) {
        *speed = std::max(*speed, command.params[1]);
      }
    }
  }
  speeds.top += flight.wind_mps;
  return speeds;
}

/// Power of all flight within the speeds, on a grid.
void widen(Battery& battery, const Power& power, const FlownSpeeds& speeds) {
  constexpr int kSteps = 50;
  for (int i = 0; i <= kSteps; ++i) {
    for (int k = 0; k <= kSteps; ++k) {
      const double climb = -speeds.down + (speeds.up + speeds.down) * k / kSteps;
      for (const double height_m : {0.0, 3000.0}) {
        const double watts = power.watts({speeds.top * i / kSteps, climb, 0, height_m});
        battery.least_w = std::min(battery.least_w, watts);
        battery.power_w = std::max(battery.power_w, watts);
      }
    }
  }
}
}  // namespace

void take_battery(const Vehicle& vehicle, const formats::MissionFile& plan, GateOptions& options) {
  const Energy* energy = vehicle.energy.get();
  if (options.battery || energy == nullptr || !std::isfinite(energy->capacity_wh)) {
    return;
  }
  Battery battery;
  battery.capacity_wh = energy->capacity_wh * energy->usable;
  battery.reserve = energy->reserve;
  battery.least_w = kInfinity;
  const double still_w = energy->power->watts({1, 0, 0, 0});
  const bool is_mean = std::isfinite(still_w) && still_w == energy->power->watts({30, 3, 0, 3000});
  if (is_mean) {
    battery.least_w = battery.power_w = still_w;
  } else if (!plan.commands.empty() || options.firmware || options.airframe) {
    for (const formats::Autopilot autopilot :
         possible_autopilots(plan, options.firmware, options.airframe, options.flight.parameters)) {
      if (!autopilot.is_copter()) {
        options.battery_problem =
            "the battery: the power of " + autopilot.name() +
            " changes along the mission (give --battery and --power, or energy.power_w)";
        return;
      }
      widen(battery, *energy->power, speeds_of(plan, autopilot, options.flight));
    }
  }
  if (!std::isfinite(battery.power_w) || battery.power_w == 0) {
    options.battery_problem =
        "the battery: the vehicle's power is not known at all the speeds flown";
    return;
  }
  options.battery = battery;
}
}  // namespace altiplan::host
