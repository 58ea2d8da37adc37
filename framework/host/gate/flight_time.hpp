// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/formats/mission_file.hpp"

namespace altiplan::host {

/// Seconds from take-off to the end of each item at the plan's own speeds, climbs and descents at 1
/// m/s; where it gives no speed, at `speed_mps`. Infinite after a loiter without end.
std::vector<double> item_times(const formats::MissionFile& plan, double speed_mps);
/// That of the last one; 0 without items.
double flight_time(const formats::MissionFile& plan, double speed_mps);
}  // namespace altiplan::host
