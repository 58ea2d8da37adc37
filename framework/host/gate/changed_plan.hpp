// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/formats/mission_file.hpp"

namespace altiplan::host {

/// An item's new position; its frame of altitude stays.
struct ChangedItem {
  std::string place;                            ///< as MissionItem has it
  std::optional<std::array<double, 2>> lonlat;  ///< none: only its height changes
  double raised_by_m = 0;
};

/// The text of a `.plan` or `.waypoints` file with items changed and all else as it is. Throws
/// Error for other formats.
std::string changed_plan(const std::string& text, formats::MissionFile::Format format,
                         const std::vector<ChangedItem>& changes);
}  // namespace altiplan::host
