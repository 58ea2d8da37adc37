// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/kit/formats/mission_file.hpp"

namespace altiplan::host {

/// Seconds from take-off to landing at the plan's own speeds, climbs and descents at 1 m/s; where
/// it gives no speed, at `speed_mps`. Infinite if it ends in a loiter without end.
double flight_time(const kit::MissionFile& plan, double speed_mps);
}  // namespace altiplan::host
