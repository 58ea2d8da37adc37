// SPDX-License-Identifier: Apache-2.0
#include "altiplan/formats/mission_commands.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace altiplan::formats {
namespace {

constexpr const char* kAll = "......";
constexpr const char* kNobody = "UUUUUU";
constexpr const char* kArduPilot = "...UUU";
constexpr const char* kPx4 = "UUU...";

/// Sorted by number. ArduPilot: AP_Mission::mavlink_int_to_mission_cmd and start_command of the
/// vehicles; PX4: parse_mavlink_mission_item, FeasibilityChecker and MissionBlock.
const std::vector<CommandTask>& table() {
  static const std::vector<CommandTask> kRows{
      {0, "complex item", Task::other, kNobody},
      {16, "waypoint", Task::waypoint, kAll},
      {17, "loiter", Task::loiter_forever, kAll},
      {18, "loiter", Task::loiter_turns, kArduPilot},
      {19, "loiter", Task::loiter_time, kAll},
      {20, "return to launch", Task::return_home, kAll},
      {21, "landing", Task::land, kAll},
      {22, "take-off", Task::take_off, kAll},
      {23, "local landing", Task::other, kNobody},
      {24, "local take-off", Task::other, kNobody},
      {25, "follow", Task::other, kNobody},
      {30, "continue and change altitude", Task::change_altitude, "K..UUU"},
      {31, "loiter", Task::loiter_to_altitude, kAll},
      {32, "follow", Task::other, kNobody},
      {33, "follow", Task::other, kNobody},
      {34, "orbit", Task::other, kNobody},
      {35, "figure eight", Task::other, kNobody},
      {36, "arc waypoint", Task::arc, ".KKUUU"},
      {80, "region of interest", Task::payload, kAll},
      {81, "path planning", Task::other, kNobody},
      {82, "spline", Task::spline, ".UUUUU"},
      {83, "altitude wait", Task::other, "K??UUU"},
      {84, "VTOL take-off", Task::vtol_take_off, ".K.XX."},
      {85, "VTOL landing", Task::vtol_land, ".K.XX."},
      {92, "guided", Task::other, "?KKUUU"},
      {93, "delay", Task::delay, kAll},
      {94, "payload place", Task::payload_place, ".K.UUU"},
      {112, "condition delay", Task::condition, "...XXX"},
      {114, "condition distance", Task::condition, "...XXX"},
      {115, "condition yaw", Task::payload, ".KKUUU"},
      {176, "mode", Task::other, kNobody},
      {177, "jump", Task::jump, kAll},
      {178, "speed", Task::speed, kAll},
      {179, "set home", Task::set_home, kAll},
      {181, "relay", Task::payload, kArduPilot},
      {182, "repeat relay", Task::payload, kArduPilot},
      {183, "servo", Task::payload, kArduPilot},
      {184, "repeat servo", Task::payload, kArduPilot},
      {187, "actuator", Task::payload, kPx4},
      {188, "return path start", Task::payload, kArduPilot},
      {189, "landing start", Task::landing_start, kAll},
      {191, "go around", Task::payload, "K..UUU"},
      {192, "reposition", Task::other, kNobody},
      {193, "pause", Task::payload, "KKKUUU"},
      {194, "reverse", Task::payload, "KKKUUU"},
      {195, "region of interest", Task::payload, kAll},
      {196, "region of interest offset", Task::payload, kPx4},
      {197, "no region of interest", Task::payload, kAll},
      {200, "video", Task::payload, kPx4},
      {201, "region of interest", Task::payload, kAll},
      {202, "camera", Task::payload, kArduPilot},
      {203, "camera", Task::payload, kAll},
      {204, "mount", Task::payload, kPx4},
      {205, "mount", Task::payload, kAll},
      {206, "camera trigger", Task::payload, kAll},
      {207, "fence", Task::fence, kArduPilot},
      {208, "parachute", Task::parachute, kArduPilot},
      {210, "inverted flight", Task::payload, "K..UUU"},
      {211, "gripper", Task::payload, kAll},
      {212, "autotune", Task::payload, "K..UUU"},
      {213, "yaw speed", Task::payload, "KKKUUU"},
      {214, "camera trigger interval", Task::payload, kPx4},
      {215, "resume distance", Task::payload, kArduPilot},
      {216, "sprayer", Task::payload, kArduPilot},
      {217, "script message", Task::payload, kArduPilot},
      {218, "auxiliary function", Task::other, "???UUU"},
      {222, "guided limits", Task::payload, ".KKUUU"},
      {223, "engine", Task::engine, "K..UUU"},
      {260, "oblique survey", Task::payload, kPx4},
      {400, "arm or disarm", Task::arm, kPx4},
      {530, "camera mode", Task::payload, kPx4},
      {531, "camera zoom", Task::payload, kArduPilot},
      {532, "camera focus", Task::payload, kAll},
      {534, "camera source", Task::payload, kAll},
      {600, "jump tag", Task::jump_tag, kArduPilot},
      {601, "jump to tag", Task::jump_to_tag, kArduPilot},
      {1000, "gimbal", Task::payload, kAll},
      {1001, "gimbal configuration", Task::payload, kPx4},
      {2000, "camera", Task::payload, kAll},
      {2001, "camera", Task::payload, kAll},
      {2003, "camera trigger", Task::payload, kPx4},
      {2500, "video", Task::payload, kAll},
      {2501, "video", Task::payload, kAll},
      {3000, "VTOL transition", Task::transition, "KK.XX."},
      {4501, "gate", Task::payload, kPx4},
      {5000, "fence", Task::other, "UUUXXX"},
      {42600, "winch", Task::payload, ".KK..."},
      {42702, "script", Task::other, "???UUU"},
      {42703, "attitude", Task::other, "?KKUUU"},
  };
  return kRows;
}

const CommandTask kUnknown{-1, "command", Task::other, kNobody};
}  // namespace

std::string Autopilot::name() const {
  const std::string kind = airframe == Airframe::copter  ? "copter"
                           : airframe == Airframe::plane ? "plane"
                                                         : "VTOL";
  return (is_px4() ? "PX4 " : "ArduPilot ") + kind;
}

bool MissionCommand::has_position() const {
  return std::isfinite(lon) && std::isfinite(lat) && (lon != 0 || lat != 0);
}

Effect CommandTask::effect(Autopilot autopilot) const {
  const std::size_t column = (autopilot.is_px4() ? 3 : 0) + std::size_t(autopilot.airframe);
  switch (effects[column]) {
    case '.':
      return Effect::done;
    case 'K':
      return Effect::dropped;
    case 'X':
      return Effect::infeasible;
    case '?':
      return Effect::unforeseeable;
    default:
      return Effect::refused;
  }
}

const CommandTask& command_task(int number) {
  const auto& rows = table();
  const auto row = std::lower_bound(rows.begin(), rows.end(), number,
                                    [](const CommandTask& r, int n) { return r.number < n; });
  return row != rows.end() && row->number == number ? *row : kUnknown;
}

bool flies_to_position(Task task) {
  switch (task) {
    case Task::waypoint:
    case Task::spline:
    case Task::arc:
    case Task::loiter_forever:
    case Task::loiter_turns:
    case Task::loiter_time:
    case Task::loiter_to_altitude:
    case Task::take_off:
    case Task::vtol_take_off:
    case Task::land:
    case Task::vtol_land:
    case Task::payload_place:
      return true;
    default:
      return false;
  }
}
}  // namespace altiplan::formats
