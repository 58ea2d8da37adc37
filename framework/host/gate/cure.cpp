// SPDX-License-Identifier: Apache-2.0
#include "host/gate/cure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"
#include "host/import_export/imported_route.hpp"

namespace altiplan::host {
namespace {

constexpr double kStep = 0.1;      ///< metres
constexpr int kMaxSteps = 10'000;  ///< steps
/// Steps between tries, or an eighth of those made: what is valid for less than that may be missed.
constexpr int kStride = 20;
constexpr int kDirections = 16;
constexpr double kFar = 100;  ///< metres: who raises an item by more meant something else

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

bool is_above_sea(const formats::MissionCommand& command) {
  return command.frame == 0 || command.frame == 5;
}

/// By how much a way is to be raised, or lowered where it is too high, for its worst violation of a
/// limit on heights; none without one.
std::optional<std::pair<double, Vec3>> needed_rise(const std::vector<BandJudge::Found>& all,
                                                   const World& world) {
  std::optional<std::pair<double, Vec3>> needed;
  for (const BandJudge::Found& found : all) {
    const Violation& violation = found.violation;
    const Layer* layer = world.find(violation.layer);
    const bool is_of_heights = layer == nullptr || layer->environment->ground() != nullptr;
    const double rise = violation.limit - violation.value;
    if (is_of_heights && violation.unit == "m" && std::isfinite(rise) &&
        (!needed || std::abs(rise) > std::abs(needed->first))) {
      needed = {rise, found.at};
    }
  }
  return needed;
}

/// How far along a part of a flight a place is, from 0 to 1.
double share_along(const FlownPart& part, const Vec3& at) {
  const Vec3& from = part.strips.front().from;
  const Eigen::Vector2d way = (part.strips.back().to - from).head<2>();
  const double length = way.squaredNorm();
  return length > 0 ? std::clamp((at - from).head<2>().dot(way) / length, 0.0, 1.0) : 1;
}

/// Changes of heights: their sum, and the greatest of them.
struct Rises {
  double sum = 0;
  double greatest = 0;
};

Rises rises_of(const formats::MissionFile& before, const formats::MissionFile& after) {
  Rises rises;
  for (std::size_t n = 0; n < before.commands.size(); ++n) {
    const double rise = std::abs(after.commands[n].altitude_m - before.commands[n].altitude_m);
    rises.sum += rise;
    rises.greatest = std::max(rises.greatest, rise);
  }
  return rises;
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

formats::MissionFile with_heights_above_home(formats::MissionFile plan,
                                             const std::vector<std::size_t>& commands) {
  for (const std::size_t n : commands) {
    plan.commands[n].frame = plan.commands[n].frame == 5 ? 6 : 3;
  }
  return plan;
}

std::optional<double> above_ground(const formats::MissionFile& plan, std::size_t command,
                                   const World& world) {
  using formats::AltitudeFrame;
  const formats::MissionCommand& at = plan.commands[command];
  if (formats::is_above_ground(at.frame)) {
    return at.altitude_m;
  }
  if ((!at.has_position() || formats::is_of_home(at.frame)) && !plan.home) {
    return std::nullopt;
  }
  const double lon = at.has_position() ? at.lon : plan.home->lon;
  const double lat = at.has_position() ? at.lat : plan.home->lat;
  const double above = formats::is_of_home(at.frame) ? plan.home->altitude_m : 0;
  const auto [x, y] = world.frame().to_local(lon, lat);
  const std::optional<double> ground = world.ground(x, y);
  return ground ? std::optional(above + at.altitude_m - *ground) : std::nullopt;
}

std::string in_words(const Cure& cure, const std::string& item,
                     const std::optional<double>& above_ground_m) {
  constexpr std::array kNames{"north", "north-east", "east", "south-east",
                              "south", "south-west", "west", "north-west"};
  const std::string metres = with_decimals(cure.by.norm(), 1) + " m";
  if (cure.by.z() != 0) {
    return (cure.by.z() > 0 ? "raise " : "lower ") + item + " by " + metres +
           (cure.by.z() > kFar && above_ground_m
                ? ", to " + with_decimals(*above_ground_m, 0) + " m above the ground"
                : "");
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

std::size_t Cures::invalid_parts(const formats::MissionFile& plan) {
  std::size_t count = 0;
  try {
    const std::vector<FlownMission> flights = fly_(plan);
    const Objections now = objections_to(flights);
    if (!std::includes(objections_.begin(), objections_.end(), now.begin(), now.end())) {
      return std::numeric_limits<std::size_t>::max();
    }
    for (const FlownMission& flown : flights) {
      for (const FlownPart& part : flown.parts) {
        work_ += double(part.strips.size());
        count += judge_.is_valid(part) ? 0 : 1;
      }
    }
  } catch (const Error&) {
    return std::numeric_limits<std::size_t>::max();
  }
  return count;
}

std::optional<AboveHome> Cures::above_home() {
  std::vector<std::size_t> all;
  std::vector<std::size_t> sunk;
  double lowest = 0;
  for (std::size_t n = 0; n < plan_.commands.size(); ++n) {
    const formats::MissionCommand& command = plan_.commands[n];
    if (is_above_sea(command) &&
        formats::flies_to_position(formats::command_task(command.number).task)) {
      all.push_back(n);
      const double height = above_ground(plan_, n, world_).value_or(0);
      lowest = std::min(lowest, height);
      if (height < 0) {
        sunk.push_back(n);
      }
    }
  }
  if (!(lowest < -kFar) || !plan_.home) {
    return std::nullopt;
  }
  AboveHome change;
  change.commands = 2 * sunk.size() > all.size() ? all : sunk;
  const formats::MissionFile plan = with_heights_above_home(plan_, change.commands);
  change.before = invalid_parts(plan_);
  change.invalid = invalid_parts(plan);
  change.passes = change.invalid == 0 && objections_to(fly_(plan)).empty();
  return change.invalid < change.before ? std::optional(change) : std::nullopt;
}

void Cures::level() {
  constexpr double kMargin = 0.2;  // metres
  while (work_ < max_work_ / 2) {
    std::map<std::size_t, double> rises;  // by command
    const auto can_rise = [&](std::size_t n) {
      return can_move(plan_.commands[n], up_and_down().front());
    };
    for (const FlownMission& flown : fly_(plan_)) {
      for (const FlownPart& part : flown.parts) {
        if (part.strips.empty() || part.ground != FlownPart::Ground::kept_off ||
            rises.contains(part.before) || rises.contains(part.command)) {
          continue;  // what is changed already is judged when it is flown again
        }
        work_ += double(part.strips.size()) + 100;
        const auto needed = needed_rise(judge_.violations(part), world_);
        if (!needed) {
          continue;
        }
        const double share = share_along(part, needed->second);
        const bool by_both = part.what.empty() && part.before != part.command;
        double of_end = can_rise(part.command) ? (by_both ? share : 1) : 0;
        double of_begin = can_rise(part.before) && (by_both || of_end == 0) ? 1 - share : 0;
        if (of_begin == 0 || of_end == 0) {
          of_begin = of_begin > 0 || (of_end == 0 && can_rise(part.before)) ? 1 : 0;
          of_end = of_end > 0 ? 1 : 0;
        }
        const double rise = needed->first + std::copysign(kMargin, needed->first);
        const double scale = rise / std::max(of_begin * of_begin + of_end * of_end, 0.5);
        if (of_begin > 0) {
          rises[part.before] = of_begin * scale;
        }
        if (of_end > 0) {
          rises[part.command] = of_end * scale;
        }
      }
    }
    if (rises.empty()) {
      return;
    }
    for (const auto& [n, rise] : rises) {
      plan_.commands[n].altitude_m += std::round(rise / kStep) * kStep;
    }
  }
}

std::optional<formats::MissionFile> Cures::cured() {
  max_work_ = kMaxWorkOfAll;
  const formats::MissionFile whole = plan_;
  std::optional<formats::MissionFile> best;
  const auto is_near = [&] { return best && rises_of(whole, *best).greatest <= kFar; };
  const auto search_from = [&](const formats::MissionFile& begin) {
    for (const bool at_once : {false, true}) {
      if (is_near()) {
        return;
      }
      plan_ = begin;
      work_ = 0;
      if (at_once) {
        level();
      }
      const auto found = cured_one_by_one();
      if (found && objections_to(fly_(*found)).empty() &&
          (!best || rises_of(whole, *found).sum < rises_of(whole, *best).sum)) {
        best = found;
      }
    }
  };
  if (const auto change = above_home()) {
    search_from(with_heights_above_home(whole, change->commands));
  }
  search_from(whole);
  plan_ = whole;
  return best;
}

std::optional<formats::MissionFile> Cures::cured_one_by_one() {
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
