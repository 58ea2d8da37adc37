// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "altiplan/api.hpp"

/// \file What autopilots do with the commands of a mission.
namespace altiplan::formats {

enum class Firmware { ardupilot, px4 };
enum class Airframe { copter, plane, vtol };

/// Who flies a mission.
struct ALTIPLAN_API Autopilot {
  Firmware firmware = Firmware::ardupilot;
  Airframe airframe = Airframe::copter;

  bool is_px4() const { return firmware == Firmware::px4; }
  bool is_copter() const { return airframe == Airframe::copter; }
  /// "ArduPilot copter"
  std::string name() const;
  bool operator==(const Autopilot&) const = default;
};

/// One item of a mission file, as an autopilot is sent it.
struct ALTIPLAN_API MissionCommand {
  int number = 0;                  ///< MAV_CMD; 0: a complex item that contains no commands
  int frame = 0;                   ///< MAV_FRAME
  std::array<double, 4> params{};  ///< NaN where the file leaves them to the autopilot
  double lon = 0;                  ///< degrees; both 0, or not finite: none given
  double lat = 0;
  double altitude_m = 0;
  std::string place{};  ///< position in the file, for messages: "mission.items.3", "line 5"
  int item = 0;         ///< as ground stations show it; 0: the format numbers nothing
  bool auto_continue = true;

  bool has_position() const;
};

/// What becomes of a command.
enum class Effect {
  done,          ///< as its task says
  dropped,       ///< stored, and skipped in flight
  refused,       ///< at upload, with the whole mission
  infeasible,    ///< uploaded, then the mission is declared invalid
  unforeseeable  ///< another program decides what the vehicle does
};

/// What a command is for.
enum class Task {
  payload,  ///< or a marker: the vehicle's motion is not concerned
  waypoint,
  spline,
  arc,
  loiter_forever,
  loiter_turns,
  loiter_time,
  loiter_to_altitude,
  take_off,
  vtol_take_off,
  land,
  vtol_land,
  payload_place,
  return_home,
  change_altitude,  ///< on the same course, until a height is reached
  delay,
  condition,  ///< delays the next commands that move nothing
  jump,
  jump_tag,
  jump_to_tag,
  speed,
  set_home,
  fence,
  parachute,
  engine,
  arm,
  transition,
  landing_start,
  other  ///< flown nowhere by any of the autopilots, or somewhere by none of them
};

/// A row of the table.
struct ALTIPLAN_API CommandTask {
  int number;  ///< MAV_CMD
  const char* name;
  Task task;
  /// One letter for each of ArduPilot's copter, plane, quadplane, PX4's copter, plane, VTOL: '.'
  /// done, K dropped, U refused, X infeasible, ? unforeseeable.
  const char* effects;

  Effect effect(Autopilot autopilot) const;
};

/// The row of a command; that of an unknown one is refused by all.
ALTIPLAN_API const CommandTask& command_task(int number);

/// True for a MAV_FRAME in which heights are relative to home, or above the ground.
inline bool is_of_home(int frame) { return frame == 3 || frame == 6; }
inline bool is_above_ground(int frame) { return frame == 10 || frame == 11; }

/// True for a task whose position the vehicle flies to.
ALTIPLAN_API bool flies_to_position(Task task);
}  // namespace altiplan::formats
