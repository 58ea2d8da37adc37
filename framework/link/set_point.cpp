// SPDX-License-Identifier: Apache-2.0
#include "link/set_point.hpp"

#include <cmath>

#include "link/flight_mode.hpp"
#include "link/vehicle_words.hpp"

namespace altiplan::link {
namespace {

// Of POSITION_TARGET_TYPEMASK: what is to be ignored.
constexpr std::uint16_t kAllButVelocity = 0xdc7;
constexpr std::uint16_t kAllButPosition = 0xdf8;
// Of MAV_FRAME: above sea level.
constexpr std::uint8_t kGlobal = 0;
constexpr std::uint8_t kGlobalInt = 5;

struct Place {
  std::int32_t lat;
  std::int32_t lon;
};

Place place_of(const Vec3& position, const Frame& frame) {
  const auto [lon, lat] = frame.to_lonlat(position.x(), position.y());
  return {static_cast<std::int32_t>(std::lround(lat * 1e7)),
          static_cast<std::int32_t>(std::lround(lon * 1e7))};
}

/// ArduPilot's planes take positions by this command alone.
CommandInt reposition(const Vehicle& vehicle, const SetPoint& wanted, const Frame& frame) {
  CommandInt command;
  command.target_system = vehicle.address.system;
  command.target_component = vehicle.address.component;
  command.frame = kGlobal;
  command.command = VehicleCommand::kReposition;
  command.param1 = -1;  // speed: as before
  command.param3 = static_cast<float>(wanted.radius_m);
  command.param4 = std::nanf("");
  const auto [lat, lon] = place_of(wanted.position, frame);
  command.x = lat;
  command.y = lon;
  command.z = static_cast<float>(wanted.position.z());
  return command;
}
}  // namespace

Message set_point(const Vehicle& vehicle, const SetPoint& wanted, const Frame& frame) {
  const bool is_plane = is_fixed_wing(vehicle.heartbeat);
  if (is_plane && vehicle.is_ardupilot()) {
    return reposition(vehicle, wanted, frame);
  }
  SetPositionTargetGlobalInt target;
  target.target_system = vehicle.address.system;
  target.target_component = vehicle.address.component;
  target.coordinate_frame = kGlobalInt;
  target.type_mask = is_plane ? kAllButPosition : kAllButVelocity;
  if (is_plane) {
    const auto [lat, lon] = place_of(wanted.position, frame);
    target.lat_int = lat;
    target.lon_int = lon;
    target.alt = static_cast<float>(wanted.position.z());
  } else {
    target.vx = static_cast<float>(wanted.velocity.y());
    target.vy = static_cast<float>(wanted.velocity.x());
    target.vz = static_cast<float>(-wanted.velocity.z());
  }
  return target;
}
}  // namespace altiplan::link
