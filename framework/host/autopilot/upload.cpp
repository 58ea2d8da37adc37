// SPDX-License-Identifier: Apache-2.0
#include "host/autopilot/upload.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/base/words.hpp"

namespace altiplan::host {
namespace {

using formats::Autopilot;
using formats::command_task;
using formats::CommandTask;
using formats::Effect;
using formats::MissionCommand;
using formats::Task;
using Weight = Remark::Weight;

MissionCommand stored_one(MissionCommand command, Autopilot autopilot) {
  constexpr double kDegrees = 1e7;
  command.lat = std::round(command.lat * kDegrees) / kDegrees;
  command.lon = std::round(command.lon * kDegrees) / kDegrees;
  if (autopilot.is_px4()) {
    command.altitude_m = double(float(command.altitude_m));
    return command;
  }
  command.altitude_m =
      std::trunc(command.altitude_m * 100 + (command.altitude_m > 0 ? 1e-6 : -1e-6)) / 100;
  auto& p = command.params;
  const auto whole = [](double& value, double maximum) {
    value = std::isfinite(value) ? std::clamp(std::trunc(value), -maximum, maximum) : value;
  };
  switch (command_task(command.number).task) {
    case Task::waypoint:
      whole(p[0], 65535);
      whole(p[1], 255);
      whole(p[2], 255);
      break;
    case Task::loiter_forever:
      whole(p[2], 65535);
      break;
    case Task::loiter_turns:
      if (!(p[0] > 0 && p[0] < 1)) {
        whole(p[0], 255);
      }
      p[2] = std::abs(p[2]) > 255 ? std::trunc(p[2] / 10) * 10 : std::trunc(p[2]);
      p[2] = std::clamp(p[2], -2550.0, 2550.0);
      break;
    case Task::loiter_time:
      whole(p[0], 65535);
      break;
    case Task::arc:
      whole(p[0], 32767);
      break;
    case Task::loiter_to_altitude:
      whole(p[1], 65535);
      break;
    case Task::speed:  // a byte, which begins anew after 255
      p[0] = std::abs(p[0]) < 1e9 ? double(std::uint8_t(std::int64_t(p[0]))) : p[0];
      break;
    case Task::set_home:
    case Task::parachute:
    case Task::fence:
      whole(p[0], 65535);
      break;
    default:
      break;
  }
  return command;
}

/// What is refused before anything is flown.
class UploadCheck {
 public:
  UploadCheck(const Sequence& commands, Flight& flight)
      : commands_(commands), flight_(flight), autopilot_(flight.autopilot()) {}

  /// What PX4 declares invalid of a whole mission (FeasibilityChecker); false if anything is.
  bool check_feasibility();

  /// What boards store, and of jumps run: ArduPilot's home is an item.
  void check_counts() {
    const std::size_t items = commands_.size() + (is_px4() ? 0 : 1);
    const std::size_t last = commands_.size() - 1;
    const std::string count = std::to_string(items) + " items";
    if (items > (is_px4() ? 1000 : 1312)) {
      refuse(last, "refuses " + count +
                       (is_px4() ? ": it stores 500, some boards 1,000"
                                 : ", unless the board has an SD card"));
    } else if (items > (is_px4() ? 500 : 650)) {
      flight_.remark(Weight::not_judged, "items", last,
                     "whether the board stores " + count + " is not judged: " +
                         (is_px4() ? "most store 500" : "some store 303, 650 or 1,306"));
    } else if (items > 303 && !is_px4()) {
      flight_.remark(Weight::note, "items", last, "boards of 8 kB refuse " + count + " (303)");
    }
    std::size_t jumps = 0;
    for (std::size_t n = 0; n < commands_.size(); ++n) {
      jumps += commands_.is_jump(n);
    }
    if (jumps > 15 && !is_px4()) {
      flight_.remark(Weight::not_judged, "items", last,
                     "some boards run 15 jumps, others 100: what " + std::to_string(jumps) +
                         " jumps fly is not judged");
    }
    for (std::size_t n = 0; n < commands_.size() && !is_px4(); ++n) {
      check_nested_jumps(n);
    }
  }

