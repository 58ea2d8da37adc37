// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/formats/mission_file.hpp"

namespace altiplan::host {

/// An item's new position.
struct ChangedItem {
  std::string place;                            ///< as MissionItem has it
  std::optional<std::array<double, 2>> lonlat;  ///< none: only its height changes
  double raised_by_m = 0;
  std::optional<int> frame;  ///< MAV_FRAME of heights above home; none: its own
};

struct PlanChanges {
  std::vector<ChangedItem> items;
  double home_raised_by_m = 0;
  std::vector<std::pair<std::size_t, double>> rally;  ///< and by how much it is raised, metres
};

/// The text of a `.plan` or `.waypoints` file so changed and all else as it is; rally points of a
/// `.plan` alone. Throws Error for other formats.
std::string changed_plan(const std::string& text, formats::MissionFile::Format format,
                         const PlanChanges& changes);

/// A command without a place or parameters.
struct AddedMarker {
  std::string before;  ///< place of an item: "mission.items.3"
  int command = 0;     ///< MAV_CMD
};
/// The text of a `.plan` file with these, from the last to the first, and the items behind them
/// numbered anew. No item may jump.
std::string with_added_markers(std::string text, const std::vector<AddedMarker>& markers);

/// The text of a `.plan` file with these rally points, above home, in place of its own and all else
/// as it is.
std::string with_rally_points(const std::string& text,
                              const std::vector<formats::MissionPoint>& points);
}  // namespace altiplan::host
