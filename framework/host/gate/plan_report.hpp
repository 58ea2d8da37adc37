// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/measures.hpp"
#include "host/gate/cure.hpp"
#include "host/gate/flown_parts.hpp"
#include "host/import_export/imported_route.hpp"

namespace altiplan::host {

/// A violation as the author of a mission sees it.
struct Finding {
  Violation violation;
  std::vector<std::string> items;  ///< as ground stations name them: one, or the two of a leg
  std::optional<Vec3> at;          ///< where it is worst, within a metre, if anywhere
  std::optional<Cure> cure;        ///< of one waypoint
  std::string zone{};              ///< name of the violated layer's part, "" if it has none
  bool is_over_void = false;       ///< there the elevation model has no height
};

inline constexpr double kHomeTolerance = 10;  ///< metres
/// A ground at least as high stands for a void of the elevation model, which is closed.
inline constexpr double kUnknownGround = 9'000;

/// The verdict on a mission of a ground station.
struct PlanReport {
  std::string file;
  ImportedRoute imported;
  std::vector<Passage> passages;
  std::vector<Way> ways;
  std::vector<std::string> rally;  ///< names of the rally points: "rally point 1"
  std::vector<Finding> findings;   ///< none: passed
  Measures measures;
  std::vector<std::string> notes;  ///< how the file and the world were read

  bool passed() const { return findings.empty(); }
  /// "item 3 (waypoint)" as ground stations number it, "point 3" where the file numbers nothing,
  /// "waypoint 3" where the route has other points than the file.
  std::string name_of(std::size_t waypoint) const;
  Bonds bonds() const;
  /// "at least 52.4 m above ground", of the route.
  std::string height_in_words() const;
};

/// Throws Error, beginning with `file`, naming what a mission without a route holds instead.
void expect_route(const std::string& file, const formats::MissionFile& plan);

/// Judges the mission's route and, by the layers but the ground, its climb from home and its
/// descent to land. A landing that is not below the item before it, and a return at the end, are
/// flown to at that item's height, a landing by an aeroplane straight down to the ground. The way
/// from home and whole circles of loiters are judged as legs, and rally points as places. Other
/// commands that fly somewhere, and heights relative to a home that is more than kHomeTolerance off
/// the ground, are findings. Throws Error for a mission wholly beside the ground. With `own_ends`
/// the route need not begin and end where the world's scenario says. Messages begin with `file`.
PlanReport judge_plan(const std::string& file, const formats::MissionFile& plan,
                      const Mission& world, bool own_ends);
}  // namespace altiplan::host
