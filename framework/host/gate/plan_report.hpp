// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/measures.hpp"
#include "host/gate/cure.hpp"
#include "host/import_export/imported_route.hpp"

namespace altiplan::host {

/// A violation as the author of a mission sees it.
struct Finding {
  Violation violation;
  std::vector<std::string> items;  ///< as the file names them: one, or the two of a leg
  Vec3 at{0, 0, 0};                ///< a place where it is violated
  std::optional<Cure> cure;        ///< of one waypoint
};

/// A motion that is no leg of the route: a climb after take-off, or a descent to land.
struct Passage {
  std::string item;
  bool is_climb = true;
  Vec3 foot{0, 0, 0};
  Vec3 top{0, 0, 0};
};

/// The verdict on a mission of a ground station.
struct PlanReport {
  std::string file;
  ImportedRoute imported;
  std::vector<Passage> passages;
  std::vector<Finding> findings;  ///< none: passed
  Measures measures;
  std::vector<std::string> notes;  ///< how the file and the world were read

  bool passed() const { return findings.empty(); }
  /// As the file names it, "waypoint 3" where the route has other points than the file.
  std::string name_of(std::size_t waypoint) const;
};

/// Judges the mission's route and, by the layers but the ground, its climb from home and its
/// descent to land. A landing that is not below the item before it is flown to at that item's
/// height, or by an aeroplane straight down to the ground. With `own_ends` the route need not begin
/// and end where the world's scenario says. Messages begin with `file`.
PlanReport judge_plan(const std::string& file, const kit::MissionFile& plan, const Mission& world,
                      bool own_ends);

/// Seconds from take-off to landing at the plan's own speeds, climbs and descents at 1 m/s; where
/// it gives no speed, at `speed_mps`. Infinite if it ends in a loiter without end.
double flight_time(const kit::MissionFile& plan, double speed_mps);
}  // namespace altiplan::host
