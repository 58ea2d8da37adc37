// SPDX-License-Identifier: Apache-2.0
#include "host/autopilot/sequence.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace altiplan::host {

using formats::Task;

bool Sequence::is_jump(std::size_t n) const {
  return task_of(n).task == Task::jump || task_of(n).task == Task::jump_to_tag;
}

std::optional<std::size_t> Sequence::target_of(std::size_t n) const {
  const bool is_tag = task_of(n).task == Task::jump_to_tag;
  const double sought = std::trunc(commands_[n].params[0]);
  for (std::size_t i = 0; i < commands_.size() && sought >= 1; ++i) {
    const bool is_it =
        is_tag ? task_of(i).task == Task::jump_tag && std::trunc(commands_[i].params[0]) == sought
               : double(commands_[i].item) == sought;
    if (is_it) {
      return i;
    }
  }
  return std::nullopt;
}

int Sequence::jumps_left(std::size_t n) const {
  constexpr double kMost = 65535;
  const double stored = std::trunc(commands_[n].params[1]);
  if (stored == -1 && !autopilot_.is_px4()) {
    return -1;
  }
  // PX4 stores 16 bits without a sign; ArduPilot takes other numbers below 0 for none.
  const double repeats = stored < 0 && autopilot_.is_px4() ? stored + kMost + 1 : stored;
  const auto made = jumped_.find(n);
  return int(std::isfinite(repeats) ? std::clamp(repeats, 0.0, kMost) : 0) -
         (made == jumped_.end() ? 0 : made->second);
}

std::optional<std::size_t> Sequence::after_jump(std::size_t n) {
  const std::optional<std::size_t> target = target_of(n);
  if (!target) {  // of a tag: the mission ends
    return commands_.size();
  }
  const int left = jumps_left(n);
  if (left == 0) {
    return n + 1;
  }
  if (left < 0 && *target > n) {
    return *target;  // ahead, as often as it is reached
  }
  if (left < 0) {
    // Jumps within the loop that are counted still make each round another one.
    std::map<std::size_t, int> counted = jumped_;
    std::erase_if(counted, [&](const auto& jump) { return jumps_left(jump.first) < 0; });
    if (jumped_[n] >= 2 && counted == counted_[n]) {
      return std::nullopt;
    }
    counted_[n] = std::move(counted);
  }
  ++jumped_[n];
  return *target;
}

int Sequence::make_all_jumps(std::size_t n) {
  const int left = std::max(jumps_left(n), 0);
  jumped_[n] += left;
  return left;
}

std::optional<std::size_t> Sequence::next_position(std::size_t n) const {
  std::size_t i = n + 1;
  std::optional<std::size_t> behind_jump;
  for (std::size_t steps = 0; i < commands_.size() && steps < 2 * commands_.size(); ++steps) {
    const Task task = task_of(i).task;
    if (is_done(i) && formats::flies_to_position(task)) {
      return i;
    }
    if (is_done(i) && (task == Task::return_home || task == Task::change_altitude)) {
      return std::nullopt;
    }
    const bool jumps = is_done(i) && is_jump(i);
    if (const auto target = jumps && jumps_left(i) != 0 ? target_of(i) : std::nullopt) {
      behind_jump = behind_jump.value_or(i + 1);
      i = *target;
    } else if (behind_jump && !jumps && !autopilot_.is_px4()) {
      // AP_Mission::get_next_nav_cmd looks at one command that a jump leads to alone.
      i = *std::exchange(behind_jump, std::nullopt);
    } else {
      ++i;
    }
  }
  return std::nullopt;
}
}  // namespace altiplan::host