  /// Newer versions count the jumps within a jump anew each time.
  void check_nested_jumps(std::size_t n) {
    const auto is_counted = [&](std::size_t i) {
      return commands_.is_jump(i) && commands_[i].params[1] >= 1;
    };
    const auto target = is_counted(n) ? commands_.target_of(n) : std::nullopt;
    for (std::size_t inner = target.value_or(n); inner < n; ++inner) {
      if (is_counted(inner)) {
        flight_.remark(Weight::not_judged, "not_judged", n,
                       "how often a jump within this one is made differs between versions, which "
                       "is not judged");
        return;
      }
    }
  }

  /// QuadPlanes do not arm with a landing so near to the waypoint before it.
  void check_braking(std::size_t n) {
    const Task task = commands_.task_of(n).task;
    if (is_px4() || autopilot_.airframe != formats::Airframe::vtol || n == 0 ||
        (task != Task::vtol_land && task != Task::land) ||
        commands_.task_of(n - 1).task != Task::waypoint) {
      return;
    }
    const double v = flight_.parameter("AIRSPEED_CRUISE");
    const double limit = 0.75 * v * v / (2 * kVtolBrakes);
    const double distance = distance_between(n - 1, n);
    if (distance < limit) {
      flight_.remark(Weight::fails, "arming", n,
                     autopilot_.name() +
                         " does not arm with a landing nearer to the waypoint before it than it "
                         "can slow down",
                     distance, limit);
    }
  }

  /// ArduPilot's aeroplanes do not arm with a landing sequence that a return does not use.
  void check_landing_start(std::size_t n) {
    const bool is_start =
        commands_.task_of(n).task == Task::landing_start || commands_[n].number == 188;
    if (!is_start || is_px4() || autopilot_.is_copter() || flight_.parameter("RTL_AUTOLAND") != 0) {
      return;
    }
    const bool is_given = flight_.is_given("RTL_AUTOLAND");
    flight_.remark(
        is_given ? Weight::fails : Weight::not_judged, "arming", n,
        autopilot_.name() + " does not arm with this command unless RTL_AUTOLAND is set");
  }

  /// ArduPilot stores seconds in 16 bits; what it makes of others depends on the board.
  void check_hold(std::size_t n) {
    constexpr double kMaxHold = 65535;  // stored for anything longer
    const Task task = commands_.task_of(n).task;
    const double hold = commands_[n].params[0];
    const bool holds = task == Task::loiter_time ||
                       ((task == Task::waypoint || task == Task::spline) && autopilot_.is_copter());
    if (holds && !is_px4() && (hold < 0 || hold >= kMaxHold)) {
      flight_.remark(Weight::not_judged, "not_judged", n,
                     "how long it holds is not judged: ArduPilot stores up to 65534 s");
    }
  }

  /// Reports what is wrong with a command; false if the mission is not flown because of it.
  bool check(std::size_t n) {
    const MissionCommand& command = commands_[n];
    const CommandTask& row = commands_.task_of(n);
    const std::string who = autopilot_.name();
    const auto refuse = [&](const char* rule, const std::string& why) {
      flight_.remark(Weight::fails, rule, n, who + " " + why);
      return false;
    };
    if (command.number == 0) {
      flight_.remark(Weight::not_judged, "not_judged", n,
                     "where this flies is not judged: the file has no commands of it");
      return false;
    }
    check_landing_start(n);
    check_braking(n);
    check_hold(n);
    switch (row.effect(autopilot_)) {
      case Effect::refused:
        return refuse("refused", "refuses the mission at upload because of command " +
                                     std::to_string(command.number));
      case Effect::infeasible:
        return refuse("refused", "declares the mission invalid because of command " +
                                     std::to_string(command.number));
      case Effect::unforeseeable:
        return refuse("unforeseeable", "leaves to another program where this flies");
      case Effect::dropped:
        flight_.remark(Weight::note, "dropped", n, who + " skips this command");
        return true;
      case Effect::done:
        break;
    }
    return check_frame(n, refuse) && check_numbers(n, refuse) && check_flow(n, refuse);
  }

