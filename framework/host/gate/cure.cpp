// SPDX-License-Identifier: Apache-2.0
#include "host/gate/cure.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {
namespace {

constexpr double kStep = 0.1;      ///< metres
constexpr int kMaxSteps = 10'000;  ///< steps
/// Steps between tries, or an eighth of those made: what is valid for less than that may be missed.
constexpr int kStride = 20;
constexpr int kDirections = 16;

const std::vector<Vec3>& up_and_down() {
  static const std::vector<Vec3> kUpAndDown{Vec3(0, 0, 1), Vec3(0, 0, -1)};
  return kUpAndDown;
}

std::vector<Vec3> around() {
  std::vector<Vec3> directions;
  for (int n = 0; n < kDirections; ++n) {
    const double bearing = 2 * kPi * n / kDirections;
    directions.emplace_back(std::sin(bearing), std::cos(bearing), 0);
  }
  return directions;
}

/// The minimum number of steps, more than `few`, with which `holds`, found by strides and halving;
/// 0: none.
template <class Holds>
int min_steps(const Holds& holds, int few, int max_steps) {
  const int first = few;
  int enough = few + 1;
  while (!holds(enough)) {
    few = enough;
    const int tried = enough - first;
    enough += std::max(std::min(tried, kStride), tried / 8);
    if (enough > max_steps) {
      return 0;
    }
  }
  while (enough - few > 1) {
    const int middle = (few + enough) / 2;
    (holds(middle) ? enough : few) = middle;
  }
  return enough;
}

/// True if a command has a height, or a place, that decides where the vehicle flies.
bool can_move(const formats::MissionCommand& command, const Vec3& by) {
  using formats::Task;
  const Task task = formats::command_task(command.number).task;
  const bool is_end = task == Task::land || task == Task::vtol_land;
  return formats::flies_to_position(task) && command.has_position() &&
         (by.z() == 0 || !is_end);  // a landing is flown to at the height of the item before
}

/// What speaks against flights beside the paths that are flown: rules, and the commands that break
/// them.
Objections objections_to(const std::vector<FlownMission>& flights) {
  Objections all;
  for (const FlownMission& flown : flights) {
    for (const Remark& remark : flown.remarks) {
      if (remark.weight != Remark::Weight::note) {
        all.emplace(remark.rule, remark.command);
      }
    }
  }
  return all;
}
}  // namespace

Cures::Cures(const formats::MissionFile& plan, const std::vector<FlownMission>& flights,
             const World& world, Fly fly, const BandJudge& judge)
    : plan_(plan),
      world_(world),
      fly_(std::move(fly)),
      judge_(judge),
      objections_(objections_to(flights)) {}

std::string in_words(const Cure& cure, const std::string& item) {
  constexpr std::array kNames{"north", "north-east", "east", "south-east",
                              "south", "south-west", "west", "north-west"};
  const std::string metres = with_decimals(cure.by.norm(), 1) + " m";
  if (cure.by.z() != 0) {
    return (cure.by.z() > 0 ? "raise " : "lower ") + item + " by " + metres;
  }
  const double bearing = degrees(std::atan2(cure.by.x(), cure.by.y()));
  const int whole = int(std::lround(bearing + 360)) % 360;
  std::string toward = " toward " + std::to_string(whole) + "°";
  if (whole % 45 == 0) {
    toward = std::string(" to the ") + kNames[std::size_t(whole / 45)];
  }
  return "move " + item + " by " + metres + toward;
}

formats::MissionFile Cures::changed(const std::vector<Cure>& changes) const {
  formats::MissionFile plan = plan_;
  for (const Cure& cure : changes) {
    formats::MissionCommand& command = plan.commands[cure.command];
    command.altitude_m += cure.by.z();
    if (cure.by.head<2>().norm() > 0) {
      const auto [x, y] = world_.frame().to_local(command.lon, command.lat);
      const auto [lon, lat] = world_.frame().to_lonlat(x + cure.by.x(), y + cure.by.y());
      command.lon = lon;
      command.lat = lat;
    }
  }
  return plan;
}

