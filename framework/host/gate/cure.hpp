// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host/autopilot/flown_mission.hpp"
#include "host/gate/band_judge.hpp"

namespace altiplan::host {

/// A change of a command: of its height, or of its place in plan.
struct Cure {
  std::size_t command = 0;
  Vec3 by{0, 0, 0};  ///< metres; its length is a multiple of 0.1 m
};

/// "raise mission.items.7 by 12.4 m", "move line 5 by 30.1 m to the north-east"; of a rise that is
/// far also how high above the ground the item then is, if that is known.
std::string in_words(const Cure& cure, const std::string& item,
                     const std::optional<double>& above_ground_m);

/// Items whose heights above sea level are meant above home.
struct AboveHome {
  std::vector<std::size_t> commands;
  std::size_t invalid = 0;  ///< parts of the flight that are not valid then
  std::size_t before = 0;   ///< and as it is
  bool passes = false;      ///< then all are valid, and no autopilot objects
};

/// The mission with heights above home in the place of heights above sea level.
formats::MissionFile with_heights_above_home(formats::MissionFile plan,
                                             const std::vector<std::size_t>& commands);

/// A command's height above the ground; none where the ground, or its place, is not known.
std::optional<double> above_ground(const formats::MissionFile& plan, std::size_t command,
                                   const World& world);

/// How a mission is flown, by each who may fly it.
using Objections = std::set<std::pair<std::string, std::size_t>>;
using Fly = std::function<std::vector<FlownMission>(const formats::MissionFile&)>;

/// Searches for changes of a mission with which it can be flown: each change is flown as a whole,
/// and the parts that it concerns are judged.
class Cures {
 public:
  /// `flights` are those of the plan as it is.
  Cures(const formats::MissionFile& plan, const std::vector<FlownMission>& flights,
        const World& world, Fly fly, const BandJudge& judge);

  /// The least change of one command's height or, where none helps, the least shift toward one of
  /// 16 directions, of at most 1,000 m, with which the way from `before` to `command`, and what
  /// is flown to and from the changed command, is valid; none if there is none, or the time that a
  /// search may take is over. Searched from changes of `off_m` on: by how much a limit is missed,
  /// which no smaller change mends.
  std::optional<Cure> find(std::size_t before, std::size_t command, double off_m);
  bool is_exhausted() const { return work_ > max_work_; }

  /// Where heights above sea level lie far below the ground: these, or else all, taken above home,
  /// if fewer parts of the flight are not valid then.
  std::optional<AboveHome> above_home();

  /// The mission changed until it is valid, with the smallest sum of rises that is found; none
  /// where that fails.
  std::optional<formats::MissionFile> cured();

 private:
  // Strips judged, about 10 µs each: a check's answer does not wait for cures, --fix does.
  static constexpr double kMaxWorkOfOne = 6e3;
  static constexpr double kMaxWorkOfAll = 2e5;

  /// By cures of single commands, and by raising or lowering both ends of a way.
  std::optional<formats::MissionFile> cured_one_by_one();
  /// Raises and lowers all ways at once, by what each is off (projections onto convex sets, after
  /// Kaczmarz), until none is.
  void level();
  /// Parts of the flight that are not valid; more than any where an autopilot objects anew.
  std::size_t invalid_parts(const formats::MissionFile& plan);

  formats::MissionFile changed(const std::vector<Cure>& changes) const;
  /// True if, so changed, the way is valid, and with `all` what is flown to and from each change.
  bool is_valid(const std::vector<Cure>& changes, std::size_t before, std::size_t command,
                bool all);
  std::optional<std::vector<Cure>> least_change(std::size_t before, std::size_t command, bool both,
                                                double off_m, const std::vector<Vec3>& directions);

  formats::MissionFile plan_;
  const World& world_;
  Fly fly_;
  const BandJudge& judge_;
  Objections objections_;  ///< to the mission as it is
  double work_ = 0;
  double max_work_ = kMaxWorkOfOne;
};
}  // namespace altiplan::host
