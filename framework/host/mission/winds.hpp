// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/config/config.hpp"
#include "host/mission/mission.hpp"

namespace altiplan::host {

/// The winds of a scenario over the mission's volume, from its start on; warns of files of other
/// hours. Throws ConfigError, also where the wind changes and a task, a runway or a flight is
/// asked for, which know one.
Wind read_winds(const Config& config, Mission& mission);
}  // namespace altiplan::host
