// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "altiplan/formats/mission_commands.hpp"

namespace altiplan::host {

/// The commands of a mission in the order in which they are carried out: with its jumps.
class Sequence {
 public:
  Sequence(std::vector<formats::MissionCommand> commands, formats::Autopilot autopilot)
      : commands_(std::move(commands)), autopilot_(autopilot) {}

  std::size_t size() const { return commands_.size(); }
  const formats::MissionCommand& operator[](std::size_t n) const { return commands_[n]; }
  const formats::CommandTask& task_of(std::size_t n) const {
    return formats::command_task(commands_[n].number);
  }
  /// True for a command that the autopilot neither skips nor refuses.
  bool is_done(std::size_t n) const {
    return task_of(n).effect(autopilot_) == formats::Effect::done;
  }

  bool is_jump(std::size_t n) const;
  /// The command that a jump leads to, if there is one.
  std::optional<std::size_t> target_of(std::size_t n) const;
  /// True if another command has the number of this one.
  bool has_rival(std::size_t n) const {
    return std::count_if(commands_.begin(), commands_.end(), [&](const auto& command) {
             return command.item == commands_[n].item;
           }) > 1;
  }
  /// The command after a jump, which is counted; none for a jump that has been made twice and is
  /// made for ever.
  std::optional<std::size_t> after_jump(std::size_t n);
  /// Counts all that are left of a jump as made, and returns their number; 0 for one without end.
  int make_all_jumps(std::size_t n);
  /// The next position as the autopilot looks ahead, if there is one: ArduPilot takes an order that
  /// a jump leads to for the end of the round.
  std::optional<std::size_t> next_position(std::size_t n) const;

 private:
  /// How often a jump is still to be made; negative: without end.
  int jumps_left(std::size_t n) const;

  std::vector<formats::MissionCommand> commands_;
  formats::Autopilot autopilot_;
  std::map<std::size_t, int> jumped_;
  /// Those that are counted, when a jump without end was made last.
  std::map<std::size_t, std::map<std::size_t, int>> counted_;
};
}  // namespace altiplan::host