 private:
  template <class Refuse>
  bool check_frame(std::size_t n, const Refuse& refuse) {
    const MissionCommand& command = commands_[n];
    const int frame = command.frame;
    const bool flies = formats::flies_to_position(commands_.task_of(n).task);
    const bool is_global = frame == 0 || frame == 3 || frame == 5 || frame == 6;
    const std::string words = "refuses the frame " + std::to_string(frame) + " of this command";
    if (is_px4()) {
      const bool has_place = command.number == 195 || command.number == 201 ||
                             command.number == 189 || command.number == 179 ||
                             command.number == 4501 || command.number == 80;
      const bool fits = flies ? is_global : has_place ? is_global || frame == 2 : frame == 2;
      return fits || refuse("refused", words);
    }
    return !flies || is_global || frame == 2 || formats::is_above_ground(frame) ||
           refuse("refused", words);
  }

  template <class Refuse>
  bool check_numbers(std::size_t n, const Refuse& refuse) {
    const MissionCommand& command = commands_[n];
    const Task task = commands_.task_of(n).task;
    const bool flies = formats::flies_to_position(task);
    if (!is_px4()) {
      const bool leaves_yaw = command.number == 16 || command.number == 17 ||
                              command.number == 21 || command.number == 22 ||
                              command.number == 84 || command.number == 85;
      for (std::size_t p = 0; p < command.params.size(); ++p) {
        const bool may = (p == 3 && leaves_yaw) || (p == 2 && command.number == 85);
        if (std::isnan(command.params[p]) && !may) {
          return refuse("refused", "refuses the mission: parameter " + std::to_string(p + 1) +
                                       " of this command is not a number");
        }
      }
    } else if (flies && !command.has_position() && task != Task::take_off &&
               task != Task::vtol_take_off) {
      return refuse("position", "flies to latitude 0, longitude 0: this command has no position");
    }
    if (flies && !(std::abs(command.altitude_m) < 83'000)) {
      return refuse("refused", "refuses the altitude of this command");
    }
    return true;
  }

  template <class Refuse>
  bool check_flow(std::size_t n, const Refuse& refuse) {
    const MissionCommand& command = commands_[n];
    if (is_px4() && !command.auto_continue && n + 1 < commands_.size()) {
      return refuse("never_ends", "stops here for ever (autoContinue is false)");
    }
    const Task task = commands_.task_of(n).task;
    if (is_px4() && task == Task::set_home && command.params[0] != 1) {
      return refuse("set_home", "sets a wrong home where a command gives its place");
    }
    if (task == Task::set_home && !std::isfinite(command.altitude_m + command.lon + command.lat) &&
        command.params[0] != 1) {
      return refuse("set_home", "refuses a home that is not a place");
    }
    if (task == Task::jump && !commands_.target_of(n)) {
      return refuse("refused", "finds no item to jump to");
    }
    if (task == Task::jump && commands_.has_rival(*commands_.target_of(n))) {
      return refuse("refused", "finds several items of that number to jump to");
    }
    if ((task == Task::arm && command.params[0] == 0) ||
        (task == Task::engine && !(command.params[0] > 0) && !autopilot_.is_copter())) {
      return refuse("unforeseeable", "stops the motor here");
    }
    return true;
  }

  bool refuse(std::size_t n, const std::string& why) {
    flight_.remark(Weight::fails, "refused", n, autopilot_.name() + " " + why);
    return false;
  }

  /// Height above sea level of a command's altitude.
  double height_of(std::size_t n) const {
    const MissionCommand& command = commands_[n];
    return command.altitude_m + (formats::is_of_home(command.frame) ? flight_.home_ground : 0);
  }

  double distance_between(std::size_t a, std::size_t b) const {
    return geodesic_course({commands_[a].lon, commands_[a].lat},
                           {commands_[b].lon, commands_[b].lat})
        .metres;
  }

  bool check_landing(std::size_t n, std::size_t before);

  bool is_px4() const { return autopilot_.is_px4(); }

  const Sequence& commands_;
  Flight& flight_;
  Autopilot autopilot_;
};

bool UploadCheck::check_landing(std::size_t n, std::size_t before) {
  constexpr double kMaxSlope = 5.1;  // degrees: FW_LND_ANG and a tenth
  const Task task = commands_.task_of(before).task;
  if (task != Task::waypoint && task != Task::loiter_to_altitude) {
    return refuse(n, "begins a landing at a waypoint or a loiter to altitude alone");
  }
  const Frame& frame = flight_.world().frame();
  const auto [x, y] = frame.to_local(commands_[n].lon, commands_[n].lat);
  const auto [from_x, from_y] = frame.to_local(commands_[before].lon, commands_[before].lat);
  const double drop = height_of(before) - height_of(n);
  const double run = std::hypot(x - from_x, y - from_y);
  return (drop > 0 && drop <= run * std::tan(radians(kMaxSlope))) ||
         refuse(n, "lands on a slope of 5.1 degrees or less alone, down from the item before");
}

bool UploadCheck::check_feasibility() {
  std::optional<std::size_t> before;  // the last position
  std::optional<std::size_t> beside;  // the last position or gate
  std::size_t starts = 0;
  bool lands = false;
  bool is_valid = true;
  for (std::size_t n = 0; n < commands_.size(); ++n) {
    constexpr double kApart = 0.05;  // metres
    constexpr int kGate = 4501;
    const Task task = commands_.task_of(n).task;
    const bool is_gate = commands_[n].number == kGate;
    if (beside && (is_gate || formats::flies_to_position(task)) &&
        (is_gate || commands_[*beside].number == kGate) && distance_between(*beside, n) < kApart) {
      is_valid = refuse(n, "refuses a gate so near to another item");
    }
    if (is_gate || formats::flies_to_position(task)) {
      beside = n;
    }
    const bool is_take_off = task == Task::take_off || task == Task::vtol_take_off;
    const bool is_landing = task == Task::land || task == Task::vtol_land;
    starts += task == Task::landing_start;
    lands = lands || is_landing;
    if (task == Task::return_home && starts > 0) {
      is_valid = refuse(n, "refuses a return behind a landing start");
    }
    if (is_take_off && before) {
      is_valid = refuse(n, "takes off at the first position of a mission alone");
    }
    if (is_take_off && height_of(n) <= flight_.home_ground) {
      is_valid =
          refuse(n, "takes off to a height above home alone, and this is " +
                        with_decimals(flight_.home_ground - height_of(n), 1) + " m below it");
    }
    if (is_landing && !before) {
      is_valid = refuse(n, "refuses a mission that begins with a landing");
    }
    if (task == Task::land && before && autopilot_.airframe == formats::Airframe::plane) {
      is_valid = check_landing(n, *before) && is_valid;
    }
    before = formats::flies_to_position(task) ? std::optional(n) : before;
  }
  constexpr double kLanding = 2;  // and above: a landing, or both
  const double required = autopilot_.is_copter() ? 0 : flight_.parameter("MIS_TKO_LAND_REQ");
  if (before && required >= kLanding && !lands) {
    is_valid = refuse(*before, "refuses a mission without a landing (MIS_TKO_LAND_REQ)");
  }
  if (before && (starts > 1 || (starts > 0 && !lands))) {
    is_valid = refuse(*before, "refuses two landing starts, and one without a landing");
  }
  return is_valid;
}
}  // namespace

std::vector<MissionCommand> stored(std::vector<MissionCommand> commands, Autopilot autopilot) {
  for (MissionCommand& command : commands) {
    command = stored_one(std::move(command), autopilot);
  }
  return commands;
}

bool check_upload(const Sequence& commands, Flight& flight) {
  UploadCheck check(commands, flight);
  bool is_taken = true;
  if (commands.size() > 0) {
    check.check_counts();
  }
  for (std::size_t n = 0; n < commands.size(); ++n) {
    is_taken = check.check(n) && is_taken;
  }
  return (!flight.autopilot().is_px4() || check.check_feasibility()) && is_taken;
}
}  // namespace altiplan::host