bool Cures::is_valid(const std::vector<Cure>& changes, std::size_t before, std::size_t command,
                     bool all) {
  const formats::MissionFile plan = changed(changes);
  const auto is_concerned = [&](const FlownPart& part) {
    return (part.before == before && part.command == command) ||
           (all && std::any_of(changes.begin(), changes.end(), [&](const Cure& cure) {
              return part.command == cure.command || part.before == cure.command;
            }));
  };
  try {
    const std::vector<FlownMission> flights = fly_(plan);
    const Objections now = objections_to(flights);
    if (!std::includes(objections_.begin(), objections_.end(), now.begin(), now.end())) {
      return false;  // an autopilot refuses it, or it is no longer judged
    }
    for (const FlownMission& flown : flights) {
      work_ += (double(flown.parts.size()) + double(flown.strips) / 2) / 2;  // to fly it
      for (const FlownPart& part : flown.parts) {
        if (is_concerned(part)) {
          work_ += double(part.strips.size());
          if (!judge_.is_valid(part)) {
            return false;
          }
        }
      }
    }
  } catch (const Error&) {
    return false;  // moved to where there is no ground
  }
  return true;
}

std::optional<std::vector<Cure>> Cures::least_change(std::size_t before, std::size_t command,
                                                     bool both, double off_m,
                                                     const std::vector<Vec3>& directions) {
  std::optional<std::vector<Cure>> best;
  int max_steps = kMaxSteps;
  std::vector<std::vector<std::size_t>> moved{{before}, {command}};
  if (both) {
    moved = {{before, command}};
  } else if (before == command) {
    moved = {{command}};
  }
  for (const auto& commands : moved) {
    for (const Vec3& direction : directions) {
      if (!std::all_of(commands.begin(), commands.end(),
                       [&](std::size_t n) { return can_move(plan_.commands[n], direction); })) {
        continue;
      }
      const auto changes = [&](int steps) {
        std::vector<Cure> all;
        for (const std::size_t n : commands) {
          all.push_back({n, steps * kStep * direction});
        }
        return all;
      };
      const int steps = min_steps(
          [&](int n) { return is_exhausted() || is_valid(changes(n), before, command, !both); },
          std::max(0, int(std::min(off_m / kStep, double(kMaxSteps))) - 1), max_steps);
      if (steps != 0 && !is_exhausted() && (!best || steps < max_steps)) {
        best = changes(steps);
        max_steps = steps;
      }
    }
  }
  return best;
}

std::optional<Cure> Cures::find(std::size_t before, std::size_t command, double off_m) {
  auto change = least_change(before, command, false, off_m, up_and_down());
  if (!change) {
    change = least_change(before, command, false, off_m, around());
  }
  return change ? std::optional(change->front()) : std::nullopt;
}

std::optional<formats::MissionFile> Cures::cured() {
  max_work_ = kMaxWorkOfAll;
  const std::size_t max_rounds = 20 * plan_.commands.size();
  const auto first_invalid = [&]() -> std::optional<FlownPart> {
    for (FlownMission& flown : fly_(plan_)) {
      for (FlownPart& part : flown.parts) {
        if (!judge_.is_valid(part)) {
          return std::move(part);
        }
      }
    }
    return std::nullopt;
  };
  for (std::size_t round = 0; round < max_rounds && !is_exhausted(); ++round) {
    const std::optional<FlownPart> part = first_invalid();
    if (!part) {
      return plan_;
    }
    auto change = least_change(part->before, part->command, false, 0, up_and_down());
    if (!change) {
      change = least_change(part->before, part->command, true, 0, up_and_down());
    }
    if (!change) {
      change = least_change(part->before, part->command, false, 0, around());
    }
    if (!change) {
      return std::nullopt;
    }
    plan_ = changed(*change);
  }
  return std::nullopt;
}
}  // namespace altiplan::host
