// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/config/config.hpp"
#include "host/mission/mission.hpp"

namespace altiplan::host {

/// The winds of a scenario over the mission's volume, from its start on; warns of files of other
/// hours. Throws ConfigError, also where the wind changes and what knows one is asked for: a body,
/// a task, a runway, a flight.
Wind read_winds(const Config& config, Mission& mission);
/// Throws ConfigError where the wind changes by `hours` and something is asked for that knows one.
void expect_one_wind(const Config& config);
}  // namespace altiplan::host
